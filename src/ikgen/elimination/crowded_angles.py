"""Angles of a coupled joint near which an elimination's determinant is small whatever the pose.

Where the coupled joint brings two axes beside it into line, or nearly so (a hollow wrist held straight),
the twelve equations lose rank at every pose. The determinant has several roots there that have nothing to
do with solutions, and those that do come near are lost in its rounding, unless it is looked at closely.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ikgen.model.arrays import Array

__all__ = ["crowded_angles"]

_GRID = 256
_IN_LINE = 1e-3  # of the cosine between two axes from +-1
_NEAR = 0.16  # rad beside the angle, where the order is measured, and half as far
_LEAST = 3.0
"""The order from which on roots are lost."""


def crowded_angles(
    cosines: Callable[[Array], Array], determinants: Callable[[Array], Array]
) -> tuple[tuple[float, int], ...]:
    """The angles (rad, multiples of 2 pi / 256) near which `determinants` (N, n) of N poses at angles (n,)
    all have a root of high order, and that order, among those at which one of the `cosines` (m, n) between
    neighbouring axes is the nearest to 1 or -1."""
    grid: Array = 2.0 * np.pi / _GRID * np.arange(_GRID, dtype=float)
    found: dict[float, int] = {}
    for values in cosines(grid):
        size = np.abs(values)
        peaks = (size >= np.roll(size, 1)) & (size > np.roll(size, -1)) & (size > 1.0 - _IN_LINE)
        for angle in grid[peaks]:
            order = _order(determinants, angle)
            if order > _LEAST:
                found[float(angle)] = round(order)
    return tuple(sorted(found.items()))


def _order(determinants: Callable[[Array], Array], angle: float) -> float:
    """The order of the root near an angle."""
    size = np.log2(np.abs(determinants(angle + _NEAR * np.array([1.0, 0.5, -1.0, -0.5]))) + 1e-300)
    return float(np.median([size[:, 0] - size[:, 1], size[:, 2] - size[:, 3]]))
