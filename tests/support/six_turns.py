"""Six revolute joints solved by eliminations alone, as the emitted code solves them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ikgen.elimination.routine import Elimination, Plan, six_joints_batch
from ikgen.runtime.python.elimination.general_6r import candidates

__all__ = ["general_6r", "general_6r_batch"]

Array = NDArray[np.float64]


def general_6r_batch(
    frames: Array, length: float, eliminations: Sequence[Elimination], poses: Array
) -> list[Array]:
    """All joint values (k, 6) for each of the poses (N, 4, 4) of a chain (7, 4, 4); length (m): its scale;
    eliminations in order of preference."""
    plan = Plan(length, tuple(eliminations), (True,) * 6, candidates)
    return six_joints_batch(frames, plan, poses)


def general_6r(
    frames: Array, length: float, eliminations: Sequence[Elimination], pose: Array
) -> Array:
    """`general_6r_batch` for one pose (4, 4)."""
    return general_6r_batch(frames, length, eliminations, pose[None])[0]
