"""What of a pose counts: one row a task; other packages add theirs by the group `ikgen.tasks`."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ikgen.errors import UnknownNameError, UsageError
from ikgen.model.entry_names import entry_name, entry_place
from ikgen.plugins import find_plug_in, plug_ins

__all__ = [
    "AXES",
    "POSE",
    "POSITION",
    "TASKS",
    "WHOLE_POSE",
    "Task",
    "checked_axis",
    "find_task",
    "requested_task",
    "smaller_tasks",
    "stem_and_axis",
    "task_names",
]

AXES = ("x", "y", "z")
"""The tool's axes, by which a task with a direction goes."""

_POSITION = tuple(entry_name(i, 3) for i in range(3))
_ROTATION = tuple(entry_name(i, j) for i in range(3) for j in range(3))
_DIRECTION = ("r13", "r23", "r33")
_ELEVATION = ("r33",)
WHOLE_POSE = frozenset(_ROTATION + _POSITION)
"""Names of all entries of a pose."""

_AXIS = "{axis}"

_ORIENTATIONS = {
    frozenset(): "",
    frozenset(_ROTATION): "rotation",
    **{frozenset((f"r1{j}", f"r2{j}", f"r3{j}")): "direction" for j in (1, 2, 3)},
    **{frozenset((f"r1{j}", f"r2{j}")): "yaw" for j in (1, 2, 3)},
    **{frozenset((f"r3{j}",)): "pitch" for j in (1, 2, 3)},
}


@dataclass(frozen=True, slots=True)
class Task:
    """A task reads the pose entries `readable` (rows and columns from 1) and fixes `freedoms` of the
    tip's six; `aliases` are IKFast's names, which MoveIt users know. `axis` is the tool's axis that a task
    with a direction, an elevation or a heading reads ("": it reads no single one); `first`: the axis that
    the bare name means, set only where `axis` is another. `says` is what counts in words, with `{axis}`
    where the axis is named."""

    name: str
    readable: frozenset[str]
    freedoms: int
    says: str
    aliases: tuple[str, ...] = ()
    axis: str = ""
    first: str = ""

    def __post_init__(self) -> None:
        if bool(self.axis) != (_AXIS in self.says):
            found = (
                "says {axis} without"
                if _AXIS in self.says
                else "does not say {axis} in its words for"
            )
            raise ValueError(f"the task '{self.name}' {found} an axis of the tool")

    @property
    def words(self) -> str:
        """What counts, in words."""
        return self.says.replace(_AXIS, self.axis)

    @property
    def stem(self) -> str:
        """The name without the axis."""
        return self.name.partition(":")[0]

    def along(self, axis: str) -> Task:
        """The task by another axis of the tool: `position-direction:x`, none named where it is the first.

        Raises `UsageError` for a task that has no direction.
        """
        if not self.axis:
            raise UsageError(
                f"the task '{self.name}' reads no single axis of the tool",
                hint=f"leave the tool axis out, or give a --task with one: {', '.join(_with_axis())}",
            )
        old, new = (str(AXES.index(a) + 1) for a in (self.axis, axis))
        readable = frozenset(
            n[:-1] + new if n[0] == "r" and n[-1] == old else n for n in self.readable
        )
        first = self.first or self.axis
        name, first = (self.stem, "") if axis == first else (f"{self.stem}:{axis}", first)
        return replace(self, name=name, readable=readable, axis=axis, first=first)

    @property
    def whole_pose(self) -> bool:
        """Whether every entry is read, so that the tool transform can be taken off the pose."""
        return self.readable == WHOLE_POSE

    @property
    def entries(self) -> tuple[tuple[int, int], ...]:
        """Row and column (from 0) of each entry that is read, in the order of their names."""
        return tuple(entry_place(name) for name in sorted(self.readable))

    @property
    def position(self) -> bool:
        """Whether the whole position is read."""
        return self.readable.issuperset(_POSITION)

    @property
    def orientation(self) -> str:
        """What is read of the rotation: "", rotation, direction, yaw or pitch; "entries" where the task
        reads other entries of the pose, or a part of the position, each compared for itself."""
        rest = self.readable - set(_POSITION) if self.position else self.readable
        return _ORIENTATIONS.get(rest, "entries")


