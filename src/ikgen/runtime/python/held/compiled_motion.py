"""Intervals of a held joint's values that a compiled solver finds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ikgen.runtime.python.arguments.pose_arguments import one_pose
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.held.self_motion import Interval

__all__ = ["compiled_motion"]


def compiled_motion(
    arm: Arm,
    find: Callable[[Array, bool], Sequence[tuple[float, float, int]]],
    pose: Any,
    limits: bool,
) -> tuple[Interval, ...]:
    """As `self_motion_of`, from what the compiled function finds of a pose (4, 4)."""
    found = find(one_pose(pose, arm.task.alone), bool(limits))
    return tuple(Interval(low, high, branch) for low, high, branch in found)
