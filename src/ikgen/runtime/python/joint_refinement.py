"""Undamped Newton steps of all rows at once, and which of them leave no doubt."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.chain_kinematics import forward, tip_and_jacobian
from ikgen.runtime.python.solved_arm import Arm

__all__ = ["refine_together"]


def refine_together(arm: Arm, q: Array, T: Array) -> tuple[Array, Flags, Flags]:
    """Rows (k, dof) after steps towards T (k, 4, 4); which arrived at the one solution near their start,
    and which at a least error that is not 0.

    Newton's method contracts by `policy.contraction` only near the one solution there (Deuflhard 2004,
    theorem 2.1).
    """
    policy, q, done = arm.policy, q.copy(), np.zeros(len(q), dtype=bool)
    before, good = np.full(len(q), policy.farthest_start), ~done
    slope = inverse = error = change = np.empty(0)
    for step in range(policy.lane_steps):
        if (
            step in (1, 2) and before.max(initial=0.0) < policy.near
        ):  # so close that the slope is the one before
            error = arm.task.error(forward(arm.chain, q), T)
        else:
            pose, J = tip_and_jacobian(arm.chain, q)
            error = arm.task.error(pose, T)
            slope = arm.task.rows(pose, J)[:, :, list(arm.moving)]
            inverse, pivot = _inverse(slope)
            good &= pivot > policy.least_pivot
        change = (inverse @ error[:, :, None])[:, :, 0]
        size = np.abs(change).max(axis=1)
        most = before if step == 0 else policy.contraction * before
        good &= (size < most) | (size < policy.converged)
        q[:, arm.moving] += change * good[:, None]
        if step:
            done = ~good | (size * size < policy.converged * before) | (size < policy.converged)
            if done.all():
                break
        before = size
    good &= done
    rest = np.abs(error - (slope @ change[:, :, None])[:, :, 0]).max(axis=1)
    return q, good & (rest < policy.arrived), good & (rest > policy.least_miss)


def _inverse(J: Array) -> tuple[Array, Array]:
    """The left inverses of J (k, m, n), and how far the nearest column of each is from the others' span."""
    Jt = J.transpose(0, 2, 1)
    G = np.linalg.inv(Jt @ J + 1e-14 * np.eye(J.shape[2]))  # never singular
    return G @ Jt, 1.0 / np.sqrt(np.einsum("kii->ki", G).max(axis=1))
