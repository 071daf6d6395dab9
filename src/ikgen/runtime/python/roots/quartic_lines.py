"""Ferrari's resolvent in its geometric form: the pencil of the quartic's conic and the unit circle holds
a pair of real lines; each meets the circle in two roots. No half-angle tangent, so no point at infinity."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array

__all__ = [
    "ARRAYS",
    "FLOATS",
    "Arithmetic",
    "Coefficients",
    "Line",
    "quartic_ends",
    "quartic_extremum",
    "quartic_lines",
    "quartic_step",
    "quartic_values",
    "quartic_zero",
]

_FLAT = 1e-14  # of what a slope is the sum of: less is round-off, as at a triple root
_Value = TypeVar("_Value", float, Array)
Coefficients = tuple[_Value, _Value, _Value, _Value, _Value]
Line = tuple[_Value, _Value, _Value]


@dataclass(frozen=True)
class Arithmetic(Generic[_Value]):
    """What differs between floats and arrays: `pick(c, a, b)` is a where c holds and else b; `every`:
    whether a condition holds everywhere."""

    sqrt: Callable[[Any], _Value]
    copysign: Callable[[Any, Any], _Value]
    clip: Callable[[Any, float, float], _Value]
    pick: Callable[[Any, Any, Any], _Value]
    every: Callable[[Any], bool]


def _clip(x: float, low: float, high: float) -> float:
    return low if x < low else high if x > high else x


def _pick(condition: bool, a: float, b: float) -> float:
    return a if condition else b


FLOATS: Arithmetic[float] = Arithmetic(math.sqrt, math.copysign, _clip, _pick, bool)
ARRAYS: Arithmetic[Array] = Arithmetic(np.sqrt, np.copysign, np.clip, np.where, np.all)


def quartic_lines(
    k: Coefficients[_Value], rho: _Value, on: Arithmetic[_Value]
) -> tuple[Line[_Value], Line[_Value], _Value, _Value]:
    """Lines (n_x, n_y, d), `n . (cos t, sin t) = d`, that hold all real roots; the square of half
    their distance, below zero for complex ones, and the middle whose square it is to be compared with.

    rho: modulus of the first two coefficients, not far below the others."""
    a2, b2, a1, b1, a0 = k
    first = on.sqrt(0.5 * (1.0 + abs(a2) / rho))
    second = 0.5 * abs(b2) / (rho * first)
    ch = on.pick(a2 >= 0.0, first, second)
    sh = on.copysign(on.pick(a2 >= 0.0, second, first), b2)
    p, q, a = (a1 * ch + b1 * sh) / rho, (b1 * ch - a1 * sh) / rho, a0 / rho
    above, below = _resolvent(a, 0.25 * p * p, 0.25 * q * q, on)
    m, low = 0.5 * (above - below), above <= below
    A, B = on.sqrt(above), on.sqrt(below)
    given, other = on.pick(low, q, p), on.pick(low, p, q)
    u = 0.5 * given / on.pick(low, B, A)
    square = u * u + on.pick(low, a - m, m - a)
    v = on.copysign(on.sqrt(on.clip(square, 0.0, math.inf)), other)
    w, v = on.pick(low, v, u), on.pick(low, u, v)
    h = math.sqrt(0.5)
    A, B, w, v = h * A, h * B, h * w, h * v
    return (
        (A * ch + B * sh, A * sh - B * ch, -w - v),
        (A * ch - B * sh, A * sh + B * ch, -w + v),
        square,
        u,
    )


def _resolvent(a: _Value, pp: _Value, qq: _Value, on: Arithmetic[_Value]) -> tuple[_Value, _Value]:
    """1 + m and 1 - m of the best separated root m in [-1, 1] of
    `g(m) = (a - m) (m^2 - 1) - pp (m - 1) - qq (m + 1)`, pp, qq >= 0: it is >= 0 at -1 and <= 0 at 1. A
    root that is double stands for a double root of the quartic. Newton's method from the end where g is
    convex (or that of -g(-m), where g is concave) all the way to the root never goes beyond it."""
    pick = on.pick

    def g(m: _Value) -> _Value:
        return ((a - m) * m + 1.0 - pp - qq) * m - a + pp - qq

    square = a * a + 3.0 * (1.0 - pp - qq)
    root = on.sqrt(on.clip(square, 0.0, math.inf))
    m1, m2 = (a - root) / 3.0, (a + root) / 3.0
    g1, g2 = g(m1), g(m2)
    left = (square > 0.0) & (abs(m1) <= 1.0) & (g1 <= 0.0)
    right = (square > 0.0) & (abs(m2) <= 1.0) & (g2 >= 0.0)
    turned = pick(left, right & (g2 > -g1), right | (g(on.clip(a / 3.0, -1.0, 1.0)) > 0.0))
    c0, c2 = 2.0 * pick(turned, qq, pp), pick(turned, -a, a) + 3.0
    c1 = 2.0 * (c2 - 2.0) + pp + qq
    flat = _FLAT * (4.0 + abs(a) + pp + qq)
    u = 0.0 * a  # from that end
    for _ in range(60):
        slope = c1 - (2.0 * c2 - 3.0 * u) * u
        step = (((c2 - u) * u - c1) * u + c0) / pick(slope > flat, slope, math.inf)
        done = step <= 4e-16 * u
        u = pick(done, u, on.clip(u + step, 0.0, 2.0))
        if on.every(done):
            break
    return pick(turned, 2.0 - u, u), pick(turned, u, 2.0 - u)


def quartic_values(k: Coefficients[_Value], c: _Value, s: _Value) -> tuple[_Value, _Value, _Value]:
    """The quartic and its first two derivatives at the angle with cosine c and sine s."""
    a2, b2, a1, b1, a0 = k
    c2, s2 = (c - s) * (c + s), 2.0 * s * c
    u, v = a2 * c2 + b2 * s2, a1 * c + b1 * s
    return u + v + a0, 2.0 * (b2 * c2 - a2 * s2) + b1 * c - a1 * s, -4.0 * u - v


def quartic_step(
    k: Coefficients[_Value], c: _Value, s: _Value, order: int, on: Arithmetic[_Value]
) -> tuple[_Value, _Value, _Value]:
    """A Newton step from (c, s) to a zero of the quartic (order 0) or of its derivative (order 1), and its
    size."""
    values = quartic_values(k, c, s)
    top, below = values[order], values[order + 1]
    step = on.clip(-top / on.pick(abs(below) < 1e-200, math.inf, below), -0.1, 0.1)
    c, s = c - step * s, s + step * c
    r = on.sqrt(c * c + s * s)
    return c / r, s / r, abs(step)


def quartic_zero(
    k: Coefficients[_Value], c: _Value, s: _Value, order: int, on: Arithmetic[_Value]
) -> tuple[_Value, _Value]:
    """Up to five steps from (c, s) to a zero of the quartic (order 0) or of its derivative (order 1)."""
    for _ in range(5):
        c, s, step = quartic_step(k, c, s, order, on)
        if on.every(step < 1e-9):
            break
    return c, s


def quartic_extremum(
    k: Coefficients[_Value], c: _Value, s: _Value, on: Arithmetic[_Value]
) -> tuple[_Value, _Value, _Value, _Value]:
    """The extremum (x, y) near (c, s), the curvature there, and the square of half the distance (rad) of
    the roots beside it as its parabola has them, below zero for complex ones; infinite without a
    curvature."""
    x, y = quartic_zero(k, c, s, 1, on)
    value, _, curve = quartic_values(k, x, y)
    flat = abs(curve) < 1e-200
    return x, y, curve, on.pick(flat, math.inf, -2.0 * value / on.pick(flat, 1.0, curve))


def quartic_ends(
    x: _Value, y: _Value, half: _Value, on: Arithmetic[_Value]
) -> tuple[tuple[_Value, _Value], tuple[_Value, _Value]]:
    """The directions to both sides of (x, y) whose tangent from there is `half`."""
    n = on.sqrt(1.0 + half * half)
    return ((x - half * y) / n, (y + half * x) / n), ((x + half * y) / n, (y - half * x) / n)
