"""Values of what is held: of joints, and of the arm angle."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["aims", "held_of"]


def held_of(arm: Arm, q: Array) -> Array:
    """What rows (..., dof) have of it: (..., held)."""
    values = q[..., list(arm.free)]
    if arm.angle is None:
        return values
    angle = arm.angle.of_rows(q, forward(arm.chain, q))
    return np.concatenate([values, angle[..., None]], axis=-1)


def aims(arm: Arm, T: Array, held: Array) -> Array:
    """What rows are refined towards: poses (k, 4, 4), and angles that are held (k, held)."""
    return T if arm.angle is None else arm.angle.aims(T, held[:, len(arm.free) :])
