"""What of a pose counts: one row a task; other packages add theirs by the group `ikgen.tasks`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ikgen.errors import UnknownNameError
from ikgen.plugins import find_plug_in, plug_ins

if TYPE_CHECKING:
    from ikgen.model.dh import DHChain
    from ikgen.model.joint_tree import Matrix

__all__ = [
    "TASKS",
    "Task",
    "find_task",
    "fits",
    "fitting_tasks",
    "freedoms_moved",
    "task_motion",
]

_POSITION = ("px", "py", "pz")
_ROTATION = tuple(f"r{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3))
_DIRECTION = ("r13", "r23", "r33")
_HEADING = ("r11", "r21")
_ORIENTATIONS = {
    frozenset(): "",
    frozenset(_ROTATION): "rotation",
    frozenset(_DIRECTION): "direction",
    frozenset(_HEADING): "yaw",
}


@dataclass(frozen=True, slots=True)
class Task:
    """A task reads the pose entries `readable` (rows and columns from 1) and fixes `freedoms` of the
    tip's six; `aliases` are IKFast's names, which MoveIt users know."""

    name: str
    readable: frozenset[str]
    freedoms: int
    words: str
    aliases: tuple[str, ...] = ()

    @property
    def whole_pose(self) -> bool:
        """Whether every entry is read, so that the tool transform can be taken off the pose."""
        return self.name == "pose"

    @property
    def entries(self) -> tuple[tuple[int, int], ...]:
        """Row and column (from 0) of each entry that is read, in the order of their names."""
        names = sorted(self.readable)
        return tuple(
            ("xyz".index(n[1]), 3) if n[0] == "p" else (int(n[1]) - 1, int(n[2]) - 1) for n in names
        )

    @property
    def position(self) -> bool:
        """Whether the whole position is read."""
        return self.readable.issuperset(_POSITION)

    @property
    def orientation(self) -> str:
        """What is read of the rotation: "", rotation, direction or yaw; "entries" where the task reads
        other entries of the pose, or a part of the position, each compared for itself."""
        rest = self.readable - set(_POSITION) if self.position else self.readable
        return _ORIENTATIONS.get(rest, "entries")


TASKS: tuple[Task, ...] = (
    Task("pose", frozenset(_ROTATION + _POSITION), 6, "position and rotation", ("Transform6D",)),
    Task(
        "position-direction",
        frozenset(_POSITION + _DIRECTION),
        5,
        "position and direction of the tool's z axis",
        ("TranslationDirection5D",),
    ),
    Task(
        "position-yaw",
        frozenset(_POSITION + _HEADING),
        4,
        "position and heading of the tool's x axis about the base's z",
        ("TranslationXAxisAngleZNorm4D", "TranslationXAxisAngle4D"),
    ),
    Task("position", frozenset(_POSITION), 3, "position", ("Translation3D",)),
    Task("rotation", frozenset(_ROTATION), 3, "rotation", ("Rotation3D",)),
    Task("direction", frozenset(_DIRECTION), 2, "direction of the tool's z axis", ("Direction3D",)),
)


def find_task(name: str) -> Task:
    """The task of a name or alias, ikgen's own or another package's; raises `UnknownNameError` with
    what there is."""
    for task in TASKS:
        if name == task.name or name.lower() in (a.lower() for a in task.aliases):
            return task
    plug_in = find_plug_in("ikgen.tasks", name)
    if plug_in is not None:
        return plug_in.load(Task)
    others = (one.name for one in plug_ins("ikgen.tasks"))
    raise UnknownNameError("task", name, [*(task.name for task in TASKS), *others])


def fitting_tasks(dh: DHChain) -> tuple[Task, ...]:
    """Tasks for an arm when none was asked for, the best first and the whole pose last.

    An arm with fewer than six moving joints gets the task that fixes as many freedoms as it has, if
    its joints do move all of them; the whole pose then only counts on the poses that it can take.
    """
    moving = dh.dof - len(dh.free)
    smaller = [t for t in TASKS if t.freedoms == moving and t.name != "rotation" and fits(dh, t)]
    whole = TASKS[0]
    return (whole,) if moving >= whole.freedoms else (*smaller, whole)


def fits(dh: DHChain, task: Task) -> bool:
    """Whether the joints that are not held move the task's freedoms independently of each other."""
    import numpy as np

    from ikgen.kinematics.forward import file_forward

    q = _configurations(dh)
    if task.name == "position-yaw" and np.abs(file_forward(dh, q)[:, 2, 0]).max() > 1e-6:
        return False  # a heading is well-defined where the tool's x axis stays horizontal
    return freedoms_moved(dh, task) == dh.dof - len(dh.free)


def freedoms_moved(dh: DHChain, task: Task) -> int:
    """How many freedoms of the task the joints that are not held move, nearly everywhere: the rank of
    the task's entries by the joints."""
    import numpy as np

    moving = [j for j, joint in enumerate(dh.joints) if joint.name not in dh.free]
    if not moving:
        return 0
    singular = np.linalg.svd(task_motion(dh, task)[..., moving], compute_uv=False)
    largest = np.maximum(singular[:, :1], 1e-12)
    return int((np.median(singular / largest, axis=0) > 1e-4).sum())


def task_motion(dh: DHChain, task: Task) -> Matrix:
    """How the task's entries change with all joints, held or not, at a few configurations: (8, entries,
    dof), per rad and m."""
    import numpy as np

    from ikgen.kinematics.forward import file_forward

    q = _configurations(dh)
    rows, columns = zip(*task.entries, strict=True)
    steps = []
    for h in 1e-6 * np.eye(dh.dof):
        change = (file_forward(dh, q + h) - file_forward(dh, q - h)) / 2e-6
        steps.append(change[:, rows, columns])
    return np.stack(steps, axis=-1)


def _configurations(dh: DHChain) -> Matrix:
    """A few configurations (8, dof) in rad and m, the same each time."""
    import numpy as np

    return np.random.default_rng(0).uniform(-1.5, 1.5, (8, dh.dof))
