"""Undamped Newton steps of all rows at once, and which of them leave no doubt."""

from __future__ import annotations

from functools import partial

import numpy as np

from ikgen.runtime.python.arm.lane_chain import LaneChain
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.arrays.row_blocks import in_blocks
from ikgen.runtime.python.newton.arm_newton import linearized, moved_rows
from ikgen.runtime.python.newton.lane_newton import Refined, begins, ends, refine_lanes
from ikgen.runtime.python.newton.refinement import normal_inverse
from ikgen.runtime.python.rows.solution_rows import rows_of

__all__ = ["refine_few", "refine_together"]

_BLOCK = 1024
_FEW = 64  # rows for which whole matrices are faster than long rows of each of their entries


def refine_together(
    chain: LaneChain, arm: Arm, q: Array, T: Array, share: float = 0.0
) -> tuple[Array, Flags, Flags]:
    """Rows (k, dof) after steps towards aims T (k, ...) or (1, ...); which arrived at the one solution near
    their start, and which at a least error that is not 0.

    Newton's method contracts by `policy.contraction` only near the one solution there (Deuflhard 2004,
    theorem 2.1). Where the solution set folds, the other solution is twice the pivot over the curvature
    away: rows whose first step is more than `policy.pivot_share` of the pivot are left to others, unless
    the product of the two smallest singular values tells that there are none; with a `share` all have to
    show that, by so much of it.
    """
    with np.errstate(all="ignore"):
        if len(q) <= _FEW:
            end = refine_few(arm, q, T)
        elif arm.angle is None:
            end = refine_lanes(arm, chain, q, np.broadcast_to(T, (len(q), *T.shape[1:])))
        else:
            T = np.broadcast_to(T, (len(q), *T.shape[1:]))
            end = Refined(*in_blocks(partial(refine_few, arm), _BLOCK, q, T))
        end.missed[end.strained] = False
        judged = end.arrived & (end.strained | (share > 0.0))
        if judged.any():
            _judge(arm, end, T, judged, share or 1.0)
    return end.q, end.arrived, end.missed


def _judge(arm: Arm, end: Refined, T: Array, those: Flags, share: float) -> None:
    """Leaves of those that arrived the ones beside which nothing can have come in. Along the direction
    in which the pose moves least, by s1, what the file is off by turns the others by that over s2 at most,
    the next singular value; only where this is as much as s1 may the pose come to rest once more."""
    some = np.flatnonzero(those)
    _, slope = linearized(arm, end.q[some], rows_of(T, some))
    least = np.linalg.svd(slope, compute_uv=False)[:, -2:]
    end.arrived[some] = np.multiply.reduce(least, axis=1) > share * arm.policy.fold_product


def refine_few(arm: Arm, q: Array, T: Array) -> Refined:
    """Newton steps of few rows, of which calls cost more than sums. Every second step is solved with the
    inverse of the one before, and what that leaves of it once more, as in `refine_lanes`."""
    policy, start = arm.policy, q
    good, strained = np.ones(len(q), dtype=bool), np.zeros(len(q), dtype=bool)
    before = np.full(len(q), policy.farthest_start)
    for steps in range(0, policy.lane_steps, 2):
        error, slope = _linearized(arm, q, T)
        inverse, pivot = _left_inverse(slope)
        change = inverse @ error
        size, worst = _largest(change[:, :, 0]), _largest(error[:, :, 0])
        near, far = begins(policy, size, worst, before, pivot, not steps)
        good, strained = good & near, strained | far
        q = moved_rows(arm, q, change[:, :, 0])
        rest, slope = _linearized(arm, q, T)
        worst = _largest(rest[:, :, 0])
        change = inverse @ rest
        rest = rest - slope @ change
        more = inverse @ rest
        rest, change = rest - slope @ more, change + more
        before, size = size, _largest(change[:, :, 0])
        near, done = ends(policy, before, size, worst, _largest(more[:, :, 0]), pivot)
        good &= near
        q, before = moved_rows(arm, q, change[:, :, 0]), size
        if (done | ~good).all():
            break
    done, off = done & good, _largest(rest[:, :, 0])
    arrived, missed = done & (off < policy.arrived), done & (off > policy.least_miss)
    return Refined(np.where(done[:, None], q, start), arrived, missed, strained)


def _largest(x: Array) -> Array:
    return np.asarray(np.maximum.reduce(np.abs(x), axis=1))


def _linearized(arm: Arm, q: Array, T: Array) -> tuple[Array, Array]:
    """Errors (k, m, 1) at rows (k, dof), and their derivatives (k, m, n)."""
    error, slope = linearized(arm, q, T)
    return error[:, :, None], slope


def _left_inverse(V: Array) -> tuple[Array, Array]:
    """The left inverse (k, n, m) of V (k, m, n); how far its columns are from the span of the others at
    least (k,)."""
    if V.shape[1] == V.shape[2]:
        try:
            inverse: Array = np.asarray(np.linalg.inv(V))
        except np.linalg.LinAlgError:
            pass
        else:
            return inverse, 1.0 / np.sqrt(_largest(np.add.reduce(inverse * inverse, axis=2)))
    normal = normal_inverse(V)  # of no rank, its product with V is 0 where it should be infinite
    pivot = 1.0 / np.sqrt(_largest(np.einsum("kii->ki", normal)))
    return np.asarray(normal @ V.transpose(0, 2, 1)), pivot
