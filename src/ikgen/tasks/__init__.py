"""What of a pose counts: one row a task."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.errors import UnknownNameError

__all__ = ["TASKS", "Task", "find_task"]

_POSITION = ("px", "py", "pz")
_ROTATION = tuple(f"r{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3))
_DIRECTION = ("r13", "r23", "r33")
_HEADING = ("r11", "r21")


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
    """The task of a name or alias; raises `UnknownNameError` with what there is."""
    for task in TASKS:
        if name == task.name or name.lower() in (a.lower() for a in task.aliases):
            return task
    raise UnknownNameError("task", name, [task.name for task in TASKS])
