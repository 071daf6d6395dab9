"""Newton's method on the chain: damped least squares (Levenberg 1944, Marquardt 1963)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Chain, tip_and_jacobian
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.solved_arm import HeldAngle
from ikgen.runtime.python.arm.task_interface import Task
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.arrays.row_blocks import in_blocks

__all__ = [
    "clipped",
    "damped",
    "errors_and_slopes",
    "least_singular",
    "newton",
    "normal_inverse",
    "of_normal",
    "refine",
    "smallest_singular_values",
    "steeper",
]


_FAR_OUT = 1e4  # of the squared derivatives of a row: lever arms of some hundred metres
_ROUNDING = 4e-15  # of the sum of as many products
_LOST = 1e-14
_BLOCK = 1024  # rows whose arrays fit into a processor's cache


def refine(
    chain: Chain,
    task: Task,
    moving: Sequence[int],
    q: Array,
    T: Array,
    policy: Policy,
    angle: HeldAngle | None = None,
) -> tuple[Array, Array, Array, Array]:
    """Newton steps of the joints `moving` from q (k, dof) towards T (k, 4, 4); the errors that they leave,
    and those before (k,), and the task's derivatives by the joints (k, m, n) where the rows end. With an
    `angle` that is held T are its aims.

    At a fold of the solution set the steps halve the error. Elsewhere all digits are wanted, as rows may
    lie on a limit.
    """
    (steps, fine, promising), *further = policy.refinement

    def first(part: Array, aim: Array) -> tuple[Array, ...]:
        return newton(chain, task, moving, part, aim, steps, policy, angle)

    q, error, before, slope = in_blocks(first, _BLOCK, q, T)
    for more, finer, less in further:
        going = np.flatnonzero((error >= fine) & (error < promising))
        if not len(going):
            break
        part = newton(chain, task, moving, q[going], T[going], more, policy, angle)
        q[going], error[going], slope[going] = part[0], part[1], part[3]
        before[going] = np.maximum(before[going], part[2])
        fine, promising = finer, less
    return q, error, before, slope


def newton(
    chain: Chain,
    task: Task,
    moving: Sequence[int],
    q: Array,
    T: Array,
    steps: int,
    policy: Policy,
    angle: HeldAngle | None = None,
) -> tuple[Array, Array, Array, Array]:
    """The best rows (k, dof) of at most `steps` damped steps, their errors and those of q (k,), and the
    derivatives (k, m, n) at them."""
    moving = list(moving)
    best = np.full(len(q), inf)
    result, going, stalled = q.copy(), np.arange(len(q)), np.zeros(len(q), dtype=int)
    for step in range(steps + 1):
        error, J = errors_and_slopes(chain, task, moving, q, T, angle)
        worst = np.abs(error).max(axis=1)
        if step == 0:
            before, slope = worst, J.copy()
        least = best[going]
        better = worst < least
        slope[going[better]] = J[better]
        stalled = np.where(worst < policy.progress * least, 0, stalled + 1)
        result[going[better]] = q[better]
        best[going] = least = np.minimum(least, worst)
        on = (least > policy.converged) & (stalled < policy.patience)
        if step == steps or not on.any():
            break
        going, stalled, worst, q, T, J = (x[on] for x in (going, stalled, worst, q, T, J))
        Jt = J.transpose(0, 2, 1)
        damping = np.maximum(policy.least_damping, policy.damping * np.minimum(worst, 1.0) ** 2)
        normal = damped(Jt @ J, damping)
        change = of_normal(np.linalg.solve, normal, Jt @ error[on, :, None])[:, :, 0]
        q[:, moving] += clipped(change, policy.largest_step)
    return result, best, before, slope


def errors_and_slopes(
    chain: Chain,
    task: Task,
    moving: Sequence[int],
    q: Array,
    T: Array,
    angle: HeldAngle | None,
) -> tuple[Array, Array]:
    """Errors (k, m) of rows (k, dof), and their derivatives (k, m, n) by the joints `moving`."""
    pose, J = tip_and_jacobian(chain, q)
    error, slope = task.error(pose, T), task.rows(pose, J)
    if list(moving) != list(range(slope.shape[2])):
        slope = slope[:, :, list(moving)]
    if angle is None:
        return error, slope
    more, line = angle.errors(q, T)
    parts = error, more[:, None], slope, line[:, None, list(moving)]
    return np.concatenate(parts[:2], axis=1), np.concatenate(parts[2:], axis=1)


def smallest_singular_values(
    chain: Chain, task: Task, moving: Sequence[int], q: Array, rank: int | None = None
) -> Array:
    """Smallest singular value (k,) of the task's derivatives by the joints `moving` at q (k, dof), of as
    many as the task fixes freedoms, `rank`, where these joints are more."""
    return least_singular(task.rows(*tip_and_jacobian(chain, q))[:, :, list(moving)], rank)


def steeper(slope: Array, bound: float) -> Flags:
    """Which derivatives (k, m, n) have no singular value below `bound`; of those near it some may not be
    told. Each column is at least the smallest singular value away from what the others span, and the
    nearest of n at most its sqrt(n)-fold."""
    nearest = 1.0 / np.sqrt(np.einsum("kii->ki", normal_inverse(slope)).max(axis=1))
    return np.asarray(nearest > bound * slope.shape[2] ** 0.5)


def normal_inverse(slope: Array, damping: float = 1e-14) -> Array:
    """Inverses (k, n, n) of the normal equations of derivatives (k, m, n); never singular."""
    return of_normal(np.linalg.inv, damped(slope.transpose(0, 2, 1) @ slope, damping))


def of_normal(function: Callable[..., Array], normal: Array, *right: Array) -> Array:
    """What NumPy's `inv` or `solve` makes of normal equations (k, n, n). Where two directions at once do
    nothing, round-off may leave nothing of the damping: as much is added there then, or more."""
    lost = _LOST
    while True:
        try:
            return np.asarray(function(normal, *right))
        except np.linalg.LinAlgError:
            flat = np.linalg.slogdet(normal)[0] == 0.0
            flat |= not flat.any()
            normal = normal + np.where(flat, lost, 0.0)[:, None, None] * np.eye(normal.shape[1])
            lost *= 100.0


def damped(square: Array, damping: Array | float) -> Array:
    """Matrices (k, n, n) of normal equations, damped. Beside a slide that is very far out the rounding of
    the others is more than the damping: there as much is added as they may be off."""
    count, n, _ = square.shape
    out: Array = square.copy()
    diagonal = out.reshape(count, n * n)[:, :: n + 1]
    size = np.add.reduce(diagonal, axis=1)
    enough = np.maximum(damping, np.where(size > _FAR_OUT, _ROUNDING * size, 0.0))
    diagonal += enough[:, None]
    return out


def clipped(step: Array, most: float) -> Array:
    """As np.clip has it, which takes longer for few numbers."""
    return np.asarray(np.minimum(np.maximum(step, -most), most))


def least_singular(slope: Array, rank: int | None = None) -> Array:
    """Smallest singular value (k,) of derivatives (k, m, n), or the `rank`-th: entries of unit vectors that
    a task reads depend on each other, so that with more joints than it fixes freedoms some are always 0."""
    values = np.linalg.svd(slope, compute_uv=False)
    return np.asarray(values[:, values.shape[1] - 1 if rank is None else rank - 1])
