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
from ikgen.runtime.python.newton.arm_newton import linearized, refined
from ikgen.runtime.python.newton.refinement import least_singular
from ikgen.runtime.python.rows.row_links import differences
from ikgen.runtime.python.rows.solution_rows import places
from ikgen.runtime.python.singular.fold_pair import Reduced, correct, generic, still_directions

__all__ = ["Traced", "rows_around", "trace"]

_MOST, _CORRECTIONS, _STEPS, _DEEP, _LEAST = 96, 6, 40, 24, 4
_CUBICS, _NEWTON, _CLEAR = 2, 4, 1e-6
_LEAP, _SOON = 16.0, 3
_BEYOND = 4.0  # how far what is left behind the last part of a curve may be beyond its bound
_SAMPLES = 600  # of a curve
_ROOM = 32  # solutions of a curve
_NEAR = 1e-8  # rad or m: so far off the curve what is left, whose error is the square, is its
_SHARE = 3e-2  # or, of what is left: as little as that off the curve changes neither
_ALMOST, _SAME = 1e-3, 4e-15  # or how close it must be where what is left is the same after a step
_STRAY = 1.0  # rad or m: larger corrections, of so many samples,
_ASTRAY = 4  # show that no curve is near
_WAY = 1e-10  # rad or m: along it, by which what is left varies by round-off
_ROUND_OFF, _SMALL, _DOUBT, _BESIDE, _SAME_WAY = 1e-15, 4e-15, 0.03, 0.06, 0.9


class Traced(NamedTuple):
    """Which starts (k,) lie on a `curve` of the solved geometry, and which of these are `broken` (k,), none
    of the file's arm; the starts `owner` (n,) of solutions, nearly, `q` (n, dof) on broken ones."""

    curve: Flags
    broken: Flags
    owner: Index
    q: Array


class _Parts(NamedTuple):
    """Parts of curves, between samples `a` and `b` of those of the starts `owner` (n,), `place` (n,) and
    `width` (n,) in the order in which they were passed."""

    a: Reduced
    b: Reduced
    owner: Index
    place: Array
    width: Array


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
    """The curves through rows q (k, dof) towards aims T (k, ...), once around, or to both their ends; of
    equal ones one is followed."""
    asked = np.concatenate([q, T.reshape(len(q), -1)], axis=1)
    _, first, again = np.unique(asked, axis=0, return_index=True, return_inverse=True)
    again = again.reshape(-1)
    curve, broken, owner, rows = _traced(arm, q[first], T[first])
    begin, end = np.searchsorted(owner, again), np.searchsorted(owner, again, side="right")
    whose = np.repeat(np.arange(len(q)), end - begin)
    return Traced(curve[again], broken[again], whose, rows[begin[whose] + places(whose)])


def _traced(arm: Arm, q: Array, T: Array) -> Traced:
    """`trace` of rows that differ."""
    count, (error, slope) = len(q), linearized(arm, q, T)
    nothing, still = np.zeros(count), still_directions(arm, slope)
    unknown = 0.1 * generic(count, error.shape[1])  # shorter than what has a sense
    start = Reduced(q, still, unknown, nothing, nothing)
    first = _sample(arm, start, T)
    parts, ends, worst = _follow(arm, first, T)
    steps = np.bincount(parts.owner, minlength=count)
    curve = steps >= _LEAST
    broken = curve & (worst >= arm.policy.arrived)
    parts = joined(parts, ends)
    found = _look(arm, some_of(parts, broken[parts.owner]), T, steps)
    return Traced(curve, broken, *found)


def _sample(arm: Arm, at: Reduced, T: Array) -> Reduced:
    """The configurations of the curves beside some (k,): of which one direction of the error is left."""
    return _sampled(arm, at, T)[0]


def _sampled(arm: Arm, at: Reduced, T: Array) -> tuple[Reduced, Flags]:
    """`_sample`; and which seem to have a curve near (k,)."""
    at, near = Reduced(*(x.copy() for x in at)), np.ones(len(T), dtype=bool)
    going, before = np.arange(len(T)), np.full(len(T), np.inf)
    for _ in range(_CORRECTIONS):
        moved, farthest = correct(arm, some_of(at, going), T[going])
        for whole, part in zip(at, moved):
            whole[going] = part
        near[going] &= farthest < _STRAY
        same = (np.abs(moved.left - before) < _SAME) & (farthest < _ALMOST)
        on = ~((farthest < np.maximum(_NEAR, _SHARE * np.abs(moved.left))) | same)
        going, before = going[on], moved.left[on]
        if not len(going):
            break
    return at, near


