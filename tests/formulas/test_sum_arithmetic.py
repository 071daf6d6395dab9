"""Formulas are written the shorter way: factored, or multiplied out."""

from __future__ import annotations

import pytest

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.formulas.naming import Abbreviations
from ikgen.formulas.normalizer import Normalizer
from ikgen.formulas.notation import show


def _atoms(g: ExpressionGraph) -> list[Expr]:
    return [g.param(name, value) for name, value in (("x", 2.0), ("y", 3.0), ("z", 5.0))]


@pytest.fixture
def g() -> ExpressionGraph:
    return ExpressionGraph(1)


def _latex(node: Expr) -> str:
    return show(Normalizer()(node)).latex.replace("\\,", "")


def test_a_discriminant_cancels(g: ExpressionGraph) -> None:
    """(1/4) ((2 y)^2 - 4 (y^2 + z^2 - x^2)), of a quadratic equation."""
    x, y, z = _atoms(g)
    rest = g.sub(g.add(g.square(y), g.square(z)), g.square(x))
    b = g.mul(g.const(2.0), y)
    under = g.sub(g.square(b), g.mul(g.const(4.0), rest))
    assert _latex(g.mul(g.const(0.25), under)) in ("{x}^{2}-{z}^{2}", "-{z}^{2}+{x}^{2}")


def test_squares_that_cancel_are_multiplied_out(g: ExpressionGraph) -> None:
    x, y, _ = _atoms(g)
    squares = g.add(g.square(x), g.square(y))
    assert _latex(g.sub(g.square(g.add(x, y)), squares)) == "2xy"


def test_factors_stay_where_they_are_shorter(g: ExpressionGraph) -> None:
    x, y, z = _atoms(g)
    assert _latex(g.mul(z, g.add(x, y))) == "z(x+y)"
    assert _latex(g.square(g.sub(x, y))) == "{(x-y)}^{2}"
    assert _latex(g.mul(g.const(2.0), g.add(x, y))) == "2(x+y)"


def test_numbers_go_in_where_they_cancel(g: ExpressionGraph) -> None:
    x, y, _ = _atoms(g)
    four = g.sub(g.mul(g.const(4.0), g.square(x)), g.mul(g.const(4.0), y))
    assert _latex(g.mul(g.const(0.25), four)) == "{x}^{2}-y"


def test_nodes_of_other_graphs_are_others(g: ExpressionGraph) -> None:
    """Tables that grow apart give the same numbers to different nodes."""
    x, y, z = _atoms(g)
    one, other = g.extended(), g.extended()
    first, second = one.mul(x, y), other.mul(y, z)
    assert first.id == second.id
    normal = Normalizer()
    assert normal(first) != normal(second)


def test_a_name_stands_for_the_negative_too(g: ExpressionGraph) -> None:
    x, y, z = _atoms(g)
    normal = Normalizer()
    size = g.sub(g.sub(g.square(x), g.square(y)), g.mul(g.const(3.0), g.square(z)))
    names = Abbreviations([])
    names._name(normal(size))
    assert show(names.short(normal(g.neg(size)))).latex == "-u_{1}"
    squared = names.inside(normal(g.mul(z, g.square(g.neg(size)))))
    assert "u_{1}^{2}" in show(squared).latex
