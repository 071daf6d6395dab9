"""How far rows are from their joint limits, whatever turns they are on."""

from __future__ import annotations

from math import inf

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.angles import without_turns
from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["bounded_joints", "offsets", "outside", "turned_inside"]

_OPEN = 1e6  # m: a slide's limit that is none; distances from the other keep 1e-10


def bounded_joints(arm: Arm) -> list[tuple[int, float, float, float]]:
    """Moving joints that limits bound: index, middle and half of their range, and their period, or 0."""
    out = []
    for j in arm.moving:
        low, high, period = arm.lower[j], arm.upper[j], arm.period[j]
        if high - low < period or (not period and (low > -inf or high < inf)):
            low, high = max(low, -_OPEN), min(high, _OPEN)
            out.append((j, 0.5 * (low + high), 0.5 * (high - low), period))
    return out


def offsets(q: Array, middle: float, period: float) -> Array:
    """Joint values from the middle of their range, turning ones on the nearest turn."""
    x = q - middle
    return without_turns(x, period) if period else np.asarray(x)


def outside(arm: Arm, q: Array, limits: bool) -> Array:
    """How far rows (..., dof) are outside the limits at most: (...,), negative inside."""
    out = np.full(q.shape[:-1], -inf)
    for j, middle, half, period in bounded_joints(arm) if limits else ():
        out = np.maximum(out, np.abs(offsets(q[..., j], middle, period)) - half)
    return out


def turned_inside(arm: Arm, q: Array) -> Array:
    """Rows (k, dof) with turning joints on the turn that is nearest to the middle of their range."""
    out = np.array(q)
    for j, middle, _, period in bounded_joints(arm):
        out[:, j] = middle + offsets(q[:, j], middle, period)
    return out
