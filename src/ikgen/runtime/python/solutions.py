"""What a solve gives back."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from ikgen.runtime.python.array_types import Array, Flags

__all__ = ["Solutions", "Status"]


class Status(str, Enum):
    """How a solve ended; equal to its name as text, of which `solve_batch` gives arrays."""

    OK = "OK"
    UNREACHABLE = "UNREACHABLE"
    LIMITS = "LIMITS"
    INVALID = "INVALID"
    __str__ = str.__str__  # NumPy compares by it


@dataclass(frozen=True)
class Solutions:
    """Solutions of one pose: `q` (k, DOF), `status`, and `singular` (k,): rows of a continuum; `reason`
    says why a pose is INVALID. As a sequence: its rows."""

    q: Array
    status: Status
    singular: Flags
    reason: str = ""
    names: Callable[[Array], tuple[str, ...]] | None = field(
        default=None, repr=False, compare=False
    )

    @property
    def branch(self) -> tuple[str, ...]:
        """What distinguishes each row: sides of shoulder, elbow and wrist where the arm has those."""
        return () if self.names is None else self.names(self.q)

    def __len__(self) -> int:
        return len(self.q)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)

    def __getitem__(self, index: Any) -> Array:
        rows: Array = self.q[index]
        return rows
