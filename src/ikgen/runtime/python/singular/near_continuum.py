"""Solutions on what is a continuum of the geometry that was solved, and none of the file's.

Along it the other joints take the pose's error away but for one direction (Lyapunov and Schmidt's
reduction; Golubitsky & Schaeffer 1985, I.3): a solution is where what is left changes its sign, or
touches 0."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import joined, some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.newton.arm_newton import refined
from ikgen.runtime.python.newton.refinement import least_singular
from ikgen.runtime.python.rows.row_links import differences
from ikgen.runtime.python.rows.solution_rows import places
from ikgen.runtime.python.singular.curve_crossings import beside_crossings
from ikgen.runtime.python.singular.curve_parts import BEYOND, Parts, between, look
from ikgen.runtime.python.singular.curve_samples import sampled, samples_beside
from ikgen.runtime.python.singular.fold_pair import Reduced

__all__ = ["LEAST", "Traced", "followed", "on_curves", "rows_around", "trace"]

_MOST = 96  # samples to a side of a curve
LEAST = 4
"""Samples of what is a curve."""
_ASTRAY = 4  # samples in a row that show that no curve is near
_BESIDE, _SAME_WAY = 0.06, 0.9
_OVER, _ON, _ROUNDS = 0.05, 1e-6, 3  # of a part; rad or m off it


class Traced(NamedTuple):
    """Which starts (k,) lie on a `curve` of the solved geometry, and which of these are `broken` (k,), none
    of the file's arm; the starts `owner` (n,) of solutions, nearly, `q` (n, dof) on broken ones."""

    curve: Flags
    broken: Flags
    owner: Index
    q: Array


def rows_around(arm: Arm, q: Array, T: Array, broken: Flags) -> tuple[Flags, Index, Array, Array]:
    """Which rows q (k, dof) towards aims T (k, ...) stand for a continuum of the solved geometry; from
    which (n,) the solutions (n, dof) all around are, or one where the file's arm has the continuum too, and
    the smallest singular values (n,) there. `broken` (k,): from which only of such that the file's arm has
    not, and no others than those that are right to round-off."""
    with np.errstate(all="ignore"):
        traced = trace(arm, q, T)
    given = np.flatnonzero(traced.curve & ~broken)
    owner = np.concatenate([traced.owner, given])
    rows, error, _, slope = refined(arm, np.concatenate([traced.q, q[given]]), T[owner])
    exact = error < arm.policy.exact
    best = np.lexsort((error, owner))
    best = best[places(owner[best]) == 0]
    best = best[~np.isin(owner[best], owner[exact]) & (error[best] < arm.policy.arrived)]
    best = best[~broken[owner[best]]]
    some = np.concatenate([np.flatnonzero(exact), best])
    some = some[np.argsort(owner[some], kind="stable")]
    curve = np.where(broken, traced.broken, traced.curve)
    return curve, owner[some], rows[some], least_singular(slope[some])


def trace(arm: Arm, q: Array, T: Array) -> Traced:
    """The curves through rows q (k, dof) towards aims T (k, ...), once around, or to both their ends, and
    others that cross broken ones; of equal ones one is followed."""
    asked = np.concatenate([q, T.reshape(len(q), -1)], axis=1)
    _, first, again = np.unique(asked, axis=0, return_index=True, return_inverse=True)
    again = again.reshape(-1)
    curve, broken, owner, rows = _traced(arm, q[first], T[first])
    begin, end = np.searchsorted(owner, again), np.searchsorted(owner, again, side="right")
    whose = np.repeat(np.arange(len(q)), end - begin)
    return Traced(curve[again], broken[again], whose, rows[begin[whose] + places(whose)])


def _traced(arm: Arm, q: Array, T: Array) -> Traced:
    """`trace` of rows that differ."""
    parts, ends, worst = followed(arm, q, T)
    steps, broken = _kinds(arm, parts, worst)
    here, last = some_of(parts, broken[parts.owner]), some_of(ends, broken[ends.owner])
    found = look(arm, joined(here, last, _crossing_parts(arm, here, T)), T, steps)
    return Traced(steps >= LEAST, broken, *found)


def _kinds(arm: Arm, parts: Parts, worst: Array) -> tuple[Index, Flags]:
    """How many samples (k,) there are of what was followed, with the most (k,) that is left there, and
    which are curves of the solved geometry that the file's arm has not."""
    steps = np.bincount(parts.owner, minlength=len(worst))
    curve = steps >= LEAST
    broken = curve & (worst >= arm.policy.arrived)
    return steps, broken


def _crossing_parts(arm: Arm, parts: Parts, T: Array) -> Parts:
    """The parts of broken curves that cross those of some parts."""
    owner, q = beside_crossings(arm, parts, T)
    none: Parts = some_of(parts, owner[:0])
    if not len(owner):
        return none
    first = samples_beside(arm, q, T[owner])
    fresh = ~on_curves(arm, parts, owner, first.q, T)
    first, owner = some_of(first, fresh), owner[fresh]
    if not len(owner):
        return none
    more, ends, worst = _follow(arm, first, T[owner])
    _, broken = _kinds(arm, more, worst)
    out: Parts = joined(*(some_of(some, broken[some.owner]) for some in (more, ends)))
    return out._replace(owner=owner[out.owner])


