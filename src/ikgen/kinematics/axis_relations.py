"""Which axes of a chain keep parallel or keep meeting while every joint moves, neighbours or not.

A relation that holds at random configurations holds between the axes whatever the joints between them
do, those included that are held: a wrist stays spherical about a held joint whose axis goes through its
centre. `classify` tells the relations of neighbours from the rows alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.forward import row_values
from ikgen.kinematics.rigid import dh_link, z_motion
from ikgen.model.arrays import Array
from ikgen.model.chain import PRISMATIC
from ikgen.model.dh import DHChain

__all__ = ["AxisRelations", "axis_relations", "reach"]

_SAMPLES = 6
_SAME = 1e-9


@dataclass(frozen=True, slots=True)
class AxisRelations:
    """Relations of rows by index (from 0), the smaller first; `concurrent` are triples of revolute rows
    that go through one point, no two of them parallel in the order of the triple."""

    parallel: frozenset[tuple[int, int]]
    meeting: frozenset[tuple[int, int]]
    concurrent: frozenset[tuple[int, int, int]]


def reach(dh: DHChain) -> float:
    """A length (m) to measure others of the chain by: its link lengths and offsets added up, or where they
    are shorter the way from the last axis' origin to the tip, or the longest travel of a slide, 1 m at
    most; at least 1e-9."""
    links = sum(abs(x.nominal) for row in dh.rows for x in (row.a, row.d))
    travels = [j.limits.upper - j.limits.lower for j in dh.joints if j.kind == PRISMATIC]
    tool = float(np.linalg.norm(dh.X_tip[:3, 3]))
    return max(links, tool, *(min(x, 1.0) for x in travels), 1e-9)


def axis_relations(dh: DHChain) -> AxisRelations:
    """The relations of the exact rows' axes, rounded constants counting as what was meant."""
    z, origin = _lines(dh)
    small = _SAME * max(reach(dh), float(np.abs(origin).max()))
    parallel, meeting = set(), set()
    for i, j in combinations(range(len(dh.rows)), 2):
        normal = np.cross(z[:, i], z[:, j])
        if np.abs(normal).max() < _SAME:
            parallel.add((i, j))
        elif np.abs(np.sum(normal * (origin[:, j] - origin[:, i]), axis=-1)).max() < small:
            meeting.add((i, j))
    turning = [i for i, row in enumerate(dh.rows) if row.revolute]
    concurrent = {
        (i, j, k)
        for i, j, k in combinations(turning, 3)
        if {(i, j), (j, k)} <= meeting and _through_one_point(z, origin, (i, j, k), small)
    }
    return AxisRelations(frozenset(parallel), frozenset(meeting), frozenset(concurrent))


def _lines(dh: DHChain) -> tuple[Array, Array]:
    """Direction and a point of each row's axis (samples, n, 3), at random configurations."""
    values = row_values(dh, np.random.default_rng(0).uniform(-1.5, 1.5, (_SAMPLES, dh.dof)))
    T: Array = np.eye(4)
    directions, points = [], []
    for i, row in enumerate(dh.rows):
        T = product(T, dh_link(row.alpha.nominal, row.a.nominal, row.theta.nominal, row.d.nominal))
        T = product(T, z_motion(row.revolute, values[..., i]))
        directions.append(T[..., :3, 2])
        points.append(T[..., :3, 3])
    return np.stack(directions, axis=1), np.stack(points, axis=1)


def _through_one_point(z: Array, origin: Array, axes: tuple[int, int, int], small: float) -> bool:
    """Whether the point nearest to three lines is on all of them, at every sample."""
    columns = list(axes)
    across = np.eye(3) - z[:, columns, :, None] * z[:, columns, None, :]
    moments = np.einsum("snij,snj->sni", across, origin[:, columns])
    centre = np.linalg.solve(across.sum(axis=1), moments.sum(axis=1)[..., None])[..., 0]
    off = np.einsum("snij,snj->sni", across, centre[:, None] - origin[:, columns])
    return bool(np.abs(off).max() < small)
