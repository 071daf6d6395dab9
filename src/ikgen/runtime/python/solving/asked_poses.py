"""Poses that are asked for, and what is answered."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ikgen.runtime.python.arm.held_parameters import aims
from ikgen.runtime.python.arm.solved_arm import Arm, Found
from ikgen.runtime.python.arrays.array_tuples import some_of
from ikgen.runtime.python.arrays.array_types import Array, Index, Row
from ikgen.runtime.python.solving.closed_form_rows import AllRows

__all__ = ["Answer", "Asked"]

_ALL = slice(None)


@dataclass(frozen=True)
class Asked:
    """Poses `T` (n, 4, 4), seeds `near` (n, dof) if there are any, and values `held` (n, held); what the
    closed form has, `closed`, if that is known."""

    T: Array
    near: Array | None
    held: Array
    closed: AllRows | None = None

    def at(self, index: Index) -> Asked:
        """Some of them."""
        near = None if self.near is None else self.near[index]
        closed = None if self.closed is None else some_of(self.closed, index)
        return Asked(self.T[index], near, self.held[index], closed)

    def aim(self, arm: Arm, index: Index | slice = _ALL) -> Array:
        """What rows for some of them are refined towards (n, ...)."""
        return aims(arm, self.T[index], self.held[index])

    def seed(self, k: int) -> Row | None:
        """The seed of one pose."""
        return None if self.near is None else tuple(self.near[k].tolist())

    def starts(self, arm: Arm, turn: Array | None = None) -> Array:
        """Values (n, dof) for joints that the poses leave free, those of revolute ones turned by `turn`
        (n,); held ones as they are."""
        q = np.zeros((len(self.T), len(arm.lower))) if self.near is None else self.near.copy()
        if turn is not None:
            q[:, np.array(arm.period) > 0.0] += turn[:, None]
        q[:, list(arm.free)] = self.held[:, : len(arm.free)]
        return q


@dataclass
class Answer:
    """Solutions on the right turns, whether there were any before limits, and those of continua that there
    were then, at the last values that were tried; whether the closed form had rows of continua."""

    rows: list[Found] = field(default_factory=list)
    real: bool = False
    loose: list[Found] = field(default_factory=list)
    led: bool = False

    @property
    def stands(self) -> bool:
        """Whether a row stands for a continuum."""
        return any(singular for _, singular in self.rows)
