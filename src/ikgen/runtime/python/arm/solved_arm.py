"""Everything that the runtime is told about one arm."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from ikgen.runtime.python.arm.chain_kinematics import Chain
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.task_interface import Task
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index, Row

__all__ = [
    "Arm",
    "Around",
    "Branches",
    "BranchesBatch",
    "FormRow",
    "Found",
    "HeldAngle",
    "Together",
]

Found = tuple[Row, bool]  # a solution, and whether it is one of a continuum
FormRow = tuple[Row, bool]  # of a closed form, and whether it needs Newton steps
Branches = Callable[[Sequence[Sequence[float]], Row, Row], tuple[list[FormRow], bool]]
BranchesBatch = Callable[[Array, Array, Array], tuple[Array, Flags, Flags, Flags, Flags]]


class Together(Protocol):
    """Newton steps of all rows at once, with the arm's chain in lanes. See `refine_together`."""

    def __call__(
        self, arm: Arm, q: Array, T: Array, share: float = 0.0
    ) -> tuple[Array, Flags, Flags]: ...


class Around(Protocol):
    """What rows of a broken continuum lead to. See `rows_around`."""

    def __call__(
        self, arm: Arm, q: Array, T: Array, broken: Flags
    ) -> tuple[Flags, Index, Array, Array]: ...


class HeldAngle(Protocol):
    """An angle that is held in place of a joint, of rows (..., dof) and their poses (..., 4, 4)."""

    @property
    def upper(self) -> float:
        """Length of the upper arm, m."""

    def of_rows(self, q: Array, pose: Array) -> Array:
        """The angles (...)."""

    def beside_line(self, q: Array, pose: Array) -> Array:
        """Where elbows are beside the line that the angle is counted about (..., 2), m."""

    def plane(self, T: Array) -> tuple[Array, Array]:
        """Directions (..., 3) from the line: where the angle is 0, and a quarter turn on."""

    def aims(self, T: Array, held: Array) -> Array:
        """Poses T (k, 4, 4) and angles `held` (k, 1) to be reached, as `errors` takes them."""

    def errors(self, q: Array, aim: Array) -> tuple[Array, Array]:
        """By how much rows (k, dof) miss them (k,), and the derivatives (k, dof)."""

    def turned(self, q: Array, aim: Array) -> Array:
        """The derivatives (k,) of minus that by the angle."""


@dataclass(frozen=True)
class Arm:
    """`free`, `free_joints`, `free_defaults`: indices, names and values of held joints. `most`: rows at
    most. `branches(T, q0, held)`: the closed form's rows for a pose, values of joints that it leaves
    free, values of held joints, each with whether it is rough; and whether the pose leaves a doubt: a joint
    free, or solutions of the file's geometry that no branch may lead to. None for an elimination;
    `branches_batch`: in arrays. `beside`
    (n, 4, 4): motions of the tool to poses that are solved as well. `period`: how far
    apart (rad) values of a joint are that are the same configuration, 0 where none are; `moving`: indices
    of joints that are not held.
    `together`: `refine_together` where the closed form is of another geometry than the file's, and all rows
    are rough; `solved`: the chain of that geometry then. `around`: `rows_around` where there is a closed
    form.
    `branch_kind`, `elbow_end`: as in `branch_names`. `angle`: the arm angle, where that is held after
    the joints. `freedoms`: of the pose, by all joints, held or not."""

    chain: Chain
    task: Task
    policy: Policy
    lower: Row
    upper: Row
    free: tuple[int, ...]
    free_joints: tuple[str, ...]
    free_defaults: Row
    most: int
    branches: Branches | None
    branches_batch: BranchesBatch
    beside: Array
    period: Row
    moving: tuple[int, ...]
    together: Together | None
    branch_kind: str
    elbow_end: int
    around: Around | None
    solved: Chain | None = None
    angle: HeldAngle | None = None
    freedoms: int = 6

    @cached_property
    def placing(self) -> Row:
        """`period`, 0 of held joints, whose values are as given."""
        return tuple(0.0 if j in self.free else turn for j, turn in enumerate(self.period))

    @property
    def rank(self) -> int:
        """How many freedoms the task fixes, or the arm has if these are less. Of the whole pose more joints
        may be held than it leaves; of a part of it a held one may not move what is read."""
        dof = len(self.lower)
        return min(dof, self.freedoms) if self.whole_pose else dof - len(self.free_joints)

    @property
    def whole_pose(self) -> bool:
        """Whether the task reads all freedoms of a pose."""
        k = len(self.task.unit)
        return len(self.task.entries) - k * (k + 1) // 2 == 6

    @property
    def rounded(self) -> bool:
        """Whether the closed form is of another geometry than the file's."""
        return self.together is not None

    @property
    def square(self) -> bool:
        """Whether the whole pose is asked for of six joints, and no angle held: each solution that is
        regular is alone near it."""
        return self.whole_pose and len(self.moving) == 6 and self.angle is None
