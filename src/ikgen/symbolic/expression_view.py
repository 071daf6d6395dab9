"""Nodes of an expression graph as SymPy expressions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import sympy

from ikgen.algebra.expression import Atom, Expr
from ikgen.symbolic.exact_numbers import exact_number
from ikgen.symbolic.symbol_names import SymbolNames

__all__ = ["ARITHMETIC", "ExpressionView"]

AngleOf = Callable[[tuple[int, ...]], sympy.Expr]

ARITHMETIC: Mapping[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
    "sqrt": sympy.sqrt,
}
"""Operations of algebraic expressions, by their names in the graph."""


class ExpressionView:
    """Turns nodes into SymPy expressions, each node once. `angle` gives the angle of a combination, by
    default the sum of its joints' variables."""

    def __init__(self, names: SymbolNames, angle: AngleOf | None = None) -> None:
        self.names = names
        self._angle = angle or self._of_joints
        self._done: dict[Expr, sympy.Expr] = {}

    def __call__(self, node: Expr) -> sympy.Expr:
        """The node in SymPy, constants exact."""
        found = self._done.get(node)
        if found is None:
            found = self._done[node] = self._make(node)
        return found

    def _make(self, node: Expr) -> sympy.Expr:
        if node.is_const:
            return exact_number(node.value).sympy
        if node.op == "param":
            return self._constant(node)
        if node.atom is not None:
            return self._atom(node.atom)
        return ARITHMETIC[node.op](*(self(a) for a in node.args))

    def _constant(self, node: Expr) -> sympy.Expr:
        """A length, or the cosine or sine of a constant angle."""
        f = node.function
        if f is None:
            return self.names.constant(node.name)
        return {"cos": sympy.cos, "sin": sympy.sin}[f.function](self.names.constant(f.angle))

    def _atom(self, atom: Atom) -> sympy.Expr:
        if isinstance(atom.key, str):
            return self.names.pose(atom.key)
        if atom.kind == "prismatic":
            return self.names.joint(atom.key.index(1))
        return {"cos": sympy.cos, "sin": sympy.sin}[atom.kind](self._angle(atom.key))

    def _of_joints(self, combination: tuple[int, ...]) -> sympy.Expr:
        return sympy.Add(*(k * self.names.joint(j) for j, k in enumerate(combination) if k))