POSE = Task("pose", WHOLE_POSE, 6, "position and rotation", ("Transform6D",))
POSITION = Task("position", frozenset(_POSITION), 3, "position", ("Translation3D",))
ROTATION = Task("rotation", frozenset(_ROTATION), 3, "rotation", ("Rotation3D",))

TASKS: tuple[Task, ...] = (
    POSE,
    Task(
        "position-direction",
        frozenset(_POSITION + _DIRECTION),
        5,
        "position and direction of the tool's {axis} axis",
        ("TranslationDirection5D",),
        "z",
    ),
    Task(
        "position-pitch",
        frozenset(_POSITION + _ELEVATION),
        4,
        "position and elevation of the tool's {axis} axis over the base's x-y plane",
        ("TranslationZAxisAngle4D",),
        "z",
    ),
    Task(
        "position-yaw",
        frozenset((*_POSITION, "r11", "r21")),
        4,
        "position and heading of the tool's {axis} axis about the base's z",
        ("TranslationXAxisAngleZNorm4D", "TranslationXAxisAngle4D"),
        "x",
    ),
    POSITION,
    ROTATION,
    Task(
        "direction",
        frozenset(_DIRECTION),
        2,
        "direction of the tool's {axis} axis",
        ("Direction3D",),
        "z",
    ),
)


def smaller_tasks(freedoms: int) -> list[Task]:
    """Tasks that fix fewer freedoms, to offer in place of one that fixes so many: the rotation alone is
    asked for, never offered."""
    return [task for task in TASKS if task.freedoms < freedoms and task is not ROTATION]


def _with_axis() -> list[str]:
    return [task.name for task in TASKS if task.axis]


def find_task(name: str, axis: str | None = None) -> Task:
    """The task of a name or alias, ikgen's own or another package's, by the tool's axis (None: the name's,
    as in `position-pitch:x`, or the task's first); raises `UnknownNameError` with what there is,
    `UsageError` for an axis of a task that has none, or for two of them."""
    stem, axis = stem_and_axis(name, axis)
    task = _named(stem)
    return task if axis is None else task.along(axis)


def stem_and_axis(name: str, axis: str | None = None) -> tuple[str, str | None]:
    """A task's name without the tool's axis, and that axis, which is in the name or named apart; raises
    `UnknownNameError` for an axis that there is not, `UsageError` for two of them."""
    stem, colon, own = name.partition(":")
    if colon and axis not in (None, own):
        raise UsageError(
            f"the task '{name}' goes by another axis than {axis}", hint="name the tool's axis once"
        )
    axis = own if colon else axis
    if axis is not None:
        checked_axis(axis)
    return stem, axis


def checked_axis(axis: str) -> str:
    """The tool's axis; raises `UnknownNameError` for one that there is not."""
    if axis not in AXES:
        raise UnknownNameError("tool axis", axis, AXES)
    return axis


def requested_task(name: str | None, axis: str | None) -> str | None:
    """What a request says of a task that is there: its name, without an axis that is named apart. Raises
    as `find_task` does."""
    if axis is not None:
        checked_axis(axis)
    if name is None:
        return None
    return find_task(name).name if axis is None else find_task(name, axis).stem


def _named(name: str) -> Task:
    for task in TASKS:
        if name == task.name or name.lower() in (a.lower() for a in task.aliases):
            return task
    plug_in = find_plug_in("ikgen.tasks", name)
    if plug_in is not None:
        return plug_in.load(Task)
    raise UnknownNameError("task", name, task_names())


def task_names() -> list[str]:
    """Names of ikgen's own tasks and those of other packages."""
    return [*(task.name for task in TASKS), *(one.name for one in plug_ins("ikgen.tasks"))]
