"""Parallel projection of points in space onto a drawing, from a side that shows most of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ikgen.model.arrays import Array

__all__ = ["Camera", "hull", "look_at"]


_ELEVATION = math.radians(22)
_AZIMUTHS = tuple(math.radians(15 * k + 5) for k in range(24))


@dataclass(frozen=True, slots=True)
class Camera:
    """`axes` (3, 3): rows right, up and towards the eye. A drawing of `width` by `height` shows the
    projections, `scale` units a metre, with `centre` (2,) (m) in its middle."""

    axes: Array
    centre: Array
    scale: float
    width: float
    height: float

    def place(self, points: Array) -> Array:
        """Places (..., 2) in the drawing, y downwards, of points (..., 3)."""
        flat = (points @ self.axes[:2].T - self.centre) * self.scale
        return np.asarray(flat * (1.0, -1.0) + (self.width / 2, self.height / 2))

    def depth(self, point: Array) -> float:
        """How near a point (3,) is to the eye (m)."""
        return float(self.axes[2] @ point)


def look_at(points: Array, width: float, height: float, margin: float) -> Camera:
    """The camera for points (n, 3): the azimuth from which their outline is largest."""
    sides = [_axes(azimuth) for azimuth in _AZIMUTHS]
    # rounded: sides that differ by round-off alone are equal, and the first of them is taken
    areas = [round(_area(hull(points @ axes[:2].T)), 9) for axes in sides]
    axes = sides[int(np.argmax(areas))]
    flat = points @ axes[:2].T
    low, high = flat.min(axis=0), flat.max(axis=0)
    span = np.maximum(high - low, 1e-9)
    room = np.array([width - 2 * margin, height - 2 * margin])
    return Camera(axes, (low + high) / 2, float((room / span).min()), width, height)


def _axes(azimuth: float) -> Array:
    c, s = math.cos(azimuth), math.sin(azimuth)
    ce, se = math.cos(_ELEVATION), math.sin(_ELEVATION)
    return np.array([[-s, c, 0.0], [-se * c, -se * s, ce], [ce * c, ce * s, se]])


def hull(points: Array) -> Array:
    """The convex hull (k, 2) of points (n, 2), counter-clockwise (Andrew's monotone chain, 1979)."""
    ordered = sorted(map(tuple, points.tolist()))
    if len(ordered) < 3:
        return np.array(ordered)
    halves = []
    for part in (ordered, ordered[::-1]):
        chain: list[tuple[float, ...]] = []
        for p in part:
            while len(chain) > 1 and _turn(chain[-2], chain[-1], p) <= 0:
                chain.pop()
            chain.append(p)
        halves += chain[:-1]
    return np.array(halves)


def _turn(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _area(polygon: Array) -> float:
    if len(polygon) < 3:
        return 0.0
    x, y = polygon.T
    return float(abs(x @ np.roll(y, 1) - y @ np.roll(x, 1)) / 2)
