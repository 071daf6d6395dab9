"""The three links about two parallel axes of a loop, and which of their measures are nothing."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot

from ikgen.runtime.python.array_types import Array

__all__ = ["MEETING", "PLAIN", "UPRIGHT", "ParallelLinks", "deviation", "parallel_links"]

PLAIN, UPRIGHT, MEETING = 0, 1, 2
"""Both; right angles between the axes and no offset; axes that meet."""


@dataclass(frozen=True)
class ParallelLinks:
    """Axes 1 to 4 of which 2 and 3 are parallel along the unit vector n, that of axis 2.

    c1, c3: cosines of the angles from axes 1 and 4 to n. a1, a2, a3: distances along the common normals of
    neighbours, d from the foot of the first to that of the last, along n. h1, h4: where on axes 1 and 4
    these normals have their feet, from their frames' origins. side: 1 or -1, axis 3's direction along n.
    tilt: sine of the angle between both, which counts as none.
    """

    c1: float
    c3: float
    a1: float
    a2: float
    a3: float
    d: float
    h1: float
    h4: float
    side: float
    tilt: float


def parallel_links(C: list[Array]) -> ParallelLinks:
    """The links C[0], C[1], C[2] (1, 4, 4) from axis 1 to axis 4 of a loop (`loop_constants`).

    Of axes 2 and 3, and where others are parallel to them, the frames' z axes and origins are as good as
    any.
    """
    first, second, third = (C[i][0].tolist() for i in range(3))
    nx, ny, nz = (row[2] for row in first[:3])
    px, py, pz = (row[3] for row in first[:3])
    s1 = hypot(nx, ny) + 1e-150
    foot = -(px * nx + py * ny) / (s1 * s1)  # of the first normal, on axis 2
    side = 1.0 if second[2][2] > 0.0 else -1.0
    zx, zy, zz = (row[2] for row in third[:3])
    qx, qy, qz = (row[3] for row in third[:3])
    s3 = hypot(zx, zy) + 1e-150
    h4 = -(qx * zx + qy * zy) / (s3 * s3)
    return ParallelLinks(
        c1=nz,
        c3=side * zz,
        a1=(nx * py - ny * px) / s1,
        a2=hypot(second[0][3], second[1][3]),
        a3=side * (zx * qy - zy * qx) / s3,
        d=second[2][3] + side * (qz + h4 * zz) - foot,
        h1=pz + foot * nz,
        h4=h4,
        side=side,
        tilt=hypot(second[0][2], second[1][2]),
    )


def deviation(kind: int, of: ParallelLinks) -> float:
    """What the kind takes for zero (rad, lengths in the links' unit)."""
    twists, lengths = abs(of.c1) + abs(of.c3) + abs(of.d), abs(of.a1) + abs(of.a3)
    if kind == PLAIN:
        return of.tilt + twists + lengths
    return of.tilt + (twists if kind == UPRIGHT else lengths)
