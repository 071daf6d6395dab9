"""A scalar equation of a chain, and where it comes from."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.algebra.expression import Expr

__all__ = ["Equation"]


@dataclass(frozen=True, slots=True)
class Equation:
    """`left = right`: entry `entry` of the matrix equation that moves k joints to the left and keeps
    joints k+1..m on the right. Norms carry the entry names "p.p", "px2+py2", "qx2+qy2"."""

    left: Expr
    right: Expr
    k: int
    m: int
    entry: str

    @property
    def label(self) -> str:
        """Where the equation comes from, as the report prints it."""
        return f"({self.k},{self.m}) {self.entry}"

    @property
    def squared(self) -> bool:
        """Whether the equation is a sum of squares."""
        return "+" in self.entry or "." in self.entry