def _follow(arm: Arm, first: Reduced, T: Array) -> tuple[_Parts, _Parts, Array]:
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
        c, near = _sampled(arm, b._replace(q=ahead), T[owner])
        astray = np.where(near, 0, astray + 1)
        left = np.abs(c.left)
        on = left < arm.policy.fold_reach
        place = np.where(owner < count, step, _MOST + step).astype(float)
        passed = _Parts(b, c, owner, place, np.ones(len(owner)))
        ends.append(some_of(passed, ~on & (left < _BEYOND * arm.policy.fold_reach)))
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
    way = differences(arm, a.q, b.q)[:, list(arm.moving)]
    along = (way * a.still).sum(axis=1)[:, None]
    beside = np.abs(way - along * a.still).max(axis=1) < _BESIDE
    near = np.abs(way).max(axis=1) < 0.75 * arm.policy.try_step
    same = (a.still * b.still).sum(axis=1) > _SAME_WAY
    return np.asarray(beside & near & same)


def _between(arm: Arm, parts: _Parts, share: Array, T: Array) -> Reduced:
    """Samples at a `share` (n,) of the way from a to b, near the cubic with the directions at both."""
    a, b, s, moving = parts.a, parts.b, share[:, None], list(arm.moving)
    way = (b.q - a.q)[:, moving]
    length = np.sqrt((way**2).sum(axis=1))[:, None]
    along = ((a.still * b.still).sum(axis=1) > 0.0)[:, None]
    rise, fall = (np.where(along, length * end.still - way, 0.0) for end in (a, b))
    q = a.q + s * (b.q - a.q)
    q[:, moving] += s * (1.0 - s) * ((1.0 - s) * rise - s * fall)
    still = np.where(along, (1.0 - s) * a.still + s * b.still, a.still)
    still /= np.sqrt((still**2).sum(axis=1))[:, None]
    return _sample(arm, a._replace(q=q, still=still), T[parts.owner])


def _look(arm: Arm, parts: _Parts, T: Array, samples: Index) -> tuple[Index, Array]:
    """The solutions (n, dof) inside parts, by the signs of the coefficients, after Bernstein, of cubics
    through values and slopes; whose they are (n,). `samples` (k,): that were taken of each curve. Where a
    sample is far beyond what is left at the end of a curve, there is none."""
    kept, brackets = [_solved(parts, parts.a, 0.0), _solved(parts, parts.b, 1.0)], []
    for deep in range(_DEEP + 1):
        most = np.maximum(np.abs(parts.a.left), np.abs(parts.b.left))
        parts = some_of(parts, ~(most >= _BEYOND * arm.policy.fold_reach))
        values = _bernstein(arm, parts)
        most = np.abs(values).max(axis=0)
        spent = samples[parts.owner] >= _SAMPLES
        end = (most < _SMALL) | spent | (deep == _DEEP)
        doubtful = np.abs(values[1:3]).min(axis=0) < _DOUBT * most
        found = np.abs(values[[0, 3]]) < _SMALL  # ends whose sign is round-off's
        change = values[:-1] * values[1:] <= 0.0
        change[::2] &= ~found
        changes = change.sum(axis=0)
        split = ~end & (doubtful | (changes > 1) | ((changes == 1) & found.any(axis=0)))
        kept.append(some_of(parts, end))
        brackets.append(some_of(parts, ~end & ~split & (changes == 1)))
        if not split.any():
            break
        parts = some_of(parts, split)
        middle = _between(arm, parts, np.full(len(parts.owner), 0.5), T)
        kept.append(_solved(parts, middle, 0.5))
        samples = samples + np.bincount(parts.owner, minlength=len(samples))
        half = 0.5 * parts.width
        parts = joined(
            parts._replace(b=middle, width=half),
            parts._replace(a=middle, place=parts.place + half, width=half),
        )
    return _kept(arm, joined(*kept, _closed_in(arm, joined(*brackets), T)))


