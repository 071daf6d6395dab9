"""The orthonormal vectors nearest to some that are so to a few digits: floats or arrays.

The orthogonal polar factor is the nearest in the Frobenius norm; `V (3 - V'V) / 2` (Bjorck and Bowie
1971) doubles its digits, with the same bits on every machine.
"""

from __future__ import annotations

from math import sqrt
from typing import TypeVar

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["Columns", "columns_defect", "determinant", "most_defect", "nearest_columns"]

_N = TypeVar("_N", float, Array)
_Vector = tuple[_N, _N, _N]
Columns = tuple[_Vector[_N], ...]


def _dot(u: _Vector[_N], v: _Vector[_N]) -> _N:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def columns_defect(columns: Columns[_N]) -> _N:
    """Squared Frobenius norm of `V'V - 1`."""
    total: _N = 0.0 * columns[0][0]
    for i, u in enumerate(columns):
        gap = _dot(u, u) - 1.0
        total = total + gap * gap
        for v in columns[:i]:
            gap = _dot(u, v)
            total = total + 2.0 * gap * gap
    return total


def most_defect(entries: int, off: float) -> float:
    """The largest defect of columns with so many entries, each off by `off`."""
    norm = off * sqrt(entries)
    return (2.0 * norm + norm * norm) ** 2


def determinant(columns: Columns[_N]) -> _N:
    """The determinant of three columns: positive where they are right-handed."""
    u, v, w = columns
    x, y, z = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    return x * w[0] + y * w[1] + z * w[2]


def nearest_columns(columns: Columns[_N]) -> Columns[_N]:
    """The nearest orthonormal columns, to all digits where entries are off by 1e-5 at most."""
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
