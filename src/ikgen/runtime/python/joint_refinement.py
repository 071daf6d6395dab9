"""Undamped Newton steps of all rows at once, and which of them leave no doubt."""

from __future__ import annotations

from functools import partial

import numpy as np

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.chain_kinematics import forward, tip_and_jacobian
from ikgen.runtime.python.refinement import in_blocks
from ikgen.runtime.python.solved_arm import Arm

__all__ = ["refine_together"]

_FEW = 64  # rows that together take hardly longer than one: it pays to treat them alike


def refine_together(arm: Arm, q: Array, T: Array) -> tuple[Array, Flags, Flags]:
    """Rows (k, dof) after steps towards T (k, 4, 4); which arrived at the one solution near their start,
    and which at a least error that is not 0.

    Newton's method contracts by `policy.contraction` only near the one solution there (Deuflhard 2004,
    theorem 2.1).
    """
    q, arrived, missed = in_blocks(partial(_refined_block, arm), q, T)
    return q, arrived, missed


def _refined_block(arm: Arm, q: Array, T: Array) -> tuple[Array, Flags, Flags]:
    policy, row, moving = arm.policy, q.copy(), list(arm.moving)
    q, arrived = row, np.zeros(len(q), dtype=bool)
    missed, going, before = (
        arrived.copy(),
        np.arange(len(q)),
        np.full(len(q), policy.farthest_start),
    )
    slope = inverse = np.empty(0)
    for step in range(policy.lane_steps):
        near = before < policy.near  # so close that the slope is the one before
        if step not in (1, 2) or (len(row) <= _FEW and not near.all()):
            near[:] = False
        if near.all():
            error, good = arm.task.error(forward(arm.chain, row), T), near
        elif not near.any():
            error, slope, inverse, good = _linearized(arm, row, T)
        else:
            new, error, good = ~near, np.empty(slope.shape[:2]), near.copy()
            error[near] = arm.task.error(forward(arm.chain, row[near]), T[near])
            error[new], slope[new], inverse[new], good[new] = _linearized(arm, row[new], T[new])
        change = (inverse @ error[:, :, None])[:, :, 0]
        size = np.abs(change).max(axis=1)
        most = policy.contraction * before if step else before
        good = good & ((size < most) | (size < policy.converged))
        row[:, moving] += change
        if step:
            done = (size * size < policy.converged * before) | (size < policy.converged)
            done &= good
            if done.any():
                rest = np.abs(error - (slope @ change[:, :, None])[:, :, 0]).max(axis=1)
                q[going[done]] = row[done]
                arrived[going] = done & (rest < policy.arrived)
                missed[going] = done & (rest > policy.least_miss)
                good &= ~done
        if not good.any():
            break
        before = size
        if not good.all():
            going, before, row, T = going[good], before[good], row[good], T[good]
            slope, inverse = slope[good], inverse[good]
    return q, arrived, missed


def _linearized(arm: Arm, q: Array, T: Array) -> tuple[Array, Array, Array, Flags]:
    """Errors (k, m) at rows (k, dof), their derivatives (k, m, n), left inverses of these, and which rows
    are far from a singularity."""
    pose, J = tip_and_jacobian(arm.chain, q)
    slope = arm.task.rows(pose, J)[:, :, list(arm.moving)]
    inverse, pivot = _inverse(slope)
    return arm.task.error(pose, T), slope, inverse, pivot > arm.policy.least_pivot


def _inverse(J: Array) -> tuple[Array, Array]:
    """The left inverses of J (k, m, n), and how far the nearest column of each is from the others' span."""
    Jt = J.transpose(0, 2, 1)
    G = np.linalg.inv(Jt @ J + 1e-14 * np.eye(J.shape[2]))  # never singular
    return G @ Jt, 1.0 / np.sqrt(np.einsum("kii->ki", G).max(axis=1))
