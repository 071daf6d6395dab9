"""What of a pose counts, for many poses at once, which are the last axis of all arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ikgen.runtime.python.arm.entry_differences import Entries, entry_lane_errors, entry_lane_rows
from ikgen.runtime.python.arrays.array_types import Array, Single

__all__ = ["EntriesLanes", "LaneTask", "PoseLanes"]


class LaneTask(Protocol):
    """Differences of poses (m, k) and their derivatives (dof, m, k), of upper rows (3, 4, k) and Jacobians
    (dof, 6, k), which may change."""

    def error(self, pose: Array, T: Array) -> Array: ...

    def rows(self, pose: Array, J: Single) -> Single: ...


@dataclass(frozen=True)
class PoseLanes:
    """Differences of whole poses, in lanes."""

    size: float

    def error(self, pose: Array, T: Array) -> Array:
        """Implements `LaneTask`."""
        error = np.empty((6, pose.shape[2]))
        error[:3] = (T[:3, 3] - pose[:3, 3]) / self.size
        for i, j, k in ((3, 1, 2), (4, 2, 0), (5, 0, 1)):
            x, y, z = pose[j, :3] * T[k, :3] - pose[k, :3] * T[j, :3]
            error[i] = 0.5 * (x + y + z)
        half = np.einsum("ijk,ijk->k", pose[:3, :3], T[:3, :3]) < 1.0
        error[3:, half] += 1.0  # half turns have small sines
        return error

    def rows(self, pose: Array, J: Single) -> Single:
        """Implements `LaneTask`."""
        if self.size != 1.0:
            J[:, :3] /= self.size
        return J


@dataclass(frozen=True)
class EntriesLanes:
    """Differences of the entries that an `EntriesTask` reads, in lanes; `weight` (m,)."""

    entries: Entries
    weight: Array
    flat: bool

    def error(self, pose: Array, T: Array) -> Array:
        """Implements `LaneTask`."""
        return entry_lane_errors(self.entries, self.weight, pose, T, self.flat)

    def rows(self, pose: Array, J: Single) -> Single:
        """Implements `LaneTask`."""
        rows: Single = entry_lane_rows(self.entries, self.weight, pose, J, self.flat)
        return rows
