"""Real roots of `a2 cos 2t + b2 sin 2t + a1 cos t + b1 sin t + a0 = 0`, for floats and for arrays."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.roots.crowded_roots import crowded_place, in_one_place, roots_around
from ikgen.runtime.python.roots.quartic_lines import (
    ARRAYS,
    FLOATS,
    Coefficients,
    Line,
    quartic_ends,
    quartic_extremum,
    quartic_lines,
    quartic_step,
    quartic_zero,
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
_REAL = (
    1e-6  # square of half the distance of two lines, below zero, where rounding makes them complex
)
_CHORD = 1e-3  # half width from which a line's chord tells its roots well
_TOUCHING = 0.02  # half width below which an extremum tells them
_CONTACT = 0.5  # of a line's half width: how far from its point of contact an extremum may be
_NARROWEST = 0.3  # of a line's half width: the least one of a parabola
_WIDEST = 3.0  # of a line's half width: the largest one of a parabola
_INEXACT = 1e-3  # what a multiple of a line's half width may be off by
_LEAST_HALF = 1e-7  # distance from the extremum below which a root is round-off
_APART = 1e-3  # distance of two roots that are not the same
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
        if r < _TOUCHING:
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
    return (first, second) if square >= -_REAL * (1.0 + middle * middle) else ()


def _near(k: Coefficients[float], c: float, s: float, reach: float) -> _Pair:
    """Steps to a root, undone where they leave `reach`: among three close roots."""
    return _within(k, c, s, reach) or (c, s)


def _within(k: Coefficients[float], c: float, s: float, reach: float) -> _Pair | None:
    """Steps to a root, unless they leave `reach`."""
    u, v = quartic_zero(k, c, s, 0, FLOATS)
    return (u, v) if abs(u - c) + abs(v - s) < reach else None


def _tangent(
    k: Coefficients[float], c: float, s: float, reach: float, tol: float
) -> list[_Pair] | None:
    """The two roots beside the extremum near (c, s); the extremum itself where it misses zero by a
    pair of complex roots with imaginary parts up to tol, else no root; None: no such extremum
    within reach, the half width of the line's chord, or one of two roots that are much closer, or not
    where a parabola has them, as among four."""
    x, y, curve, square = quartic_extremum(k, c, s, FLOATS)
    if abs(x - c) + abs(y - s) > _CONTACT * reach + _INEXACT or square == math.inf:
        return None
    h = math.sqrt(abs(square))
    if h < _NARROWEST * reach - _INEXACT:
        return None
    if square <= 0.0:
        return (
            [(x, y)] if -square <= tol * tol + 1e-14 / abs(curve) else None if reach > 1e-4 else []
        )
    if h > _WIDEST * reach + _INEXACT:
        return None
    ends = quartic_ends(x, y, h, FLOATS)
    if h < _LEAST_HALF:  # the value at the extremum is round-off: Newton steps would be too
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

    Rows whose roots are far apart, or two by two in places far apart, are solved together, the few others
    one by one."""
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
    one, two, square, middle = quartic_lines((a2, b2, a1, b1, a0), rho, ARRAYS)
    x, y, d = (np.stack(pair, axis=1) for pair in zip(one, two))
    r2 = (1.0 - d) * (1.0 + d)
    r = np.sqrt(np.where(r2 > 0.0, r2, np.nan))
    c = np.stack([d * x - r * y, d * x + r * y], axis=2)
    s = np.stack([d * y + r * x, d * y - r * x], axis=2)
    half = np.full(d.shape, math.inf)  # of the distance of two roots, where an extremum tells them
    touching = (np.abs(d) < 1.01) & (r2 < _TOUCHING**2)
    real = touching.all(axis=1) & (square >= -_REAL * (1.0 + middle * middle))
    good &= ((square > _REAL) | real) & ~in_one_place(one, two)
    row, line = np.nonzero(touching & good[:, None])
    if len(row):
        at = x[row, line], y[row, line], d[row, line]
        c[row, line], s[row, line], half[row, line] = _beside_contacts(tuple(k[row].T), *at)
    first = c, s
    columns = tuple(e[:, None, None] for e in k.T)
    for _ in range(4):
        c, s, _ = quartic_step(columns, c, s, 0, ARRAYS)
    left = np.abs(c - first[0]) + np.abs(s - first[1]) >= 0.5 * half[:, :, None]
    pairs = (np.abs(e[:, 0, :, None] - e[:, 1, None]) for e in (c, s))
    good &= ~(left | (sum(pairs) < _APART)).any(axis=(1, 2))
    ends = np.abs(c[:, :, 0] - c[:, :, 1]) + np.abs(s[:, :, 0] - s[:, :, 1])
    good &= ~((ends < np.minimum(half, _APART)) | np.isnan(half)).any(axis=1)
    return c.reshape(-1, 4), s.reshape(-1, 4), good


def _beside_contacts(
    k: Coefficients[Array], x: Array, y: Array, d: Array
) -> tuple[Array, Array, Array]:
    """Cosines and sines (n, 2) of the two roots each beside the extremum near a line's point of contact,
    as its parabola has them, and half their distance (n,): NaN where `_tangent` knows more."""
    side = np.copysign(1.0, d)
    c, s = side * x, side * y
    reach = np.sqrt(np.maximum((1.0 - d) * (1.0 + d), 0.0))
    u, v, _, square = quartic_extremum(k, c, s, ARRAYS)
    half = np.sqrt(np.maximum(square, 0.0))
    near = np.abs(u - c) + np.abs(v - s) <= _CONTACT * reach + _INEXACT
    near &= half >= np.maximum(_NARROWEST * reach - _INEXACT, _LEAST_HALF)
    near &= half <= _WIDEST * reach + _INEXACT
    half = np.where(near, half, np.nan)
    (c0, s0), (c1, s1) = quartic_ends(u, v, half, ARRAYS)
    return np.stack([c0, c1], axis=1), np.stack([s0, s1], axis=1), half


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
