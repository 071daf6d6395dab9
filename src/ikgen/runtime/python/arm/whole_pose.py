"""The task of the whole pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.runtime.python.arm.entry_differences import Entries
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.task_interface import FARTHEST, near_enough
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.arrays.orthonormal_columns import (
    columns_defect,
    determinant,
    most_defect,
    nearest_columns,
)

__all__ = ["PoseTask"]

_TURN = np.array(  # of a rotation's entries: sine times axis, and the trace
    [
        [0.0, 0.0, 0.0, 1.0],
        [0.0, 0.0, -0.5, 0.0],
        [0.0, 0.5, 0.0, 0.0],
        [0.0, 0.0, 0.5, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [-0.5, 0.0, 0.0, 0.0],
        [0.0, -0.5, 0.0, 0.0],
        [0.5, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]
)


@dataclass(frozen=True)
class PoseTask:
    """Positions count over `size` (m)."""

    size: float
    unit: tuple[int, ...] = (0, 1, 2)
    alone: str = ""

    @property
    def entries(self) -> Entries:
        """Implements `Task`."""
        return tuple((r, c) for r in range(3) for c in range(4))

    def read(self, T: list[list[float]], policy: Policy) -> list[list[float]] | None:
        """Implements `Task`."""
        *R, p = zip(*T[:3])
        x, y, z = p
        near = x * x + y * y + z * z <= FARTHEST * FARTHEST
        if T[3] != [0.0, 0.0, 0.0, 1.0] or not near:
            return None
        columns = tuple((x, y, z) for x, y, z in R)
        defect = columns_defect(columns)
        if not defect <= most_defect(9, policy.pose_tolerance) or determinant(columns) < 0.0:
            return None
        if defect <= policy.orthonormal**2:
            return T
        return [*map(list, zip(*nearest_columns(columns), p)), T[3]]

    def read_batch(self, T: Array, policy: Policy) -> tuple[Array, Flags]:
        """Implements `Task`."""
        good = np.isfinite(T).all(axis=(1, 2)) & (T[:, 3] == (0.0, 0.0, 0.0, 1.0)).all(axis=1)
        good &= near_enough(T[:, :3, 3])
        columns = tuple((T[:, 0, j], T[:, 1, j], T[:, 2, j]) for j in range(3))
        with np.errstate(all="ignore"):
            defect = columns_defect(columns)
            good &= (defect <= most_defect(9, policy.pose_tolerance)) & (determinant(columns) > 0.0)
            near = good & (defect > policy.orthonormal**2)
            if near.any():
                R = np.moveaxis(np.array(nearest_columns(columns)), -1, 0).swapaxes(1, 2)
                T = T.copy()
                T[near, :3, :3] = R[near]
        return T, good

    def error(self, pose: Array, T: Array) -> Array:
        """Position over the size, then rotation."""
        R = T[:, :3, :3] @ pose[:, :3, :3].transpose(0, 2, 1)
        turn = R.reshape(len(R), 9) @ _TURN
        error = np.empty((len(pose), 6))
        error[:, :3] = (T[:, :3, 3] - pose[:, :3, 3]) / self.size
        error[:, 3:] = turn[:, :3]
        half = turn[:, 3] < 1.0
        if half.any():
            error[half, 3:] += 1.0  # half turns have small sines
        return error

    def rows(self, pose: Array, J: Array) -> Array:
        """The Jacobian in the same units."""
        if self.size == 1.0:
            return J
        return np.asarray(J / np.array([self.size] * 3 + [1.0] * 3)[:, None])
