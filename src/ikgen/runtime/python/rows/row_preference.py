"""Which rows are better than others."""

from __future__ import annotations

from math import inf, isfinite

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arguments.joint_arguments import seed_values
from ikgen.runtime.python.arm.chain_kinematics import tip_and_jacobian
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags, Row
from ikgen.runtime.python.rows.row_placement import place_rows_batch

__all__ = ["Preference", "preference_costs", "preference_of"]

Preference = tuple[str, Row, Row]  # its name; what rows are wanted near to, and the joints' weights


def preference_of(arm: Arm, prefer: str, seed: ArrayLike | None) -> Preference:
    """What rows are judged by: "near", to the seed; "centre", of the limits, as near without a seed; or
    "dexterous".

    Raises ValueError for another word, and for a bad seed.
    """
    if prefer not in ("near", "centre", "dexterous"):
        raise ValueError(f"prefer is {prefer!r}, expected 'near', 'centre' or 'dexterous'")
    near = seed_values(arm, seed)
    if prefer == "near" and near is not None:
        return prefer, near, (1.0,) * len(near)
    bounded = [isfinite(b - a) for a, b in zip(arm.lower, arm.upper)]
    middle = [0.5 * (a + b) if ok else 0.0 for a, b, ok in zip(arm.lower, arm.upper, bounded)]
    if near is not None:
        middle = [m if ok else s for m, s, ok in zip(middle, near, bounded)]
    halves = (
        max(0.5 * (b - a), 1e-6) if ok else inf for a, b, ok in zip(arm.lower, arm.upper, bounded)
    )
    return prefer, tuple(middle), tuple(1.0 / half**2 for half in halves)


def preference_costs(
    arm: Arm, preference: Preference, q: Array, limits: bool
) -> tuple[Array, Array, Flags]:
    """Rows (n, m, dof) on the turns that limits and preference ask for, their costs (n, m), less is
    better, and which are inside the limits (n, m).

    "near": the squared distance from the seed; "centre": from the middle of the limits, in halves of their
    range; "dexterous": minus the smallest singular value of the task's Jacobian (m/s and rad/s).
    """
    name, middle, weights = preference
    q = q.copy()
    for j in arm.free:
        period = arm.period[j]
        if period and not isfinite(arm.upper[j] - arm.lower[j]):
            q[..., j] += period * np.round((middle[j] - q[..., j]) / period)
    q, inside, _ = place_rows_batch(arm, q, np.tile(middle, (len(q), 1)), limits)
    if name != "dexterous":
        return q, np.asarray((q - np.array(middle)) ** 2 @ np.array(weights)), inside
    flat = q.reshape(-1, q.shape[-1])
    pose, J = tip_and_jacobian(arm.chain, flat)
    J[:, :3] *= arm.task.size  # rows are over it
    least = np.linalg.svd(arm.task.rows(pose, J), compute_uv=False)[:, arm.rank - 1]
    return q, np.asarray(-least.reshape(q.shape[:2])), inside
