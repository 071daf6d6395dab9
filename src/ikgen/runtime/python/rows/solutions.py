"""What a solve gives back."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array, Flags

__all__ = ["Solutions", "Status", "no_held_values", "no_solutions"]


class Status(str, Enum):
    """How a solve ended; equal to its name as text, of which `solve_batch` gives arrays."""

    OK = "OK"
    UNREACHABLE = "UNREACHABLE"
    LIMITS = "LIMITS"
    INVALID = "INVALID"
    SINGULAR = "SINGULAR"  # of a path alone
    __str__ = str.__str__  # NumPy compares by it


@dataclass(frozen=True, eq=False)
class Solutions:
    """Solutions of one pose: `q` (k, DOF), `status`, and `singular` (k,): rows of a continuum; `reason`
    says why a pose is INVALID, or which values of held joints led to no row. As a sequence: its rows.
    `branch` tells them apart in words; `off` is by how much they miss the pose with `project`."""

    q: Array
    status: Status
    singular: Flags
    reason: str = ""
    names: Callable[[Array], tuple[str, ...]] | None = None
    projected: Array | None = None

    @property
    def branch(self) -> tuple[str, ...]:
        """What distinguishes each row: sides of shoulder, elbow and wrist where the arm has those."""
        return () if self.names is None else self.names(self.q)

    @property
    def off(self) -> Array:
        """How far each row's pose is from the one asked for, (k, 2): m, rad; zeros without `project`."""
        return np.zeros((len(self.q), 2)) if self.projected is None else self.projected

    def __repr__(self) -> str:
        reason = f", reason={self.reason!r}" if self.reason else ""
        missed = "" if self.projected is None else f", off={self.projected!r}"
        rows = f"q={self.q!r}, status={self.status!r}, singular={self.singular!r}"
        return f"Solutions({rows}{reason}{missed})"

    def __len__(self) -> int:
        return len(self.q)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)

    def __getitem__(self, index: Any) -> Array:
        rows: Array = self.q[index]
        return rows


def no_held_values(dof: int, names: tuple[str, ...], real: bool) -> Solutions:
    """What a search over all values of held joints is answered with that found none inside the limits."""
    joints = " and ".join(names)
    if real:
        return no_solutions(
            dof, Status.LIMITS, f"outside the limits at all values looked at of {joints}"
        )
    return no_solutions(dof, Status.UNREACHABLE, f"no value looked at of {joints} reaches the pose")


def no_solutions(dof: int, status: Status, reason: str = "") -> Solutions:
    """What a pose without rows is answered with."""
    return Solutions(np.empty((0, dof)), status, np.empty(0, dtype=bool), reason)