def followed(arm: Arm, q: Array, T: Array) -> tuple[Parts, Parts, Array]:
    """The curves beside rows q (k, dof) towards aims T (k, ...), as `_follow` has them."""
    return _follow(arm, samples_beside(arm, q, T), T)


def on_curves(arm: Arm, parts: Parts, owner: Index, q: Array, T: Array) -> Flags:
    """Which rows q (n, dof) lie on the curves of their starts `owner` (n,), towards aims T (k, ...)."""
    out, moving = np.zeros(len(q), dtype=bool), list(arm.moving)
    row, part = np.nonzero(owner[:, None] == parts.owner)
    parts = some_of(parts, part)
    chord = (parts.b.q - parts.a.q)[:, moving]
    way = differences(arm, parts.a.q, q[row])[:, moving]
    share = (way * chord).sum(axis=1) / (chord**2).sum(axis=1)
    near = np.abs(way - share[:, None] * chord).max(axis=1) < _BESIDE
    near &= (share > -_OVER) & (share < 1.0 + _OVER)
    row, parts = row[near], some_of(parts, near)
    at = between(arm, parts, share[near], T)
    for _ in range(_ROUNDS):
        _, ahead, beside = _way(arm, at, q[row])
        out[row[beside < _ON]] = True
        going = (beside >= _ON) & (beside < ahead**2)
        if not going.any():
            break
        at, row, parts = some_of(at, going), row[going], some_of(parts, going)
        at.q[:, moving] += ahead[going, None] * at.still
        at, _ = sampled(arm, at, T[parts.owner])
    return out


def _follow(arm: Arm, first: Reduced, T: Array) -> tuple[Parts, Parts, Array]:
    """On from samples to both sides at once, the fastest joint by `policy.try_step` from one to the next;
    the parts to one side, and to the other of what does not come back to where it began; those behind
    which too much is left; the most (k,) that is left before."""
    count, moving = len(T), list(arm.moving)
    back = first._replace(still=-first.still, out=-first.out, left=-first.left)
    first, T = joined(first, back), np.concatenate([T, T])
    closed, worst = np.zeros(2 * count, dtype=bool), np.abs(first.left)
    parts, ends, owner, b = [], [], np.arange(2 * count), first
    astray, before = np.zeros(2 * count, dtype=np.intp), b.still
    for step in range(_MOST):
        ahead, course = b.q.copy(), 1.5 * b.still - 0.5 * before
        ahead[:, moving] += arm.policy.try_step * course / np.abs(course).max(axis=1)[:, None]
        c, near = sampled(arm, b._replace(q=ahead), T[owner])
        astray = np.where(near, 0, astray + 1)
        left = np.abs(c.left)
        on = left < arm.policy.fold_reach
        place = np.where(owner < count, step, _MOST + step).astype(float)
        passed = Parts(b, c, owner, place, np.ones(len(owner)))
        ends.append(some_of(passed, ~on & (left < BEYOND * arm.policy.fold_reach)))
        on &= astray < _ASTRAY
        parts.append(some_of(passed, on))
        b, c, owner, astray = some_of(b, on), some_of(c, on), owner[on], astray[on]
        worst[owner] = np.maximum(worst[owner], np.abs(c.left))
        closed[owner[_back(arm, some_of(first, owner), b) & (step > 1)]] = True
        going = ~(closed[owner] | closed[owner % count])
        before = b.still[going]
        b, owner, astray = some_of(c, going), owner[going], astray[going]
        if not len(owner):
            break
    closed[owner] = True
    once = np.arange(2 * count) < count
    once[count:] = ~closed[:count]
    worst = np.maximum(worst[:count], np.where(once[count:], worst[count:], 0.0))
    found, last = (some_of(some, once[some.owner]) for some in (joined(*parts), joined(*ends)))
    found, last = (some._replace(owner=some.owner % count) for some in (found, last))
    return found, last, worst


def _back(arm: Arm, a: Reduced, b: Reduced) -> Flags:
    """Whether curves are at samples of them again, and not at other parts that are near."""
    way, _, beside = _way(arm, a, b.q)
    near = np.abs(way).max(axis=1) < 0.75 * arm.policy.try_step
    same = (a.still * b.still).sum(axis=1) > _SAME_WAY
    return np.asarray((beside < _BESIDE) & near & same)


def _way(arm: Arm, at: Reduced, q: Array) -> tuple[Array, Array, Array]:
    """The ways (k, n) from samples to rows q (k, dof), how far they go along the still direction (k,), and
    how far beside that at most (k,)."""
    way = differences(arm, at.q, q)[:, list(arm.moving)]
    along = (way * at.still).sum(axis=1)
    return way, along, np.abs(way - along[:, None] * at.still).max(axis=1)
