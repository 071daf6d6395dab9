"""Angles as pairs of cosine and sine, added."""

from __future__ import annotations

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph

__all__ = ["Pair", "angle_sum"]

Pair = tuple[Expr, Expr]


def angle_sum(g: ExpressionGraph, a: Pair, b: Pair) -> Pair:
    """Cosine and sine of the sum of two angles."""
    (ac, as_), (bc, bs) = a, b
    return g.sub(g.mul(ac, bc), g.mul(as_, bs)), g.add(g.mul(as_, bc), g.mul(ac, bs))
