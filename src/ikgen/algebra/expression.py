"""Expressions as a hash-consed graph whose nodes carry their values at probe configurations.

Every node knows its value at a fixed set of configurations (random ones and regular special ones), so
"does this vanish identically?" and "is this constant?" are answered by looking (the zero test by
probing of the method's notes; Schwartz-Zippel for the polynomial part). Equal subexpressions are one
node, so sharing in the emitted code costs nothing to find.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.model.angle_function import AngleFunction

__all__ = ["BINARY", "UNARY", "Atom", "Expr", "Probe"]

Probe = NDArray[np.float64]
ZERO_TOLERANCE = 1e-10
"""A node is zero where its probe values stay below this, relative to the largest term that made it."""


@dataclass(frozen=True, slots=True)
class Atom:
    """What an input node stands for: `kind` is one of pose, cos, sin, prismatic, input, coefficient, sigma;
    `key` says which one (an angle combination, a joint's index, a pose entry's name)."""

    kind: str
    key: tuple[int, ...] | str


class Expr:
    """A node: operation, arguments, probe values. Compare by identity; made by `NodeTable` only."""

    __slots__ = (
        "_vanishes", "args", "atom", "function", "id", "is_const", "is_fixed", "name", "op", "probe",
        "scale", "support", "value",
    )  # fmt: skip

    def __init__(
        self, op: str, args: tuple[Expr, ...], probe: Probe, scale: float, support: int
    ) -> None:
        self.op = op
        self.args = args
        self.probe = probe
        self.scale = scale
        self.support = support
        self.value = 0.0
        self.name = ""
        self.atom: Atom | None = None
        self.function: AngleFunction | None = None  # of a constant angle, which a parameter may be
        self.id = -1
        self._vanishes: bool | None = None  # not yet asked
        self.is_fixed: bool = op != "atom" and all(a.is_fixed for a in args)
        """Whether the node depends on parameters and numbers only."""
        self.is_const: bool = op == "const"
        """Whether the node is a literal number."""

    @property
    def vanishes(self) -> bool:
        """Whether the node is zero at every probe configuration."""
        if self._vanishes is None:
            self._vanishes = bool(np.abs(self.probe).max() <= ZERO_TOLERANCE * self.scale)
        return self._vanishes

    def __repr__(self) -> str:
        return f"<{self.op} {self.name or self.value or [a.id for a in self.args]}>"


BINARY: dict[str, Callable[..., Probe]] = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "max": np.maximum,
    "min": np.minimum,
    "atan2": np.arctan2,
    "gt": lambda a, b: (a > b).astype(float),
    "and": np.multiply,
    "or": np.maximum,
}
UNARY: dict[str, Callable[..., Probe]] = {
    "neg": np.negative,
    "abs": np.abs,
    "sqrt": lambda a: np.sqrt(np.maximum(a, 0.0)),
    "not": lambda a: 1.0 - a,
}
