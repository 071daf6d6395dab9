"""Newton's method on the chain: damped least squares (Levenberg 1944, Marquardt 1963)."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.chain_kinematics import Chain, tip_and_jacobian
from ikgen.runtime.python.solve_policy import Policy
from ikgen.runtime.python.task_interface import Task

__all__ = ["newton", "rank_loss", "refine"]


def refine(
    chain: Chain, task: Task, moving: Sequence[int], q: Array, T: Array, policy: Policy
) -> tuple[Array, Flags, Array]:
    """Newton steps of the joints `moving` from q (k, dof) towards T (k, 4, 4); which rows arrived, and
    the errors before (k,).

    At a fold of the solution set the steps halve the error. Elsewhere all digits are wanted, as rows may
    lie on a limit.
    """
    q = q.copy()
    error, before = np.full(len(q), inf), np.zeros(len(q))
    going = np.arange(len(q))
    for steps, fine, promising in policy.refinement:
        part = newton(chain, task, moving, q[going], T[going], steps, policy)
        q[going], error[going] = part[:2]
        before[going] = np.maximum(before[going], part[2])
        going = going[(error[going] >= fine) & (error[going] < promising)]
        if not len(going):
            break
    return q, error < policy.arrived, before


def newton(
    chain: Chain, task: Task, moving: Sequence[int], q: Array, T: Array, steps: int, policy: Policy
) -> tuple[Array, Array, Array]:
    """The best rows (k, dof) of at most `steps` damped steps, their errors and those of q (k,)."""
    moving = list(moving)
    best = np.full(len(q), inf)
    stalled = np.zeros(len(q), dtype=int)
    result, before = q.copy(), best
    for step in range(steps + 1):
        pose, J = tip_and_jacobian(chain, q)
        error = task.error(pose, T)
        worst = np.abs(error).max(axis=1)
        before = before if step else worst
        better = worst < best
        stalled = np.where(worst < policy.progress * best, 0, stalled + 1)
        result[better] = q[better]
        best = np.minimum(best, worst)
        going = (best > policy.converged) & (stalled < policy.patience)
        if step == steps or not going.any():
            break
        J = task.rows(pose, J)[:, :, moving]
        Jt = J.transpose(0, 2, 1)
        damping = np.maximum(policy.least_damping, policy.damping * np.minimum(worst, 1.0) ** 2)
        normal = Jt @ J + damping[:, None, None] * np.eye(len(moving))
        change = np.linalg.solve(normal, Jt @ error[:, :, None])[:, :, 0]
        q[:, moving] += np.clip(change, -policy.largest_step, policy.largest_step) * going[:, None]
    return result, best, before


def rank_loss(chain: Chain, task: Task, moving: Sequence[int], q: Array) -> Array:
    """Smallest singular value (k,) of the task's derivatives by the joints `moving` at q (k, dof)."""
    J = task.rows(*tip_and_jacobian(chain, q))[:, :, list(moving)]
    return np.asarray(np.linalg.svd(J, compute_uv=False)[:, -1])
