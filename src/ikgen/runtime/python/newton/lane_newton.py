"""Newton steps of many rows at once, which are the last axis of all arrays."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ikgen.runtime.python.arm.lane_chain import (
    LaneChain,
    Sines,
    lane_jacobian,
    sines,
    turned,
    walk,
)
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags, Single

__all__ = ["Refined", "begins", "ends", "refine_lanes"]

_BLOCK = 2048  # rows whose arrays fit into a processor's cache
_ROUND_OFF = 1e-14  # of errors (rad, or m over the arm's size)
_UNMOVED = 1e-3  # of the pivot: rows that are moved by less stay the solutions that they are


class Refined(NamedTuple):
    """Rows `q` (k, dof) after steps; which `arrived` (k,) at the one solution near their start, and which
    `missed` (k,), at a least error that is not 0; the first step of `strained` ones (k,) was more than
    `policy.pivot_share` of the pivot: what they tell is to be judged."""

    q: Array
    arrived: Flags
    missed: Flags
    strained: Flags


def refine_lanes(arm: Arm, chain: LaneChain, q: Array, T: Array) -> Refined:
    """Refine rows (k, dof) towards T (k, 4, 4)."""
    q = q.T.copy()
    arrived, missed, strained = np.zeros((3, q.shape[1]), dtype=bool)
    before = np.full(q.shape[1], arm.policy.farthest_start)
    parts: list[Any] = [slice(i, i + _BLOCK) for i in range(0, q.shape[1], _BLOCK)]
    for steps in range(0, arm.policy.lane_steps, 2):
        left = []
        for part in parts:
            aim = np.ascontiguousarray(T[part].transpose(1, 2, 0)[:3])
            end = _two_steps(arm, chain, q[:, part], aim, before[part], steps == 0)
            moved, before[part], done, good, off, far = end
            q[:, part] = np.where(good, moved, q[:, part])
            arrived[part] = done & (off < arm.policy.arrived)
            missed[part] = done & (off > arm.policy.least_miss)
            strained[part] |= far
            left.append(np.arange(q.shape[1])[part][good & ~done])
        going = np.concatenate(left)
        if not len(going):
            break
        parts = [going[i : i + _BLOCK] for i in range(0, len(going), _BLOCK)]
    return Refined(q.T, arrived, missed, strained)


def _two_steps(
    arm: Arm, chain: LaneChain, q: Array, T: Array, before: Array, first: bool
) -> tuple[Array, Array, Flags, Flags, Array, Flags]:
    """Rows (dof, k) after two steps towards T (3, 4, k), the second's size (k,), which are at the end,
    which may come there, what is left of the errors, and which are `strained`, of the `first`.

    The second is solved with the inverse of the first; what that leaves of it once more (iterative
    refinement; Wilkinson 1963). `before`: what the first step is less than, where it is the
    first of all; else what it is a part of.
    """
    policy = arm.policy
    values = chain.changes(q) + chain.offset
    angles = sines(values)
    error, slope = _linearized(arm, chain, values, angles, T)
    inverse, pivot = _left_inverse(slope)
    change = np.einsum("imk,mk->ik", inverse, error)
    size, worst = np.abs(change).max(axis=0), np.abs(error).max(axis=0)
    good, strained = begins(policy, size, worst, before, pivot, first)
    turn = _of_joints(arm, change)
    q, turns = q + turn, chain.changes(turn)
    values, angles = values + turns, turned(angles, turns)
    rest, slope = _linearized(arm, chain, values, angles, T)
    worst = np.abs(rest).max(axis=0)
    change = np.einsum("imk,mk->ik", inverse, rest)
    rest -= np.einsum("imk,ik->mk", slope, change)
    more = np.einsum("imk,mk->ik", inverse, rest)
    rest -= np.einsum("imk,ik->mk", slope, more)
    change += more
    before, size = size, np.abs(change).max(axis=0)
    near, done = ends(policy, before, size, worst, np.abs(more).max(axis=0), pivot)
    good &= near
    left = np.abs(rest).max(axis=0)
    return q + _of_joints(arm, change), size, good & done, good, left, strained


def begins(
    policy: Policy, size: Array, worst: Array, before: Array, pivot: Array | Single, first: bool
) -> tuple[Flags, Flags]:
    """Which first steps of two, of this `size` (k,) towards errors of at most `worst` (k,), may lead to the
    solution near their start; and which are `strained`, where they are the `first` of all."""
    small = _is_round_off(policy, size, worst, pivot)
    strained = ~small & (size > policy.pivot_share * pivot) if first else np.zeros_like(small)
    small |= size < (before if first else policy.contraction * before)
    return small & (pivot > policy.least_pivot), strained


def ends(
    policy: Policy, before: Array, size: Array, worst: Array, more: Array, pivot: Array | Single
) -> tuple[Flags, Flags]:
    """As `begins`, of second steps, `more` the size of what was left of them; and which are the last."""
    small = _is_round_off(policy, size, worst, pivot)
    done = size**3 < policy.converged * before**2
    done &= more**2 < policy.converged * size
    return (size < policy.contraction * before) | small, done | small


def _is_round_off(policy: Policy, size: Array, worst: Array, pivot: Array | Single) -> Flags:
    """Which steps are; those near singularities are as much longer as these enlarge it."""
    enlarged = (worst < _ROUND_OFF) & (size < _UNMOVED * pivot)
    return np.asarray((size < policy.converged) | enlarged)


def _linearized(
    arm: Arm, chain: LaneChain, values: Array, angles: Sines, T: Array
) -> tuple[Single, Single]:
    """Errors (m, k) at the links' values (n, k) and their derivatives (moving, m, k)."""
    tip, axes = walk(chain, values, angles)
    J = lane_jacobian(chain, tip, axes, len(arm.lower))
    if arm.free:
        J = J[list(arm.moving)]
    return chain.task.error(tip, T).astype(np.float32), chain.task.rows(tip, J)


def _of_joints(arm: Arm, change: Single) -> Array:
    """Changes (dof, k) of all joints."""
    if not arm.free:
        return change.astype(np.float64)
    out = np.zeros((len(arm.lower), change.shape[1]))
    out[list(arm.moving)] = change
    return out


def _left_inverse(V: Single) -> tuple[Single, Single]:
    """The left inverses (n, m, k) of V (n, m, k), columns first, and how far the nearest column of each is
    from the span of those before it: by `V = Q R` (modified Gram-Schmidt)."""
    Q, out = V.copy(), np.empty_like(V)
    above, lengths = [], []
    for k, column in enumerate(Q):
        length = np.sqrt(np.einsum("mk,mk->k", column, column))
        column /= length
        above.append(np.einsum("imk,mk->ik", Q[k + 1 :], column))
        Q[k + 1 :] -= above[k][:, None] * column
        lengths.append(length)
    for k in reversed(range(len(V))):
        rest = Q[k] - np.einsum("ik,imk->mk", above[k], out[k + 1 :])
        np.divide(rest, lengths[k], out=out[k])
    return out, np.min(lengths, axis=0)
