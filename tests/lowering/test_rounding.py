"""Running error analysis: bounds hold, and are not far from what is seen."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.lowering.rounding import Rounding

COUNT = 40


@pytest.fixture
def g() -> ExpressionGraph:
    return ExpressionGraph(COUNT)


def entry(g: ExpressionGraph, name: str, low: float = 0.1, high: float = 1.0) -> Expr:
    values = np.random.default_rng(len(name)).uniform(low, high, COUNT)
    return g.atom("input", name, values, unknown=False)


def test_a_difference_of_near_numbers_keeps_the_error_of_both(g: ExpressionGraph) -> None:
    a = entry(g, "a")
    near = g.atom("input", "near", (1.0 + 1e-9) * a.probe, unknown=False)
    rounding = Rounding(COUNT, {})
    off, value = rounding.of(g.sub(near, a)), np.abs(g.sub(near, a).probe)
    assert (off < 1e-15).all()
    assert (off > 1e-7 * value).all()


def test_a_small_divisor_enlarges(g: ExpressionGraph) -> None:
    a, b = entry(g, "a"), entry(g, "bb", 1e-6, 2e-6)
    bound = Rounding(COUNT, {}).of(g.div(a, b))
    exact = [Fraction(float(x)) / Fraction(float(y)) for x, y in zip(a.probe, b.probe, strict=True)]
    got = g.div(a, b).probe
    assert (
        np.array([abs(float(Fraction(float(v)) - e)) for v, e in zip(got, exact, strict=True)])
        <= bound
    ).all()
    assert (bound >= np.finfo(float).eps * a.probe / b.probe).all()


def test_a_root_is_off_by_its_equation_over_the_slope(g: ExpressionGraph) -> None:
    c, s = entry(g, "c"), entry(g, "ss")
    equation = g.sub(g.mul(entry(g, "a2"), c), g.const(0.2))
    rounding = Rounding(COUNT, {})
    rounding.note_root((c, s), equation, g.const(1e-5))
    assert rounding.most(c) == rounding.most(s)
    assert 1e-12 < rounding.most(c) < 1e-10


def test_what_is_solved_is_off_as_its_definition(g: ExpressionGraph) -> None:
    a, solved = entry(g, "a"), entry(g, "solved")
    root = g.sqrt(g.mul(g.const(1e-12), a))
    rounding = Rounding(COUNT, {solved.id: root})
    np.testing.assert_array_equal(rounding.of(solved), rounding.of(root))


def test_what_an_angle_moves_is_bounded_by_the_levers(g: ExpressionGraph) -> None:
    """`x cos(u) + y sin(u) + d`, for a radian of u and a metre of d; nothing is rounded."""
    u = np.linspace(-3.0, 3.0, COUNT)
    c, s = (
        g.atom("input", name, f(u), unknown=False) for name, f in (("c", np.cos), ("s", np.sin))
    )
    x, y, d = entry(g, "x"), entry(g, "yy"), entry(g, "ddd")
    levers = Rounding(COUNT, {}, unit=0.0)
    value = g.add(g.dot([x, y], [c, s]), d)
    assert levers.most(g.dot([x, y], [x, y])) == 0.0
    levers.note_moved((c, s))
    levers.note_moved((d,))
    slope = np.abs(-x.probe * np.sin(u) + y.probe * np.cos(u)) + 1.0
    bound = np.abs(x.probe * np.sin(u)) + np.abs(y.probe * np.cos(u)) + 1.0
    assert (levers.of(value) >= slope - 1e-15).all()
    np.testing.assert_allclose(levers.of(value), bound, rtol=1e-14)
