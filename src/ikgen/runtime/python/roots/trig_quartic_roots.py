"""Real roots of `a2 cos 2t + b2 sin 2t + a1 cos t + b1 sin t + a0 = 0`, for floats and for arrays."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.roots.crowded_roots import crowded_place, roots_around
from ikgen.runtime.python.roots.quartic_lines import (
    ARRAYS,
    FLOATS,
    Coefficients,
    Line,
    quartic_lines,
    quartic_step,
    quartic_values,
)

__all__ = [
    "trig_quartic",
    "trig_quartic_batch",
    "trig_quartic_branches",
    "trig_quartic_lanes",
    "trig_quartic_wide_branches",
    "trig_quartic_wide_lanes",
]

_LEAST = 1e-8  # second harmonic over the rest, below which there is a line instead of a conic
_CHORD = 1e-3  # half width from which a line's chord tells its roots well
_Pair = tuple[float, float]


def trig_quartic(
    a2: float, b2: float, a1: float, b1: float, a0: float, tol: float = 1e-3, zero: float = 1e-13
) -> tuple[int, list[_Pair]]:
    """Real roots t as (cos t, sin t): how many (0 to 4) and the pairs.

    -1 and none where all coefficients are below `zero` (t is free). Complex pairs of roots with
    imaginary parts up to `tol` rad count as one, at the extremum.
    """
    size = max(abs(a2), abs(b2), abs(a1), abs(b1), abs(a0))
    if not size > zero:
        return -1, []
    k = (a2 / size, b2 / size, a1 / size, b1 / size, a0 / size)
    lines = _lines(k)
    place = crowded_place(lines)
    if place is not None:
        pairs = roots_around(k, *place, tol)
        return len(pairs), pairs
    out: list[_Pair] = []
    for x, y, d in lines:
        if not abs(d) < 1.01:
            continue
        r = math.sqrt(max((1.0 - d) * (1.0 + d), 0.0))
        found = None
        if r < 0.02:
            e = math.copysign(1.0, d)
            found = _tangent(k, e * x, e * y, r, tol)
        if found is None:
            d = min(max(d, -1.0), 1.0)
            found = [
                _near(k, d * x - r * y, d * y + r * x, 0.25 * r + 1e-5),
                _near(k, d * x + r * y, d * y - r * x, 0.25 * r + 1e-5),
            ]
        for c, s in found:
            if all(abs(c - u) + abs(s - v) > 1e-13 for u, v in out):
                out.append((c, s))
    return len(out), out


def _lines(k: Coefficients[float]) -> tuple[Line[float], ...]:
    rho, rest = math.hypot(k[0], k[1]), math.hypot(k[2], k[3])
    if rho < _LEAST * max(rest, abs(k[4])):
        line = (k[2] / rest, k[3] / rest, -k[4] / rest) if 2.0 * rest > abs(k[4]) else None
        return (line,) if line else ()
    first, second, square, middle = quartic_lines(k, rho, FLOATS)
    return (first, second) if square >= -1e-6 * (1.0 + middle * middle) else ()


def _to_zero(k: Coefficients[float], c: float, s: float, order: int) -> _Pair:
    """Up to five steps from (c, s) to a zero of the function (order 0) or of its derivative (order 1)."""
    for _ in range(5):
        c, s, step = quartic_step(k, c, s, order, FLOATS)
        if step < 1e-9:
            break
    return c, s


def _near(k: Coefficients[float], c: float, s: float, reach: float) -> _Pair:
    """`_to_zero` to a root, undone where it leaves `reach`: among three close roots."""
    return _within(k, c, s, reach) or (c, s)


def _within(k: Coefficients[float], c: float, s: float, reach: float) -> _Pair | None:
    """`_to_zero` to a root, unless it leaves `reach`."""
    u, v = _to_zero(k, c, s, 0)
    return (u, v) if abs(u - c) + abs(v - s) < reach else None


def _tangent(
    k: Coefficients[float], c: float, s: float, reach: float, tol: float
) -> list[_Pair] | None:
    """The two roots beside the extremum near (c, s); the extremum itself where it misses zero by a
    pair of complex roots with imaginary parts up to tol, else no root; None: no such extremum
    within reach, the half width of the line's chord, or one of two roots that are much closer, or not
    where a parabola has them, as among four."""
    x, y = _to_zero(k, c, s, 1)
    value, _, curve = quartic_values(k, x, y)
    if abs(x - c) + abs(y - s) > 0.5 * reach + 1e-3 or abs(curve) < 1e-200:
        return None
    r = 2.0 * value / curve
    h = math.sqrt(abs(r))
    if h < 0.3 * reach - 1e-3:
        return None
    if r >= 0.0:
        return [(x, y)] if r <= tol * tol + 1e-14 / abs(curve) else None if reach > 1e-4 else []
    if h > 3.0 * reach + 1e-3:
        return None
    n = math.sqrt(1.0 + h * h)
    ends = (((x - h * y) / n, (y + h * x) / n), ((x + h * y) / n, (y - h * x) / n))
    if h < 1e-7:  # the value at the extremum is round-off: Newton steps would be too
        return list(ends)
    roots = [_within(k, u, v, 0.5 * h) for u, v in ends]
    if h > _CHORD and not all(roots):
        return None
    return [root or end for root, end in zip(roots, ends, strict=True)]


def trig_quartic_batch(
    a2: Array, b2: Array, a1: Array, b1: Array, a0: Array, tol: float = 1e-3, zero: float = 1e-13
) -> tuple[NDArray[np.int64], Array, Array]:
    """`trig_quartic` on arrays (N,): counts (N,), cosines and sines (N, 4), NaN beyond the count.
    Rows that are not finite count as free ones (-1).

    Rows whose roots are far apart are solved together, the few others one by one."""
    K = np.stack(np.broadcast_arrays(a2, b2, a1, b1, a0), axis=-1).astype(float)
    K[~np.isfinite(K).all(axis=1)] = 0.0
    size = np.abs(K).max(axis=1)
    with np.errstate(all="ignore"):
        c, s, good = _regular_roots(K / np.where(size > zero, size, 1.0)[:, None])
    c[size <= zero] = s[size <= zero] = np.nan
    order = np.argsort(np.isnan(c), axis=1, kind="stable")
    c, s = np.take_along_axis(c, order, axis=1), np.take_along_axis(s, order, axis=1)
    count = np.where(size > zero, (~np.isnan(c)).sum(axis=1), -1)
    for i in np.flatnonzero(~good & (size > zero)):
        e2, f2, e1, f1, e0 = K[i].tolist()
        count[i], pairs = trig_quartic(e2, f2, e1, f1, e0, tol, zero)
        c[i] = s[i] = np.nan
        for j, pair in enumerate(pairs):
            c[i, j], s[i, j] = pair
    return count, c, s


def _regular_roots(k: Array) -> tuple[Array, Array, Flags]:
    """Cosines and sines (N, 4), NaN where there is no root, of rows (N, 5); whether they are all, and
    apart (N,)."""
    a2, b2, a1, b1, a0 = k.T
    rho = np.hypot(a2, b2)
    good = rho >= _LEAST * np.maximum(np.hypot(a1, b1), np.abs(a0))
    one, two, square, _ = quartic_lines((a2, b2, a1, b1, a0), rho, ARRAYS)
    x, y, d = (np.stack(pair, axis=1) for pair in zip(one, two))
    r2 = (1.0 - d) * (1.0 + d)
    good &= (square > 1e-6) & ((r2 > 4e-4) | (np.abs(d) > 1.01)).all(axis=1)
    r = np.sqrt(np.where(r2 > 0.0, r2, np.nan))
    c = np.concatenate([d * x - r * y, d * x + r * y], axis=1)[:, (0, 2, 1, 3)]
    s = np.concatenate([d * y + r * x, d * y - r * x], axis=1)[:, (0, 2, 1, 3)]
    columns = (a2[:, None], b2[:, None], a1[:, None], b1[:, None], a0[:, None])
    for _ in range(4):
        c, s, _ = quartic_step(columns, c, s, 0, ARRAYS)
    gap = np.abs(c[:, :, None] - c[:, None]) + np.abs(s[:, :, None] - s[:, None]) + np.eye(4)
    return c, s, good & ~(gap < 1e-3).any(axis=(1, 2))


def trig_quartic_branches(a2: float, b2: float, a1: float, b1: float, a0: float) -> list[_Pair]:
    """The roots as (cosine, sine)."""
    return trig_quartic(a2, b2, a1, b1, a0)[1]


def trig_quartic_wide_branches(
    a2: float, b2: float, a1: float, b1: float, a0: float, tol: float
) -> list[_Pair]:
    """The roots as (cosine, sine), complex pairs with imaginary parts up to `tol` (rad) as one."""
    return trig_quartic(a2, b2, a1, b1, a0, tol)[1]


def trig_quartic_wide_lanes(
    coefficients: tuple[Array | float, ...], axis: int
) -> tuple[Array, Array, Flags]:
    """`trig_quartic_lanes`, of which the last, a number, is the imaginary part of a root at most."""
    tol: float = coefficients[5]  # type: ignore[assignment]
    return trig_quartic_lanes(coefficients[:5], axis, tol)


def trig_quartic_lanes(
    coefficients: tuple[Array | float, ...], axis: int, tol: float = 1e-3
) -> tuple[Array, Array, Flags]:
    """The roots of coefficient arrays along the axis of their level: cosines, sines, which there are."""
    parts = np.broadcast_arrays(*coefficients)
    shape = parts[0].shape
    a2, b2, a1, b1, a0 = (p.reshape(-1) for p in parts)
    count, c, s = trig_quartic_batch(a2, b2, a1, b1, a0, tol)
    found = np.arange(4) < count[:, None]
    lanes = [np.where(found, x, 1.0).T.reshape(4, *shape) for x in (c, s)]
    full = [
        np.concatenate(list(x), axis=axis) for x in (lanes[0], lanes[1], found.T.reshape(4, *shape))
    ]
    return full[0], full[1], full[2].astype(bool)
