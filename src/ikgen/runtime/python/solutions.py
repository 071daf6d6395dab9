"""What a solve gives back."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from ikgen.runtime.python.array_types import Array, Flags

__all__ = ["Solutions", "Status"]


class Status(str, Enum):
    """How a solve ended; equal to its name as text, of which `solve_batch` gives arrays."""

    OK = "OK"
    UNREACHABLE = "UNREACHABLE"
    LIMITS = "LIMITS"
    INVALID = "INVALID"
    SINGULAR = "SINGULAR"  # of a path alone
    __str__ = str.__str__  # NumPy compares by it


@dataclass(frozen=True)
class Solutions:
    """Solutions of one pose: `q` (k, DOF), `status`, and `singular` (k,): rows of a continuum."""

    q: Array
    status: Status
    singular: Flags

    def __len__(self) -> int:
        return len(self.q)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)
