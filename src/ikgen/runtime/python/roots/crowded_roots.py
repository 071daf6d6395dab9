"""Real roots of a trigonometric quartic that lie together: lines through two do not tell them apart."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from ikgen.runtime.python.roots.quartic_lines import Coefficients, Line

__all__ = ["crowded_place", "in_one_place", "roots_around"]

_TOGETHER = 0.995  # distance of lines whose roots are within 0.1 rad
_SAME_WAY = 0.98  # cosine of the angle between two that have theirs in one place
_AROUND = 0.25  # tangents of half angles
_ROUND_OFF = 1e-13  # of a value, twice: what coefficients are off by what they were made of
_STEPS = 64
_Pair = tuple[float, float]


def crowded_place(lines: Sequence[Line[float]]) -> _Pair | None:
    """A direction near which two lines have all their roots."""
    if len(lines) < 2 or not in_one_place(*lines):
        return None
    (a, b), (c, s) = ((x, y) if d > 0.0 else (-x, -y) for x, y, d in lines)
    size = ((a + c) ** 2 + (b + s) ** 2) ** 0.5
    return (a + c) / size, (b + s) / size


def in_one_place(one: Line[Any], other: Line[Any]) -> Any:
    """Whether two lines, of floats or of arrays, have all their roots near one direction."""
    (a, b, d), (c, s, e) = one, other
    touching = (abs(d) > _TOGETHER) & (abs(d) < 1.01) & (abs(e) > _TOGETHER) & (abs(e) < 1.01)
    cosine = a * c + b * s
    return touching & (abs(cosine) > _SAME_WAY) & (cosine * d * e > 0.0)


def roots_around(k: Coefficients[float], c: float, s: float, tol: float) -> list[_Pair]:
    """The roots (cos t, sin t) near a direction: those of the quartic of tan((t - t0) / 2), between the
    zeros of its derivative. Complex pairs of roots with imaginary parts up to tol count as one."""
    a2, b2, a1, b1, a0 = k
    even, odd = (c - s) * (c + s), 2.0 * s * c
    a2, b2 = a2 * even + b2 * odd, b2 * even - a2 * odd
    a1, b1 = a1 * c + b1 * s, b1 * c - a1 * s
    p = (a2 - a1 + a0, 2.0 * b1 - 4.0 * b2, 2.0 * a0 - 6.0 * a2, 2.0 * b1 + 4.0 * b2, a2 + a1 + a0)
    slope = _derivative(p)
    bends, turns = _derivative(slope), _zeros(slope)
    found = _between(p, turns)
    for x in turns:
        value, bend = _value(p, x), _value(bends, x)
        most = 0.25 * tol**2 * abs(bend) + 0.125 * tol**4 * abs(p[0]) + _ROUND_OFF
        if value * bend >= 0.0 and 2.0 * abs(value) <= most:
            found.append(x)
    pairs = (((1.0 - x * x) / (1.0 + x * x), 2.0 * x / (1.0 + x * x)) for x in sorted(found)[:4])
    return [(c * u - s * v, s * u + c * v) for u, v in pairs]


def _zeros(p: Sequence[float]) -> list[float]:
    """The zeros of a polynomial of falling powers, in order."""
    return _between(p, _zeros(_derivative(p)) if len(p) > 2 else [])


def _between(p: Sequence[float], turns: Sequence[float]) -> list[float]:
    """Its zeros, one at most between two that follow each other of its derivative's, `turns`."""
    ends = [-_AROUND, *turns, _AROUND]
    values = [_value(p, x) for x in ends]
    return [
        _zero(p, low, high) if b > 0.0 else _zero(p, high, low)
        for (low, high), (a, b) in zip(pairwise(ends), pairwise(values))
        if a * b < 0.0
    ]


def _zero(p: Sequence[float], low: float, high: float) -> float:
    """Where it vanishes between places where it is below 0 and above it: by Newton's method, or halving."""
    slope, x = _derivative(p), 0.5 * (low + high)
    for _ in range(_STEPS):
        value, rise = _value(p, x), _value(slope, x)
        low, high = (x, high) if value < 0.0 else (low, x)
        ahead = x - value / rise if rise else low
        if not min(low, high) < ahead < max(low, high):
            ahead = 0.5 * (low + high)
        if ahead == x:
            break
        x = ahead
    return x


def _value(p: Sequence[float], x: float) -> float:
    out = 0.0
    for a in p:
        out = out * x + a
    return out


def _derivative(p: Sequence[float]) -> list[float]:
    return [a * (len(p) - 1 - i) for i, a in enumerate(p[:-1])]
