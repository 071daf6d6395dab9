"""Where continua that the arm has go on inside the limits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ikgen.runtime.python.arm.limit_margins import outside
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index, Row
from ikgen.runtime.python.newton.arm_newton import refined
from ikgen.runtime.python.singular.curve_parts import Parts, between
from ikgen.runtime.python.singular.near_continuum import LEAST, followed, on_curves

__all__ = ["rows_along"]

_GOLDEN = 0.6180339887498949
_HALVINGS = 40
_ENOUGH = 0.5  # of `policy.limit_tolerance`
_WAY = 1.2  # of `policy.try_step`: by so much joints move from one sample to the next at most


def rows_along(
    arm: Arm, q: Array, T: Array, stands: Sequence[tuple[int, Row]]
) -> tuple[Index, Array]:
    """Rows (n, dof) inside the limits, whole turns aside, of the continua through solutions q (k, dof) of
    aims T (k, ...), and whose they are (n,): one of each at most, none where a row on it stands for it.
    `stands`: such rows, each with a solution of its pose."""
    with np.errstate(all="ignore"):
        parts, _, same, worst, steps = followed(arm, q, T)
        whole = (steps >= LEAST) & (worst < arm.policy.arrived)
        marks = list(dict.fromkeys((int(same[k]), row) for k, row in stands if whole[same[k]]))
        if marks:
            whose = np.array([k for k, _ in marks], dtype=np.intp)
            on = on_curves(arm, parts, whose, np.array([row for _, row in marks]), T)
            whole[whose[on]] = False
        parts = some_of(parts, whole[parts.owner])
        parts = some_of(parts, np.lexsort((parts.place, parts.owner)))
        parts = some_of(parts, _beside_least(arm, parts))
        off, rows = _least_outside(arm, parts, T)
    order = np.lexsort((off, parts.owner))
    order = order[off[order] < arm.policy.limit_tolerance]
    ends, error, _, _ = refined(arm, rows[order], T[parts.owner[order]])
    right = error < arm.policy.arrived
    owner, first = np.unique(parts.owner[order[right]], return_index=True)
    return owner, ends[right][first]


def _beside_least(arm: Arm, parts: Parts) -> Flags:
    """Which parts (n,), in order, have an end that is outside by no more than the samples beside it, and
    may come inside."""
    a, b = outside(arm, parts.a.q, True), outside(arm, parts.b.q, True)
    linked = (np.diff(parts.owner) == 0) & (np.diff(parts.place) == 1.0)
    first, last = a <= b, b <= a
    first[1:] &= ~linked | (a[1:] <= a[:-1])
    last[:-1] &= ~linked | (b[:-1] <= b[1:])
    return np.asarray((first | last) & (a + b < _WAY * arm.policy.try_step))


def _least_outside(arm: Arm, parts: Parts, T: Array) -> tuple[Array, Array]:
    """By how much rows of parts are outside at least (n,), by the golden section (Kiefer 1953), and these
    (n, dof); of a curve until one is inside."""
    count = len(parts.owner)
    low, high = np.zeros(count), np.ones(count)
    ends = np.stack([parts.a.q, parts.b.q])
    off = outside(arm, ends, True)
    best = off.argmin(axis=0)
    rows, least = ends[best, np.arange(count)], off.min(axis=0, initial=np.inf)
    shares = np.stack([high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)])
    values = np.full(shares.shape, np.nan)
    for _ in range(_HALVINGS):
        enough = least < _ENOUGH * arm.policy.limit_tolerance
        going = np.flatnonzero(~np.isin(parts.owner, parts.owner[enough]))
        if not len(going):
            break
        some = some_of(parts, going)
        for side in range(2):
            new = np.isnan(values[side, going])
            which = going[new]
            q = between(arm, some_of(some, new), shares[side, which], T).q
            values[side, which] = here = outside(arm, q, True)
            better = here < least[which]
            rows[which[better]], least[which[better]] = q[better], here[better]
        left = values[0, going] < values[1, going]
        for side, k in ((0, going[left]), (1, going[~left])):
            (low if side else high)[k] = shares[1 - side, k]
            shares[1 - side, k], values[1 - side, k] = shares[side, k], values[side, k]
            part = _GOLDEN * (high - low)[k]
            shares[side, k] = low[k] + part if side else high[k] - part
            values[side, k] = np.nan
    return least, rows
