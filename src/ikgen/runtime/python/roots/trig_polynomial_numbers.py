"""`trig_polynomial_roots` of one pose, in numbers: the same intervals, one after the other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

__all__ = [
    "LEAST",
    "ROUND_OFF",
    "SAME",
    "STEPS",
    "STRIDE",
    "apart",
    "once",
    "trig_polynomial_numbers",
]

ROUND_OFF = 1e-14
STRIDE = 1.5
"""Length of the intervals that are looked at first, in radians of the fastest term."""

LEAST = 3e-5
"""The same: half length of intervals that are not halved any more; three roots that meet are told apart
by no less."""

SAME = 1e-7
"""How far (rad) a root may lie from itself a turn before."""

STEPS = 60
"""Newton steps and halves at most; halves alone end before."""

_Terms = list[tuple[float, float, float]]


def trig_polynomial_numbers(
    terms: Sequence[tuple[float, float, float]],
    a0: float,
    span: tuple[float, float],
    tol: float,
    most: int,
) -> list[float]:
    """Roots in the half-open interval `span`, ascending, `most` at most; `terms` are a, b and the
    harmonic of each.

    A complex pair of roots counts as one, at the extremum, where its imaginary part moves the fastest
    term by `tol` (rad) at most. None where all coefficients are 0, or one is not finite.
    """
    size = max(abs(a0), *(max(abs(a), abs(b)) for a, b, _ in terms))
    if not 0.0 < size < math.inf:
        return []
    scaled = [(a / size, b / size, n) for a, b, n in terms]
    return apart(once(_Polynomial(scaled, a0 / size, tol).roots(*span), *span), most)


def once(roots: list[float], low: float, high: float) -> list[float]:
    """Roots of an interval that is longer than a turn, without those that are there a turn before."""
    if high - low <= 2.0 * math.pi:
        return roots
    before = [t - 2.0 * math.pi for t in roots]
    return [
        t
        for t, at in zip(roots, before)
        if at < low - SAME or all(abs(at - other) > SAME for other in roots)
    ]


def apart(roots: Sequence[float], most: int) -> list[float]:
    """`most` of ascending roots at most: where round-off makes more of some that meet, those farthest from
    others."""
    kept: list[float] = []
    for root in roots:
        kept.append(root)
        if len(kept) > most:
            gaps = [after - before for before, after in itertools.pairwise(kept)]
            del kept[gaps.index(min(gaps)) + 1]
    return kept


class _Polynomial:
    def __init__(self, terms: _Terms, a0: float, tol: float) -> None:
        self.terms, self.a0 = terms, a0
        self.fastest = max(n for _, _, n in terms)
        self.third = sum(math.hypot(a, b) * n**3 for a, b, n in terms)
        second = sum(math.hypot(a, b) * n * n for a, b, n in terms)
        self.touch = 0.5 * (tol / self.fastest) ** 2
        self.slack = self.touch * second + ROUND_OFF

    def values(self, t: float) -> tuple[float, float, float]:
        """The polynomial and its two derivatives."""
        f, slope, bend = self.a0, 0.0, 0.0
        for a, b, n in self.terms:
            c, s = math.cos(n * t), math.sin(n * t)
            u, v = a * c + b * s, n * (b * c - a * s)
            f += u
            slope += v
            bend -= n * n * u
        return f, slope, bend

    def roots(self, low: float, high: float) -> list[float]:
        """The roots from low to high."""
        pieces = max(math.ceil((high - low) * self.fastest / STRIDE), 1)
        step = (high - low) / pieces
        ends = [low + i * step for i in range(pieces)] + [high]
        left = [(ends[i], ends[i + 1]) for i in reversed(range(pieces))]
        found: list[float] = []
        while left:
            low, high = left.pop()
            middle, half = 0.5 * (low + high), 0.5 * (high - low)
            f, slope, bend = map(abs, self.values(middle))
            third = self.third * half
            if f > (slope + (0.5 * bend + third / 6.0) * half) * half + self.slack:
                continue
            one_way = slope > (bend + 0.5 * third) * half
            if one_way or bend > third or half * self.fastest < LEAST:
                found += self._told(low, high, one_way)
            else:
                left += [(middle, high), (low, middle)]
        return found

    def _told(self, low: float, high: float, one_way: bool) -> list[float]:
        """The roots where the polynomial goes one way, or bends one way."""
        (f, slope, _), (g, after, _) = self.values(low), self.values(high)
        if (f >= 0.0) != (g >= 0.0):
            return [self._crossing(low, high, 0)]
        if one_way or (slope >= 0.0) == (after >= 0.0):
            return []
        top = self._crossing(low, high, 1)
        h, _, bend = self.values(top)
        if (h >= 0.0) != (f >= 0.0):
            return [self._crossing(low, top, 0), self._crossing(top, high, 0)]
        return [top] if abs(h) <= self.touch * abs(bend) + ROUND_OFF else []

    def _crossing(self, low: float, high: float, order: int) -> float:
        """Where a derivative changes its sign between low and high: Newton steps, and halves where they
        leave what encloses it."""
        rises = self.values(high)[order] >= 0.0
        t = 0.5 * (low + high)
        for _ in range(STEPS):
            f, slope = self.values(t)[order : order + 2]
            if f == 0.0:
                break
            if (f >= 0.0) == rises:
                high = t
            else:
                low = t
            to = t - f / slope if slope else low
            if not low < to < high:
                to = 0.5 * (low + high)
            before, t = t, to
            if abs(t - before) <= 4e-16 * max(abs(before), 1e-3):
                break
        return t