def _solved(parts: _Parts, at: Reduced, share: float) -> _Parts:
    """Of samples at a share of the way those at solutions, as parts without length."""
    place = parts.place + share * parts.width
    out: _Parts = some_of(_Parts(at, at, parts.owner, place, 0.0 * place), np.abs(at.left) < _SMALL)
    return out


def _bernstein(arm: Arm, parts: _Parts) -> Array:
    """The coefficients (4, n)."""
    a, b = parts.a, parts.b
    step = (b.q - a.q)[:, list(arm.moving)]
    rise = a.slope * (a.still * step).sum(axis=1)
    fall = b.slope * (b.still * step).sum(axis=1)
    return np.array([a.left, a.left + rise / 3.0, b.left - fall / 3.0, b.left])


def _closed_in(arm: Arm, parts: _Parts, T: Array) -> _Parts:
    """Parts at whose ends what is left has two signs, narrowed until it is round-off at one, or the way
    to there is: first at roots of cubics, where far more than round-off is left, then by false position,
    halving what an end keeps (Dowell & Jarratt 1971). A part in which far more is left than the cubic's
    coefficients bound, or in which that leaps, is of no one curve, and stays as it is then."""
    ends = Reduced(*map(np.stack, zip(parts.a, parts.b)))
    values, last = ends.left.copy(), np.full(len(parts.owner), -1)
    way = np.full(len(parts.owner), np.inf)
    most = 2.0 * np.abs(_bernstein(arm, parts)).max(axis=0)
    for step in range(_STEPS):
        going = np.flatnonzero((np.abs(ends.left).min(axis=0) > _ROUND_OFF) & (way > _WAY))
        if not len(going):
            break
        x, y = values[:, going]
        now = some_of(parts, going)._replace(
            a=some_of(ends, (0, going)), b=some_of(ends, (1, going))
        )
        cubic, share = _bernstein(arm, now), x / (x - y)
        if step < _CUBICS:
            share = np.where(most[going] > _CLEAR, _root_share(cubic, share), share)
        c = _between(arm, now, share, T)
        side = (now.a.left * c.left < 0.0).astype(np.intp)
        way[going] = np.abs(c.q - ends.q[side, going]).max(axis=1)
        change = np.abs(np.diff(cubic, axis=0))
        leaps = change[1] > _LEAP * np.maximum(change[0], change[2])
        leaps &= (np.abs(ends.left[:, going]).min(axis=0) > arm.policy.arrived) & (step > _SOON)
        way[going[leaps | (np.abs(c.left) > most[going])]] = 0.0
        for whole, part in zip(ends, c):
            whole[side, going] = part
        values[side, going] = c.left
        values[1 - side, going] *= np.where(last[going] == side, 0.5, 1.0)
        last[going] = side
    return parts._replace(a=some_of(ends, 0), b=some_of(ends, 1))


def _root_share(values: Array, share: Array) -> Array:
    """Where cubics of coefficients (4, n), after Bernstein, vanish (n,): by Newton's method from a `share`
    (n,), or there where that leads out."""
    a, b, c, d = values
    one, two, three = 3.0 * (b - a), 3.0 * (c - b - b + a), d - a + 3.0 * (b - c)
    x = share
    for _ in range(_NEWTON):
        rise = (3.0 * three * x + 2.0 * two) * x + one
        x = x - (((three * x + two) * x + one) * x + a) / rise
    return np.asarray(np.where((x > 0.0) & (x < 1.0), x, share))


def _kept(arm: Arm, parts: _Parts) -> tuple[Index, Array]:
    """Of each part the end where less is left, in order."""
    ends = Reduced(*map(np.stack, zip(parts.a, parts.b)))
    least = np.abs(ends.left).argmin(axis=0)
    left, q = (x[least, np.arange(len(least))] for x in (ends.left, ends.q))
    order = np.lexsort((parts.place, parts.owner))
    order = order[np.abs(left[order]) < arm.policy.arrived]
    order = order[places(parts.owner[order]) < _ROOM]
    whole = 2.0 * np.pi * np.round(q / (2.0 * np.pi))
    return parts.owner[order], np.where(arm.turning, q - whole, q)[order]
