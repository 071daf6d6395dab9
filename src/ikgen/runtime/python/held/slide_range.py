"""Where on a slide an arm has to be for a pose: of a long travel no more is searched."""

from __future__ import annotations

from math import inf

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["slide_range"]

_ACROSS = 1e-9  # cosine of slides at a right angle


def slide_range(arm: Arm, T: Array, joint: int) -> tuple[float, float]:
    """The values of a joint beyond which the arm's lengths keep its tip from the position of a pose
    (4, 4): of a slide that nothing turns; else all."""
    chain, everywhere = arm.chain, (-inf, inf)
    n = len(chain.motions)
    first = next((i for i, motion in enumerate(chain.motions) if motion[1]), n)  # that turns
    own = [i for i, motion in enumerate(chain.motions) if motion[0] == joint]
    if own[-1] >= first or not any(column == 3 for _, column in arm.task.entries):
        return everywhere
    axes, F = [], chain.frames[0]
    for i in range(first):
        axes.append(F[:3, 2])
        F = F @ chain.frames[i + 1]
    along = axes[own[0]]
    slope, low, high = 0.0, float(along @ F[:3, 3]), float(along @ F[:3, 3])
    for i, (j, turns, scale, offset) in enumerate(chain.motions):
        ends = (offset, offset) if j == joint else _travel(arm, i)
        if i >= first:
            far = float(np.linalg.norm(chain.frames[i + 1][:3, 3]))
            far += 0.0 if turns else max(map(abs, ends))
            low, high = low - far, high + far
        elif abs(share := float(along @ axes[i])) > _ACROSS:
            slope += share * scale if j == joint else 0.0
            low, high = low + min(share * x for x in ends), high + max(share * x for x in ends)
    if abs(slope) < _ACROSS:
        return everywhere
    at = float(along @ T[:3, 3])
    ends = (at - low) / slope, (at - high) / slope
    return min(ends), max(ends)


def _travel(arm: Arm, i: int) -> tuple[float, float]:
    """The ends of a motion."""
    j, _, scale, offset = arm.chain.motions[i]
    return scale * arm.lower[j] + offset, scale * arm.upper[j] + offset
