"""The arm angle of an arm, measured as emitted code does."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.kinematics.elbow_geometry import elbow_geometry
from ikgen.model.dh import DHChain
from ikgen.runtime.python.arm.chain_kinematics import chain_of
from ikgen.runtime.python.held.arm_angle import ArmAngle

__all__ = ["held_angle", "held_values"]


def held_angle(dh: DHChain) -> ArmAngle | None:
    """The arm angle that is held; None where there is none."""
    if not dh.arm_angle:
        return None
    found = elbow_geometry(dh)
    rows = dh.rows[: len(found.elbow) - 1]
    motions = tuple((row.driver, row.revolute, row.scale, row.offset.value) for row in rows)
    elbow = chain_of(np.array(found.elbow), motions, len(motions))
    return ArmAngle(elbow, found.shoulder, found.wrist, found.upper)


def held_values(
    dh: DHChain, q: NDArray[np.float64], poses: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """What configurations (..., dof) at poses (..., 4, 4) have of what is held: (..., held), in the
    order of `DHChain.held`; None where nothing is."""
    if not dh.held:
        return None
    values = q[..., dh.free_indices]
    angle = held_angle(dh)
    if angle is None:
        return np.asarray(values)
    return np.concatenate([values, angle.of_rows(q, poses)[..., None]], axis=-1)
