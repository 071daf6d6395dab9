"""Tasks that read some entries of the pose."""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, isfinite

import numpy as np

from ikgen.runtime.python.arm.entry_differences import (
    Entries,
    entry_errors,
    entry_rows,
)
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.task_interface import FARTHEST, near_enough
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.arrays.orthonormal_columns import (
    columns_defect,
    determinant,
    most_defect,
    nearest_columns,
)

__all__ = ["EntriesTask"]


@dataclass(frozen=True)
class EntriesTask:
    """The entries of `row` and `column`; positions count over `size` (m).

    `unit`: columns of the rotation that are read, unit vectors at right angles; one that lies `flat` in the
    x-y plane is a heading: it may be shorter than 1, as that of a tilted tool, which nothing reaches.
    """

    size: float
    row: tuple[int, ...]
    column: tuple[int, ...]
    unit: tuple[int, ...]
    flat: bool

    @property
    def alone(self) -> str:
        """Implements `Task`."""
        if 3 not in self.column:
            return "rotation"
        return "position" if set(self.column) == {3} else ""

    def read(self, T: list[list[float]], policy: Policy) -> list[list[float]] | None:
        """Implements `Task`."""
        lines, square = T, 0.0
        for r, c in self.entries:
            x = lines[r][c]
            if c == 3:
                square += x * x
            elif not isfinite(x):
                return None
            elif c not in self.unit and abs(x) > 1.0:
                if abs(x) > 1.0 + policy.pose_tolerance:
                    return None
                lines = [list(line) for line in lines]
                lines[r][c] = copysign(1.0, x)
        if not square <= FARTHEST * FARTHEST:
            return None
        return self._with_unit_columns(lines, policy) if self.unit else lines

    def _with_unit_columns(self, T: list[list[float]], policy: Policy) -> list[list[float]] | None:
        """The pose with the nearest orthonormal columns; None where they are none."""
        height = 2 if self.flat else 3
        R = [(*line, 0.0)[:3] for line in zip(*T[:height])]
        columns = tuple((x, y, z) for x, y, z in (R[j] for j in self.unit))
        defect = columns_defect(columns)
        square = sum(x * x for column in columns for x in column)
        level = self.flat and 1.0 - policy.level <= square <= 1.0
        near = level or defect <= self._most_defect(policy)
        if not near or (len(columns) == 3 and not determinant(columns) > 0.0):
            return T if self.flat and 0.0 < square < 1.0 else None
        if defect <= policy.orthonormal**2:
            return T
        lines = [list(line) for line in T]
        for j, column in zip(self.unit, nearest_columns(columns)):
            for line, x in zip(lines[:height], column):
                line[j] = x
        return lines

    def _most_defect(self, policy: Policy) -> float:
        """What is most wrong with columns that are taken for unit vectors."""
        return most_defect((2 if self.flat else 3) * len(self.unit), policy.pose_tolerance)

    def read_batch(self, T: Array, policy: Policy) -> tuple[Array, Flags]:
        """Implements `Task`."""
        T, good = self._single_entries(T, policy)
        if not self.unit:
            return T, good
        height = 2 if self.flat else 3
        V = np.zeros((3, len(self.unit), len(T)))
        V[:height] = T[:, :height, self.unit].transpose(1, 2, 0)
        columns = tuple((v[0], v[1], v[2]) for v in V.swapaxes(0, 1))
        with np.errstate(all="ignore"):
            defect = columns_defect(columns)
            square = (V * V).sum(axis=(0, 1))
            near = good & (defect <= self._most_defect(policy))
            if self.flat:
                near |= good & (square >= 1.0 - policy.level) & (square <= 1.0)
            if len(columns) == 3:
                near &= determinant(columns) > 0.0
            good &= near | ((square > 0.0) & (square < 1.0)) if self.flat else near
            near &= defect > policy.orthonormal**2
            if near.any():
                R = np.moveaxis(np.array(nearest_columns(columns)), -1, 0).swapaxes(1, 2)
                T = T.copy()
                T[np.ix_(near, range(height), self.unit)] = R[near, :height]
        return T, good

    def _single_entries(self, T: Array, policy: Policy) -> tuple[Array, Flags]:
        """Poses whose entries of no unit column, which are cosines, lie between -1 and 1; and which are
        poses that are not too far."""
        good: Flags = np.asarray(np.isfinite(T[:, self.row, self.column]).all(axis=1))
        good &= near_enough(T[:, [r for r, c in self.entries if c == 3], 3])
        for r, c in zip(self.row, self.column):
            if c == 3 or c in self.unit:
                continue
            beyond = np.abs(T[:, r, c]) > 1.0
            good &= ~beyond | (np.abs(T[:, r, c]) <= 1.0 + policy.pose_tolerance)
            if (good & beyond).any():
                T = T.copy()
                T[:, r, c] = np.clip(T[:, r, c], -1.0, 1.0)
        return T, good

    @property
    def entries(self) -> Entries:
        """Implements `Task`."""
        return tuple(zip(self.row, self.column))

    def error(self, pose: Array, T: Array) -> Array:
        """The entries' differences."""
        return entry_errors(self.entries, self._weight(), pose, T, self._heading())

    def rows(self, pose: Array, J: Array) -> Array:
        """The entries' derivatives."""
        return entry_rows(self.entries, self._weight(), pose, J, self._heading())

    def _heading(self) -> bool:
        return self.flat and bool(self.unit)

    def _weight(self) -> Array:
        return np.array([1.0 / self.size if c == 3 else 1.0 for c in self.column])
