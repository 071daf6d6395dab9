"""Expressions as sums of products, like terms collected: what a reader would write down.

Only what the leaves' coefficients are made of is covered: + - * / and square roots.
"""

from __future__ import annotations

from ikgen.algebra.expression import Expr
from ikgen.formulas.normal_form import Radical, Sum, Symbol, constant
from ikgen.formulas.sum_arithmetic import add, inverse, multiply, single

__all__ = ["Normalizer"]


class Normalizer:
    """Turns nodes into sums, each node once."""

    def __init__(self) -> None:
        self._done: dict[Expr, Sum] = {}

    def __call__(self, node: Expr) -> Sum:
        """The node as a sum."""
        found = self._done.get(node)
        if found is None:
            found = self._done[node] = self._make(node)
        return found

    def _make(self, node: Expr) -> Sum:
        if node.op == "const":
            return constant(node.value)
        if node.op == "param":
            return single(Symbol("param", node.name, node.function))
        if node.atom is not None:
            return single(Symbol(node.atom.kind, node.atom.key))
        parts = [self(a) for a in node.args]
        if node.op == "add":
            return add(parts[0], parts[1])
        if node.op == "sub":
            return add(parts[0], -parts[1])
        if node.op == "neg":
            return -parts[0]
        if node.op == "mul":
            return multiply(parts[0], parts[1])
        if node.op == "div":
            return multiply(parts[0], inverse(parts[1]))
        if node.op == "sqrt":
            return single(Radical(parts[0]))
        return single(Symbol("other", f"{node.op}{node.id}"))
