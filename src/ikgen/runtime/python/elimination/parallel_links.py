"""The three links about two parallel axes of a loop, and which of their measures are nothing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.elimination.loop_equations import of_constants

__all__ = [
    "MEETING",
    "PLAIN",
    "UPRIGHT",
    "ParallelLinks",
    "deviation",
    "links_of",
    "parallel_links",
]

PLAIN, UPRIGHT, MEETING = 0, 1, 2
"""Both; right angles between the axes and no offset; axes that meet."""


class ParallelLinks(NamedTuple):
    """Axes 1 to 4 of which 2 and 3 are parallel along the unit vector n, that of axis 2; arrays (m, 1).

    c1, c3: cosines of the angles from axes 1 and 4 to n. a1, a2, a3: distances along the common normals of
    neighbours, d from the foot of the first to that of the last, along n. h1, h4: where on axes 1 and 4
    these normals have their feet, from their frames' origins. side: 1 or -1, axis 3's direction along n.
    tilt: sine of the angle between both, which counts as none.
    """

    c1: Array
    c3: Array
    a1: Array
    a2: Array
    a3: Array
    d: Array
    h1: Array
    h4: Array
    side: Array
    tilt: Array


def parallel_links(C: Sequence[Array]) -> Array:
    """What `links_of` tells (m, 10) of the links C[0], C[1], C[2] (1 or N, 4, 4) from axis 1 to axis 4 of a
    loop.

    Of axes 2 and 3, and where others are parallel to them, the frames' z axes and origins are as good as
    any.
    """
    return of_constants(_measures, *C[:3])


def links_of(measures: Array) -> ParallelLinks:
    """What the measures (m, 10) are."""
    return ParallelLinks(*measures.T[:, :, None])


def _measures(first: Array, second: Array, third: Array) -> Array:
    nx, ny, nz = first[:, :3, 2].T
    px, py, pz = first[:, :3, 3].T
    s1 = np.hypot(nx, ny) + 1e-150
    foot = -(px * nx + py * ny) / (s1 * s1)  # of the first normal, on axis 2
    side = np.where(second[:, 2, 2] > 0.0, 1.0, -1.0)
    zx, zy, zz = third[:, :3, 2].T
    qx, qy, qz = third[:, :3, 3].T
    s3 = np.hypot(zx, zy) + 1e-150
    h4 = -(qx * zx + qy * zy) / (s3 * s3)
    values = ParallelLinks(
        c1=nz,
        c3=side * zz,
        a1=(nx * py - ny * px) / s1,
        a2=np.hypot(second[:, 0, 3], second[:, 1, 3]),
        a3=side * (zx * qy - zy * qx) / s3,
        d=second[:, 2, 3] + side * (qz + h4 * zz) - foot,
        h1=pz + foot * nz,
        h4=h4,
        side=side,
        tilt=np.hypot(second[:, 0, 2], second[:, 1, 2]),
    )
    return np.stack(np.broadcast_arrays(*values), axis=-1)


def deviation(kind: int, of: ParallelLinks) -> Array:
    """What the kind takes for zero (m, 1) (rad, lengths in the links' unit)."""
    twists, lengths = abs(of.c1) + abs(of.c3) + abs(of.d), abs(of.a1) + abs(of.a3)
    if kind == PLAIN:
        return of.tilt + twists + lengths
    return of.tilt + (twists if kind == UPRIGHT else lengths)
