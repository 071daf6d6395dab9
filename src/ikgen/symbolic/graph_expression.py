"""SymPy expressions as nodes of an expression graph."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce

import sympy

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.symbolic.lowered_view import NotAlgebraicError

__all__ = ["graph_expression"]


def graph_expression(
    g: ExpressionGraph, e: sympy.Expr, values: Mapping[sympy.Symbol, Expr]
) -> Expr:
    """The expression with nodes for its symbols: sums, products, whole powers and square roots.

    Raises `NotAlgebraicError` for anything else.
    """
    if e.is_Symbol and e in values:
        return values[e]
    if e.is_number and e.is_real:
        return g.const(float(e))
    parts = [graph_expression(g, a, values) for a in e.args if not e.is_Pow]
    if e.is_Add:
        return reduce(g.add, parts)
    if e.is_Mul:
        return _product(g, e, values)
    if e.is_Pow and e.exp.is_Integer and e.exp > 0:
        base = graph_expression(g, e.base, values)
        return reduce(g.mul, [base] * int(e.exp))
    if e.is_Pow and e.exp == sympy.Rational(1, 2):
        return g.sqrt(graph_expression(g, e.base, values))
    raise NotAlgebraicError(f"'{e}' is neither sum, product, whole power nor square root")


def _product(g: ExpressionGraph, e: sympy.Expr, values: Mapping[sympy.Symbol, Expr]) -> Expr:
    """A product; what is below the line is divided by once."""
    above, below = sympy.fraction(e)
    if below.is_number:
        nodes = [graph_expression(g, a, values) for a in sympy.Mul.make_args(e)]
        return reduce(g.mul, nodes)
    top, bottom = (graph_expression(g, part, values) for part in (above, below))
    return g.div(top, bottom)
