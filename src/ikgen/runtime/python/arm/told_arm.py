"""What Python is told about an arm whose solver is compiled."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.runtime.python.arm.chain_kinematics import Chain
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.solved_arm import BranchesBatch, HeldAngle
from ikgen.runtime.python.arm.task_interface import Task
from ikgen.runtime.python.arrays.array_types import Row

__all__ = ["Arm"]


@dataclass(frozen=True)
class Arm:
    """Stands in compiled packages for the `Arm` that solves in Python: what reading arguments, and telling
    rows apart, takes of it. `branches_batch` is there where rows have numbers of branches."""

    chain: Chain
    task: Task
    policy: Policy
    lower: Row
    upper: Row
    free: tuple[int, ...]
    free_joints: tuple[str, ...]
    free_defaults: Row
    period: Row
    moving: tuple[int, ...]
    branch_kind: str
    elbow_end: int
    branches_batch: BranchesBatch | None
    angle: HeldAngle | None = None

    @property
    def placing(self) -> Row:
        """`period`, 0 of held joints."""
        return tuple(0.0 if j in self.free else turn for j, turn in enumerate(self.period))
