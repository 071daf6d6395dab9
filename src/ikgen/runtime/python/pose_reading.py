"""Poses whose rotations are right to some digits only: the nearest one is taken before all else.

The nearest rotation in the Frobenius norm is the orthogonal polar factor; the steps `V (3 - V'V) / 2`
(Bjorck and Bowie 1971) double the digits, the same bits on every machine. A direction or heading is
the case of one column.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, sqrt
from typing import TypeVar

import numpy as np

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.solve_policy import Policy

__all__ = ["PoseReader", "read_pose", "read_poses"]

_N = TypeVar("_N", float, Array)
_Vector = tuple[_N, _N, _N]


@dataclass(frozen=True)
class PoseReader:
    """What a task reads of a pose: `entries` (row, column), or the `whole` of it with its last line.

    `columns` of the rotation are unit vectors at right angles; `flat`: the one column's third entry is 0.
    """

    entries: tuple[tuple[int, int], ...]
    columns: tuple[int, ...]
    whole: bool
    flat: bool

    def admitted(self, tolerance: float) -> float:
        """The largest `_defect` of columns whose entries are off by `tolerance` each."""
        off = tolerance * sqrt((2 if self.flat else 3) * len(self.columns))
        return (2.0 * off + off * off) ** 2


def _dot(u: _Vector[_N], v: _Vector[_N]) -> _N:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def _defect(columns: tuple[_Vector[_N], ...]) -> _N:
    """Squared Frobenius norm of `V'V - 1`."""
    total: _N = 0.0 * columns[0][0]
    for i, u in enumerate(columns):
        gap = _dot(u, u) - 1.0
        total = total + gap * gap
        for v in columns[:i]:
            gap = _dot(u, v)
            total = total + 2.0 * gap * gap
    return total


def _determinant(columns: tuple[_Vector[_N], ...]) -> _N:
    u, v, w = columns
    x, y, z = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    return x * w[0] + y * w[1] + z * w[2]


def _nearest(columns: tuple[_Vector[_N], ...]) -> tuple[_Vector[_N], ...]:
    """The orthonormal columns nearest to such that are off by 1e-5 at most."""
    for _ in range(2):
        new: list[_Vector[_N]] = []
        for v in columns:
            x, y, z = (1.5 * a for a in v)
            for u in columns:
                half = 0.5 * _dot(u, v)
                x, y, z = x - half * u[0], y - half * u[1], z - half * u[2]
            new.append((x, y, z))
        columns = tuple(new)
    return columns


def read_pose(reader: PoseReader, T: list[list[float]], policy: Policy) -> list[list[float]] | None:
    """The pose that T stands for, as nested lists; None where it is none."""
    r, s, t, last = T
    if reader.whole:
        if not -inf < r[3] + s[3] + t[3] < inf or last != [0.0, 0.0, 0.0, 1.0]:
            return None
    elif not all(isfinite(T[i][j]) for i, j in reader.entries):
        return None
    if not reader.columns:
        return T
    columns = tuple((r[j], s[j], 0.0 if reader.flat else t[j]) for j in reader.columns)
    defect = _defect(columns)
    if not defect <= reader.admitted(policy.pose_tolerance):
        return T if reader.flat and 0.0 < _dot(columns[0], columns[0]) < 1.0 else None
    if len(columns) == 3 and not _determinant(columns) > 0.0:
        return None
    if defect <= policy.orthonormal**2:
        return T
    lines = [list(r), list(s), list(t), last]
    for j, column in zip(reader.columns, _nearest(columns)):
        for i in range(2 if reader.flat else 3):
            lines[i][j] = column[i]
    return lines


def read_poses(reader: PoseReader, T: Array, policy: Policy) -> tuple[Array, Flags]:
    """`read_pose` for T (N, 4, 4): the poses, and which there are."""
    rows, places = zip(*reader.entries)
    good: Flags = np.asarray(np.isfinite(T[:, rows, places]).all(axis=1))
    if reader.whole:
        good &= (T[:, 3] == (0.0, 0.0, 0.0, 1.0)).all(axis=1)
    if not reader.columns:
        return T, good
    with np.errstate(all="ignore"):
        columns = _columns(reader, T)
        defect = _defect(columns)
        near = np.asarray(defect <= reader.admitted(policy.pose_tolerance))
        if len(columns) == 3:
            near &= _determinant(columns) > 0.0
        rough = np.flatnonzero(near & (defect > policy.orthonormal**2))
        square = _dot(columns[0], columns[0])
        if reader.flat:
            near |= (square > 0.0) & (square < 1.0)
    if len(rough):
        T = T.copy()
        for j, column in zip(reader.columns, _nearest(_columns(reader, T[rough]))):
            for i in range(2 if reader.flat else 3):
                T[rough, i, j] = column[i]
    return T, np.asarray(good & near)


def _columns(reader: PoseReader, T: Array) -> tuple[_Vector[Array], ...]:
    third = 0.0 if reader.flat else 1.0
    return tuple((T[:, 0, j], T[:, 1, j], third * T[:, 2, j]) for j in reader.columns)
