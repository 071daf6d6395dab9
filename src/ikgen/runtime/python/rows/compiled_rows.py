"""Solutions of a compiled solver, as those of the Python module."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.rows.solutions import Solutions, Status

__all__ = ["STATUSES", "BranchNames", "Found", "found_nothing", "found_rows"]

STATUSES = tuple(Status)  # by the numbers that compiled solvers have for them
BranchNames = Callable[[Array], tuple[str, ...]]


class Found(Protocol):
    """What a compiled solver found: `status`, an index of `STATUSES`; as many rows as its length."""

    @property
    def status(self) -> int: ...

    @property
    def q(self) -> Array:
        """(k, dof)."""

    @property
    def singular(self) -> Flags:
        """(k,)."""

    @property
    def off(self) -> Array:
        """(k, 2): m, rad; numbers where it was asked to project alone."""

    def __len__(self) -> int: ...


class Later:
    """An attribute that is made out of the others when it is first asked for, without the lock that
    `cached_property` takes before Python 3.12."""

    def __init__(self, make: Callable[[dict[str, Any]], Any]) -> None:
        self.make = make

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, whole: object | None, owner: type | None = None) -> Any:
        if whole is None:
            return self
        others = whole.__dict__
        made = others[self.name] = self.make(others)
        return made


class CompiledSolutions(Solutions):
    """Solutions that a compiled solver `found`; `why`: gives the reason where there are no rows."""

    __qualname__ = "Solutions"  # as which they are shown

    status: Status = Status.OK
    q: Any = Later(lambda others: others["found"].q)
    singular: Any = Later(lambda others: others["found"].singular)
    reason: Any = Later(lambda others: others["why"]() if "why" in others else "")

    def __reduce__(self) -> tuple[Any, ...]:
        told = self.q, self.status, self.singular, self.reason, self.names, self.projected
        return Solutions, told


def found_rows(found: Found, names: BranchNames, project: object) -> Solutions:
    """The rows of a pose that has some."""
    out = object.__new__(CompiledSolutions)
    told = out.__dict__
    told["found"], told["names"] = found, names
    if project:
        told["projected"] = found.off
    return out


def found_nothing(found: Found, status: Status, why: Callable[[], str]) -> Solutions:
    """What a pose without rows is answered with; `why` gives the reason."""
    out = object.__new__(CompiledSolutions)
    told = out.__dict__
    told["found"], told["status"], told["why"] = found, status, why
    return out
