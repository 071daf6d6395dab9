"""Solutions on parts of curves, between two samples each, by what is left of the error there and how that
grows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.angles import within_periods
from ikgen.runtime.python.arrays.array_tuples import joined, some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.rows.row_links import differences
from ikgen.runtime.python.rows.solution_rows import places
from ikgen.runtime.python.singular.curve_samples import SOLVED, sampled, samples_beside
from ikgen.runtime.python.singular.fold_pair import Reduced

__all__ = ["BEYOND", "Parts", "between", "look", "look_between"]

BEYOND = 4.0
"""How far what is left behind the last part of a curve may be beyond its bound."""

_STEPS, _DEEP = 40, 24  # of false position, and how often a part is halved
_DOUBTS = 3  # how often a part is cut as its cubic bends
_BENT = 1.5  # over its bend: a cubic that is lower in the middle of a part may have two roots there
_STRAIGHT = 0.03  # over its largest value: a cubic that bends by less is straight
_CUBICS, _NEWTON = 2, 4  # first steps that go to roots of cubics, and Newton's steps to these
_CLEAR = 1e-6  # rad, or m over the arm's size, that is left in a part: with less, cubics are of round-off
_SOON = 6  # steps in which the product of what is left at both ends has to halve
_PARTS = 4  # in which one is looked at whose ends alone tell little
_SAMPLES = 600  # of a curve
_ROOM = 32  # solutions of a curve
_WAY = 1e-10  # rad or m: along it, by which what is left varies by round-off
_ROUND_OFF = 1e-15


class Parts(NamedTuple):
    """Parts of curves, between samples `a` and `b` of those of the starts `owner` (n,), `place` (n,) and
    `width` (n,) in the order in which they were passed."""

    a: Reduced
    b: Reduced
    owner: Index
    place: Array
    width: Array


def look(arm: Arm, parts: Parts, T: Array, samples: Index) -> tuple[Index, Array]:
    """The solutions (n, dof) inside parts, by the signs of the coefficients, after Bernstein, of cubics
    through values and slopes; whose they are (n,). `samples` (k,): that were taken of each curve. Where a
    sample is far beyond what is left at the end of a curve, there is none."""
    kept, brackets = [_solved(parts, parts.a, 0.0), _solved(parts, parts.b, 1.0)], []
    for deep in range(_DEEP + 1):
        most = np.maximum(np.abs(parts.a.left), np.abs(parts.b.left))
        parts = some_of(parts, ~(most >= BEYOND * arm.policy.fold_reach))
        values = _bernstein(arm, parts)
        most = np.abs(values).max(axis=0)
        spent = samples[parts.owner] >= _SAMPLES
        end = (most < SOLVED) | spent | (deep == _DEEP)
        found = np.abs(values[[0, 3]]) < SOLVED  # ends whose sign is round-off's
        change = values[:-1] * values[1:] <= 0.0
        change[::2] &= ~found
        changes = change.sum(axis=0)
        doubtful = (deep < _DOUBTS) & _bends(values, changes)
        split = ~end & (doubtful | (changes > 1) | ((changes == 1) & found.any(axis=0)))
        kept.append(some_of(parts, end))
        brackets.append(some_of(parts, ~end & ~split & (changes == 1)))
        if not split.any():
            break
        parts = some_of(parts, split)
        middle = between(arm, parts, np.full(len(parts.owner), 0.5), T)
        kept.append(_solved(parts, middle, 0.5))
        samples = samples + np.bincount(parts.owner, minlength=len(samples))
        half = 0.5 * parts.width
        parts = joined(
            parts._replace(b=middle, width=half),
            parts._replace(a=middle, place=parts.place + half, width=half),
        )
    return _kept(arm, joined(*kept, _closed_in(arm, joined(*brackets), T)))


def look_between(
    arm: Arm, q: Array, to: Array, T: Array, count: int = _PARTS
) -> tuple[Index, Array]:
    """The solutions (n, dof) on curves from rows q (k, dof) to others (k, dof), towards aims T (k, ...),
    whatever cubics through both tell, in so many parts; whose they are (n,)."""
    with np.errstate(all="ignore"):
        way, a, parts = differences(arm, q, to), samples_beside(arm, q, T), []
        for part in range(count):
            b = sampled(arm, a._replace(q=q + (part + 1) / count * way), T)[0]
            width = np.ones(len(q))
            parts.append(Parts(a, b, np.arange(len(q)), part * width, width))
            a = b
        return look(arm, joined(*parts), T, np.full(len(q), count))


def between(arm: Arm, parts: Parts, share: Array, T: Array) -> Reduced:
    """Samples at a `share` (n,) of the way from a to b, near the cubic with the directions at both."""
    a, b, s, moving = parts.a, parts.b, share[:, None], list(arm.moving)
    way = (b.q - a.q)[:, moving]
    rise, fall = ((way * end.still).sum(axis=1)[:, None] * end.still - way for end in (a, b))
    along = ((a.still * b.still).sum(axis=1) > 0.0)[:, None]
    q = a.q + s * (b.q - a.q)
    q[:, moving] += s * (1.0 - s) * ((1.0 - s) * rise - s * fall)
    still = np.where(along, (1.0 - s) * a.still + s * b.still, a.still)
    still /= np.sqrt((still**2).sum(axis=1))[:, None]
    return sampled(arm, a._replace(q=q, still=still), T[parts.owner])[0]


def _bends(values: Array, changes: Index) -> Flags:
    """Which cubics of coefficients (4, n), with so many changes of sign (n,), bend so much that they tell
    little of zeros beside these, where they come near 0 or turn twice: those that only rise or fall on one
    side of 0 have none."""
    rise = np.diff(values, axis=0)
    turns = rise[:-1] * rise[1:]
    steady = (changes == 0) & (turns >= 0.0).all(axis=0)
    bend = np.abs(np.diff(rise, axis=0)).max(axis=0)
    bent = (np.abs(values[1] + values[2]) < _BENT * bend) & ~steady
    bent |= (turns < 0.0).all(axis=0)
    return np.asarray(bent & (bend > _STRAIGHT * np.abs(values).max(axis=0)))


def _solved(parts: Parts, at: Reduced, share: float) -> Parts:
    """The samples at a share of the way that are at solutions, as parts without length."""
    place = parts.place + share * parts.width
    out: Parts = some_of(Parts(at, at, parts.owner, place, 0.0 * place), np.abs(at.left) < SOLVED)
    return out


def _bernstein(arm: Arm, parts: Parts) -> Array:
    """The coefficients (4, n)."""
    a, b = parts.a, parts.b
    step = (b.q - a.q)[:, list(arm.moving)]
    rise = a.slope * (a.still * step).sum(axis=1)
    fall = b.slope * (b.still * step).sum(axis=1)
    return np.array([a.left, a.left + rise / 3.0, b.left - fall / 3.0, b.left])


def _closed_in(arm: Arm, parts: Parts, T: Array) -> Parts:
    """Parts at whose ends what is left has two signs, narrowed until it is round-off at one, or the way
    to there is: first at roots of cubics, where far more than round-off is left, then by false position,
    halving what an end keeps (Dowell & Jarratt 1971). A part in which far more is left than the cubic's
    coefficients bound, or the product at whose ends hardly falls, is of no one curve, and stays as it is
    then."""
    ends = Reduced(*map(np.stack, zip(parts.a, parts.b)))
    values, last = ends.left.copy(), np.full(len(parts.owner), -1)
    way, goal = np.full((2, len(parts.owner)), np.inf)
    most = 2.0 * np.abs(_bernstein(arm, parts)).max(axis=0)
    for step in range(_STEPS):
        if step % _SOON == 0:
            product = np.abs(ends.left[0] * ends.left[1])
            way[product > goal] = 0.0
            goal = 0.5 * product
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
        c = between(arm, now, share, T)
        side = (now.a.left * c.left < 0.0).astype(np.intp)
        way[going] = np.abs(c.q - ends.q[side, going]).max(axis=1)
        way[going[np.abs(c.left) > most[going]]] = 0.0
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


def _kept(arm: Arm, parts: Parts) -> tuple[Index, Array]:
    """The end of each part where less is left, in order."""
    ends = Reduced(*map(np.stack, zip(parts.a, parts.b)))
    least = np.abs(ends.left).argmin(axis=0)
    left, q = (x[least, np.arange(len(least))] for x in (ends.left, ends.q))
    order = np.lexsort((parts.place, parts.owner))
    order = order[np.abs(left[order]) < arm.policy.arrived]
    order = order[places(parts.owner[order]) < _ROOM]
    return parts.owner[order], within_periods(q, arm.placing)[order]
