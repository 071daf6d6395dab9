"""How far a pose is from the asked one, as a task counts it, and the derivatives by the joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ikgen.runtime.python.array_types import Array
from ikgen.runtime.python.chain_kinematics import cross

__all__ = ["EntriesTask", "PoseTask", "Task"]


class Task(Protocol):
    """What of a pose counts."""

    def error(self, pose: Array, T: Array) -> Array:
        """Differences (k, m) of poses (k, 4, 4) from those asked for, T (k, 4, 4)."""

    def rows(self, pose: Array, J: Array) -> Array:
        """Derivatives (k, m, dof) of what `error` compares by the joints, from the Jacobian."""


@dataclass(frozen=True)
class PoseTask:
    """The whole pose; positions count over `size` (m)."""

    size: float

    def error(self, pose: Array, T: Array) -> Array:
        """Position over the size, then rotation."""
        R = T[:, :3, :3] @ pose[:, :3, :3].transpose(0, 2, 1)
        error = np.empty((len(pose), 6))
        error[:, :3] = (T[:, :3, 3] - pose[:, :3, 3]) / self.size
        error[:, 3:] = 0.5 * (R[:, (2, 0, 1), (1, 2, 0)] - R[:, (1, 2, 0), (2, 0, 1)])
        error[np.trace(R, axis1=1, axis2=2) < 1.0, 3:] += 1.0  # half turns have small sines
        return error

    def rows(self, pose: Array, J: Array) -> Array:
        """The Jacobian in the same units."""
        return np.asarray(J / np.array([self.size] * 3 + [1.0] * 3)[:, None])


@dataclass(frozen=True)
class EntriesTask:
    """Some entries of the pose, by `row` and `column`; positions count over `size` (m)."""

    row: tuple[int, ...]
    column: tuple[int, ...]
    size: float

    def error(self, pose: Array, T: Array) -> Array:
        """The entries' differences."""
        return (T[:, self.row, self.column] - pose[:, self.row, self.column]) * self._weight()

    def rows(self, pose: Array, J: Array) -> Array:
        """The entries' derivatives."""
        out = np.empty((len(pose), len(self.row), J.shape[2]))
        for i, (r, c) in enumerate(zip(self.row, self.column)):
            if c == 3:
                out[:, i] = J[:, r]
            else:
                out[:, i] = cross(J[:, 3:].transpose(0, 2, 1), pose[:, None, :3, c])[:, :, r]
        return out * self._weight()[:, None]

    def _weight(self) -> Array:
        return np.array([1.0 / self.size if c == 3 else 1.0 for c in self.column])
