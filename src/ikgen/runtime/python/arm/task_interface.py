"""What of a pose counts."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ikgen.runtime.python.arm.entry_differences import Entries
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arrays.array_types import Array, Flags

__all__ = ["FARTHEST", "Task", "near_enough"]

FARTHEST = 1e15  # m: where neighbouring doubles are 0.1 m apart; no arm reaches beyond


def near_enough(p: Array) -> Flags:
    """Which of positions (N, k), or parts of them, are within `FARTHEST`, all numbers."""
    with np.errstate(over="ignore"):
        return np.asarray((p * p).sum(axis=1) <= FARTHEST * FARTHEST)


class Task(Protocol):
    """How poses are read and compared: `entries` of them, of which the columns `unit` are unit vectors
    at right angles; positions count over `size` (m); `alone`: "rotation" or "position" where no other
    part of the pose is read, else ""."""

    @property
    def entries(self) -> Entries: ...

    @property
    def unit(self) -> tuple[int, ...]: ...

    @property
    def alone(self) -> str: ...

    @property
    def size(self) -> float: ...

    def read(self, T: list[list[float]], policy: Policy) -> list[list[float]] | None:
        """The pose that nested lists stand for, its rotation the nearest one; None for no pose, and for one
        that is beyond `FARTHEST`."""

    def read_batch(self, T: Array, policy: Policy) -> tuple[Array, Flags]:
        """`read` for T (N, 4, 4), and which of them `read` takes."""

    def error(self, pose: Array, T: Array) -> Array:
        """Differences (k, m) of poses (k, 4, 4) from those asked for, T (k, 4, 4)."""

    def rows(self, pose: Array, J: Array) -> Array:
        """Derivatives (k, m, dof) of what `error` compares by the joints, from the Jacobian."""
