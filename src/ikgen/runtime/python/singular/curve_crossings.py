"""Curves that cross others, on which all but one direction of the pose's error is taken away: there two
directions hardly move the pose."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.newton.arm_newton import linearized, moved_rows
from ikgen.runtime.python.rows.solution_rows import places
from ikgen.runtime.python.singular.curve_parts import Parts, between
from ikgen.runtime.python.singular.fold_pair import Reduced

__all__ = ["beside_crossings"]

_MOST = 4  # crossings of a curve
_HALVES = 4  # by which they are found
_ASIDE = 0.4  # rad or m: so far from a crossing curves are apart


def beside_crossings(arm: Arm, parts: Parts, T: Array) -> tuple[Index, Array]:
    """Rows (n, dof) beside places where others cross the curves of some parts, and whose these are (n,): a
    way along the second direction that hardly moves the pose.

    Where that one is passed, the sense turns round in which the others with the still one for what is left
    move the pose."""
    owner = parts.owner
    if not len(owner):
        return owner, parts.a.q
    sense = _keeps(arm, parts.a, T[owner])
    crossing = np.flatnonzero(sense != _keeps(arm, parts.b, T[owner]))
    crossing = crossing[np.argsort(owner[crossing], kind="stable")]
    crossing = crossing[places(owner[crossing]) < _MOST]
    if not len(crossing):
        return owner[crossing], parts.a.q[crossing]
    parts, sense = some_of(parts, crossing), sense[crossing]
    aim = T[parts.owner]
    for _ in range(_HALVES):
        middle = between(arm, parts, np.full(len(parts.owner), 0.5), T)
        before = _keeps(arm, middle, aim) == sense
        parts = parts._replace(
            a=_chosen(before, middle, parts.a), b=_chosen(before, parts.b, middle)
        )
    other = np.linalg.svd(_across(arm, parts.a, aim))[2][:, -2]
    step = _ASIDE / np.abs(other).max(axis=1)[:, None] * other
    return parts.owner, moved_rows(arm, parts.a.q, step)


def _across(arm: Arm, at: Reduced, T: Array) -> Array:
    """What directions across the still ones do to the pose (k, m, n)."""
    _, slope = linearized(arm, at.q, T)
    flow = np.matmul(slope, at.still[:, :, None])
    return np.asarray(slope - flow * at.still[:, None, :])


def _keeps(arm: Arm, at: Reduced, T: Array) -> Flags:
    """Whether what the others do to the pose, with `out` for the still one, keeps orientation."""
    V = _across(arm, at, T)
    if V.shape[1] != V.shape[2]:
        return np.ones(len(V), dtype=bool)
    turned = V + at.out[:, :, None] * at.still[:, None, :]
    return np.asarray(np.linalg.det(turned) >= 0.0)


def _chosen(some: Flags, one: Reduced, other: Reduced) -> Reduced:
    """The first of two where `some` (k,) is set."""
    pairs = zip(one, other)
    return Reduced(*(np.where(some.reshape(-1, *[1] * (a.ndim - 1)), a, b) for a, b in pairs))
