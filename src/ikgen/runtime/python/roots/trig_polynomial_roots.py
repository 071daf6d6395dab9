"""Real roots of a trigonometric polynomial of any degree in an interval, all of them.

`a0 + sum(a_i cos(n_i t) + b_i sin(n_i t)) = 0`. Intervals are halved until Taylor's expansion about the
middle, with a bound on the third derivative, shows that the polynomial has no root in one, or goes one way
there, or bends one way: then signs tell its roots. (R. E. Moore, Interval Analysis, 1966.)
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.roots.trig_polynomial_numbers import (
    LEAST,
    ROUND_OFF,
    SAME,
    STEPS,
    STRIDE,
    apart,
    once,
    trig_polynomial_numbers,
)

__all__ = ["trig_polynomial_branches", "trig_polynomial_lanes", "trig_polynomial_roots"]

_Pair = tuple[float, float]


@dataclass(frozen=True)
class _Sums:
    """Polynomials, one a row: coefficients `a` and `b` (N, m) of the terms with harmonics `n` (m,), `a0`
    (N,), and the bounds `most` (4, N) of the derivatives."""

    n: Array
    a: Array
    b: Array
    a0: Array
    most: Array

    def values(self, rows: Index, t: Array, least: int = 0, count: int = 1) -> list[Array]:
        """Derivatives `least` and up, `count` of them, of the polynomials of these rows at t."""
        phase = t[:, None] * self.n
        c, s = np.cos(phase), np.sin(phase)
        a, b = self.a[rows], self.b[rows]
        out = []
        for order in range(least, least + count):
            # a derivative turns by a right angle and multiplies by n
            u, v = ((c, s), (-s, c), (-c, -s), (s, -c))[order % 4]
            value = ((a * u + b * v) * self.n**order).sum(axis=1)
            out.append(value + self.a0[rows] if order == 0 else value)
        return out


def trig_polynomial_roots(
    harmonics: Array, a: Array, b: Array, a0: Array, span: _Pair, tol: float, most: int
) -> Array:
    """Roots (N, most) in the half-open interval `span`, ascending, NaN beyond the last.

    `harmonics` (m,) whole and positive, `a` and `b` (N, m), `a0` (N,). A complex pair of roots counts as
    one, at the extremum, where its imaginary part moves the fastest term by `tol` (rad) at most. Rows
    that are 0 or not finite have none.
    """
    size = np.maximum(np.abs(np.concatenate([a, b], axis=1)).max(axis=1), np.abs(a0))
    usable = np.isfinite(size) & (size > 0.0)
    size = np.where(usable, size, 1.0)[:, None]
    a, b, a0 = (np.where(usable[:, None], x / size, 0.0) for x in (a, b, a0[:, None]))
    bounds = np.stack([(np.hypot(a, b) * harmonics**k).sum(axis=1) for k in range(4)])
    sums = _Sums(harmonics, a, b, a0[:, 0], bounds)
    touch = 0.5 * (tol / float(harmonics.max())) ** 2
    rows, low, high, touching = _simple_intervals(sums, np.flatnonzero(usable), span, touch)
    found = _crossings(sums, rows, low, high)
    rows, roots = np.concatenate([rows, touching[0]]), np.concatenate([found, touching[1]])
    order = np.lexsort((roots, rows))
    rows, roots = rows[order], roots[order]
    place = np.arange(len(rows)) - np.searchsorted(rows, rows)
    out = np.full((len(a), most), np.nan)
    out[rows[place < most], place[place < most]] = roots[place < most]
    around = rows[
        roots >= span[0] + 2.0 * math.pi - SAME
    ]  # of an interval that is longer than a turn
    for row in np.unique(np.concatenate([rows[place >= most], around])):
        kept = apart(once(roots[rows == row].tolist(), *span), most)
        out[row] = kept + [math.nan] * (most - len(kept))
    return out


def _simple_intervals(
    sums: _Sums, usable: Index, span: _Pair, touch: float
) -> tuple[Index, Array, Array, tuple[Index, Array]]:
    """Rows and ends of intervals with one root each, between values of unlike signs; and rows and roots
    that are extrema."""
    fastest = float(sums.n.max())
    pieces = max(math.ceil((span[1] - span[0]) * fastest / STRIDE), 1)
    ends = np.linspace(*span, pieces + 1)
    rows = np.repeat(usable, pieces)
    low, high = np.tile(ends[:-1], len(usable)), np.tile(ends[1:], len(usable))
    crossing: list[tuple[Index, Array, Array]] = [(rows[:0], low[:0], high[:0])]
    touching: list[tuple[Index, Array]] = [(rows[:0], low[:0])]
    while rows.size:
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        f, slope, bend = sums.values(rows, middle, count=3)
        third = sums.most[3, rows] * half
        reach = (np.abs(slope) + (0.5 * np.abs(bend) + third / 6.0) * half) * half
        some = np.abs(f) <= reach + touch * sums.most[2, rows] + ROUND_OFF
        one_way = np.abs(slope) > (np.abs(bend) + 0.5 * third) * half
        bent = (np.abs(bend) > third) | (half * fastest < LEAST)
        simple = some & (one_way | bent)
        last = rows[simple], low[simple], high[simple]
        crosses, extrema = _told(sums, *last, one_way[simple], touch)
        crossing += crosses
        touching.append(extrema)
        left = some & ~simple
        rows, low, high, middle = rows[left], low[left], high[left], middle[left]
        rows, low, high = (
            np.concatenate(pair) for pair in ((rows, rows), (low, middle), (middle, high))
        )
    rows, low, high = (np.concatenate(parts) for parts in zip(*crossing, strict=True))
    met = (np.concatenate(parts) for parts in zip(*touching, strict=True))
    return rows, low, high, (next(met), next(met))


def _told(
    sums: _Sums, rows: Index, low: Array, high: Array, one_way: Flags, touch: float
) -> tuple[list[tuple[Index, Array, Array]], tuple[Index, Array]]:
    """Parts of intervals on which the polynomial goes one way, or bends one way, at whose ends it has
    unlike signs; and extrema inside that touch zero."""
    before, after = (sums.values(rows, x)[0] >= 0.0 for x in (low, high))
    unlike = before != after
    crosses = [(rows[unlike], low[unlike], high[unlike])]
    slopes = [sums.values(rows, x, 1)[0] >= 0.0 for x in (low, high)]
    turns = ~one_way & ~unlike & (slopes[0] != slopes[1])
    rows, low, high, before = rows[turns], low[turns], high[turns], before[turns]
    top = _crossings(sums, rows, low, high, order=1)
    f, bend = sums.values(rows, top)[0], sums.values(rows, top, 2)[0]
    twice = (f >= 0.0) != before
    crosses += [(rows[twice], low[twice], top[twice]), (rows[twice], top[twice], high[twice])]
    near = ~twice & (np.abs(f) <= touch * np.abs(bend) + ROUND_OFF)
    return crosses, (rows[near], top[near])


def _crossings(sums: _Sums, rows: Index, low: Array, high: Array, order: int = 0) -> Array:
    """Where a derivative changes its sign between low and high: Newton steps, and halves where they leave
    what encloses it."""
    low, high = low.copy(), high.copy()
    rises = sums.values(rows, high, order)[0] >= 0.0
    t = 0.5 * (low + high)
    going = np.arange(len(rows))
    for _ in range(STEPS):
        if not going.size:
            break
        at = t[going]
        f, slope = sums.values(rows[going], at, order, 2)
        above = (f >= 0.0) == rises[going]
        high[going] = np.where(above, at, high[going])
        low[going] = np.where(above, low[going], at)
        with np.errstate(all="ignore"):
            to = at - f / slope
        inside = (to > low[going]) & (to < high[going])
        to = np.where(inside, to, 0.5 * (low[going] + high[going]))
        t[going] = np.where(f == 0.0, at, to)
        going = going[np.abs(t[going] - at) > 4e-16 * np.maximum(np.abs(at), 1e-3)]
    return t


def trig_polynomial_branches(*arguments: float) -> list[_Pair]:
    """The roots as (cosine, sine) for the arguments of `trig_polynomial_lanes` as numbers."""
    terms = (len(arguments) - 5) // 3
    numbers = arguments[2 * terms + 1 :]
    low, high, tol, most = numbers[terms:]
    each = zip(arguments[: 2 * terms : 2], arguments[1 : 2 * terms : 2], numbers, strict=False)
    span = low, high
    roots = trig_polynomial_numbers(list(each), arguments[2 * terms], span, tol, int(most))
    return [(math.cos(t), math.sin(t)) for t in roots]


def trig_polynomial_lanes(
    arguments: tuple[Array | float, ...], axis: int
) -> tuple[Array, Array, Flags]:
    """The roots of coefficient arrays along the axis of their level: cosines, sines, which there are.

    Arguments: a and b of each term, a0; then numbers: the harmonic of each term, the ends of the interval,
    the largest imaginary part of roots that count, and how many roots there are at most.
    """
    terms = (len(arguments) - 5) // 3
    parts = np.broadcast_arrays(*arguments[: 2 * terms + 1])
    shape = parts[0].shape
    coefficients = np.stack([p.reshape(-1) for p in parts], axis=1).astype(float)
    numbers = [float(x) for x in arguments[2 * terms + 1 :]]
    harmonics, (low, high, tol, most) = np.array(numbers[:terms]), numbers[terms:]
    a, b, a0 = (
        coefficients[:, : 2 * terms : 2],
        coefficients[:, 1 : 2 * terms : 2],
        coefficients[:, -1],
    )
    t = trig_polynomial_roots(harmonics, a, b, a0, (low, high), tol, int(most))
    found = ~np.isnan(t)
    t = np.where(found, t, 0.0)
    lanes = [x.T.reshape(int(most), *shape) for x in (np.cos(t), np.sin(t), found)]
    c, s, which = (np.concatenate(list(x), axis=axis) if shape else x for x in lanes)
    return c, s, which.astype(bool)
