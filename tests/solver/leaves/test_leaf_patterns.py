"""Which equations leaves take, and where the coefficients go, on polynomials made by hand."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.probed import given
from tests.support.tables import table

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.equation import Equation
from ikgen.equations.knowledge import PolynomialEquation, Variable
from ikgen.forms.trig_polynomial_form import CIRCLE
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import (
    LEAVES,
    algebraic,
    quadratic,
    simultaneous,
    sine_and_cosine,
    tangent,
    trig_polynomial,
    trig_quartic,
)

ANGLE, OTHER, LENGTH = (
    Variable("angle", (1, 0, 0)), Variable("angle", (0, 1, 0)), Variable("prismatic", (0, 0, 1)),
)  # fmt: skip
G = ExpressionGraph(3)
A, B, C, D, E = (given(G, np.array([k + 0.5, k - 0.7, 2.0 - k])) for k in range(5))


def trig(kind: str, times: int = 1) -> tuple:
    return ((((times, 0, 0), kind),), ())


def slide(power: int) -> tuple:
    return ((), ((2, power),))


ONE = ((), ())
SINGLE = {trig("c"): A, trig("s"): B, ONE: C}
DOUBLE = {trig("c", 2): A, trig("s", 1): B, ONE: C}
FULL = {trig("c", 2): A, trig("s", 2): B, trig("c"): C, trig("s"): D, ONE: E}
TRIPLE = {trig("c", 3): A, ONE: C}
LINE = {slide(1): A, ONE: B}
THROUGH_ZERO = {slide(1): A}
PARABOLA = {slide(2): A, slide(1): B, ONE: C}
SQUARE = {slide(2): A, ONE: C}


def equation(polynomial: dict, *unknowns: Variable, entry: str = "px") -> PolynomialEquation:
    source = Equation(A, B, 0, 1, entry)
    return PolynomialEquation(polynomial, unknowns, (source,), len(unknowns))


def found(leaf, polynomial: dict, unknown: Variable, *, entry: str = "px") -> list[Candidate]:
    """What a leaf makes of one equation; it makes nothing of it where another unknown is in it too, or for
    an unknown of the other kind."""
    knowledge = SimpleNamespace(graph=G)
    alone = equation(polynomial, unknown, entry=entry)
    candidates = leaf.find([alone], unknown, knowledge)
    assert leaf.find([], unknown, knowledge) == []
    assert leaf.find([equation(polynomial, OTHER, unknown)], unknown, knowledge) == []
    other = LENGTH if unknown.kind == "angle" else ANGLE
    assert leaf.find([equation(polynomial, other)], other, knowledge) == []
    three = leaf.find([equation({}, OTHER), alone, equation({}, OTHER, LENGTH)], unknown, knowledge)
    assert three == candidates
    assert all(c.unknown == unknown and c.sources == alone.sources for c in candidates)
    return candidates


@pytest.mark.parametrize(
    ("leaf", "unknown", "polynomial", "form", "coefficients"),
    [
        (algebraic, LENGTH, LINE, "linear", (A, B)),
        (algebraic, LENGTH, THROUGH_ZERO, "linear", (A, G.zero)),
        (quadratic, LENGTH, PARABOLA, "root", (A, B, C)),
        (quadratic, LENGTH, SQUARE, "root", (A, G.zero, C)),
        (trig_quartic, ANGLE, FULL, "quartic", (A, B, C, D, E)),
        (trig_quartic, ANGLE, DOUBLE, "quartic", (A, G.zero, G.zero, B, C)),
        (sine_and_cosine, ANGLE, SINGLE, "sincos", (A, B, G.neg(C))),
        (sine_and_cosine, ANGLE, {trig("c"): A, ONE: C}, "sincos", (A, G.zero, G.neg(C))),
        (sine_and_cosine, ANGLE, {trig("s"): B, ONE: C}, "sincos", (G.zero, B, G.neg(C))),
        (sine_and_cosine, ANGLE, {trig("c"): A, trig("s"): B}, "tangent", (B, G.neg(A))),
    ],
)  # fmt: skip
def test_a_leaf_takes_its_pattern(leaf, unknown, polynomial, form, coefficients) -> None:
    (candidate,) = found(leaf, polynomial, unknown)
    assert candidate.form.name == form and candidate.coefficients == coefficients


@pytest.mark.parametrize(
    ("leaf", "unknown", "polynomials"),
    [
        (algebraic, LENGTH, (PARABOLA, SQUARE, {**LINE, **SINGLE}, {slide(3): A})),
        (quadratic, LENGTH, (LINE, {slide(3): A, ONE: C}, {**SQUARE, **SINGLE})),
        (trig_quartic, ANGLE, (SINGLE, TRIPLE, {**DOUBLE, **LINE})),
        (sine_and_cosine, ANGLE, (DOUBLE, FULL, TRIPLE, {**SINGLE, **LINE})),
    ],
)
def test_a_leaf_leaves_what_is_not_its_pattern(leaf, unknown, polynomials) -> None:
    for polynomial in polynomials:
        assert leaf.find([equation(polynomial, unknown)], unknown, SimpleNamespace(graph=G)) == []
    right = {algebraic: LINE, quadratic: SQUARE, trig_quartic: FULL, sine_and_cosine: SINGLE}[leaf]
    every = [equation(p, unknown) for p in (*polynomials, right, polynomials[0], right)]
    assert len(leaf.find(every, unknown, SimpleNamespace(graph=G))) == 2


def test_sums_of_squares_and_single_functions_have_names_of_their_own() -> None:
    single, both = {trig("c"): A, ONE: C}, SINGLE
    names = [
        found(sine_and_cosine, p, ANGLE, entry=entry)[0].leaf
        for p, entry in ((single, "px"), (both, "px"), (single, "p.p"), (both, "px2+py2"))
    ]
    assert names == ["sine or cosine", "sine and cosine", "x2y2", "x2y2"]


def test_a_pair_takes_both_equations_and_both_their_sources() -> None:
    knowledge = SimpleNamespace(graph=G)
    equations = [
        equation(SINGLE, ANGLE),
        equation({trig("c"): D, trig("s"): E, ONE: B}, ANGLE, entry="pz"),
        equation({**DOUBLE}, ANGLE),
        equation(SINGLE, ANGLE, OTHER),
    ]
    (candidate,) = simultaneous.find(equations, ANGLE, knowledge)
    assert set(candidate.sources) == {*equations[0].sources, *equations[1].sources}
    assert {*candidate.coefficients} == {A, B, G.neg(C), D, E, G.neg(B)}
    assert simultaneous.find(equations[:1] * 2, ANGLE, knowledge) == []
    assert simultaneous.find(equations, LENGTH, knowledge) == []


def test_multiples_of_an_angle_are_taken_with_the_range_of_its_joint() -> None:
    """Of the angle of a joint where its values are looked for, of a sum on the circle."""
    dh = table(*[("R", "0", 0.3, 0.0)] * 3)
    knowledge = SimpleNamespace(graph=G, variables=SimpleNamespace(dh=dh))
    both = {trig("c", 5): A, trig("s", 2): B, trig("s", 5): D, ONE: C}
    (candidate,) = trig_polynomial.find([equation(both, ANGLE)], ANGLE, knowledge)
    form = candidate.form
    assert form.harmonics == (2, 5) and form.coefficients == (G.zero, B, A, D, C)
    assert form.span == CIRCLE and candidate.branches == form.branches == 10
    one = trig_polynomial.find([equation({trig("c", 3): A}, ANGLE)], ANGLE, knowledge)
    assert [c.coefficients for c in one] == [(A, G.zero, G.zero)]
    for other in (SINGLE, DOUBLE, FULL, {**TRIPLE, **LINE}):
        assert trig_polynomial.find([equation(other, ANGLE)], ANGLE, knowledge) == []
    assert trig_polynomial.find([equation(PARABOLA, LENGTH)], LENGTH, knowledge) == []
    assert (
        trig_polynomial.find([equation({trig("c", 17): A, ONE: C}, ANGLE)], ANGLE, knowledge) == []
    )
    assert trig_polynomial.find([equation(TRIPLE, OTHER, ANGLE)], ANGLE, knowledge) == []


@pytest.mark.parametrize("off", [1e-12, 1e-6])
def test_the_sides_of_a_pair_do_not_tell_whether_it_is_one(off: float) -> None:
    """Only the coefficients do, however large the sides are."""
    one, near, large = G.const(2.0), G.const(2.0 + off), given(G, np.full(3, 1e9))
    equations = [
        equation({trig("c"): one, trig("s"): one, ONE: large}, ANGLE),
        equation({trig("c"): one, trig("s"): near, ONE: G.mul(large, large)}, ANGLE, entry="py"),
    ]
    for order in (equations, equations[::-1]):
        pairs = simultaneous.find(order, ANGLE, SimpleNamespace(graph=G))
        assert len(pairs) == (off > 1e-9)


def times(kind: str, value) -> dict:
    """Cosine or sine of the unknown, times a factor that is not known."""
    return {((((0, 1, 0), "c"), ((1, 0, 0), kind)), ()): value}


def test_a_common_unknown_factor_leaves_a_direction() -> None:
    """`2 K cos = C` and `K sin = D` with K unknown: the direction is of (C, 2 D)."""
    knowledge = SimpleNamespace(graph=G)
    equations = [
        equation({**times("c", G.const(2.0)), ONE: G.neg(C)}, OTHER, ANGLE),
        equation({**times("s", G.one), ONE: G.neg(D)}, OTHER, ANGLE, entry="py"),
    ]
    (candidate,) = tangent.find(equations, ANGLE, knowledge)
    x, y = (e.probe for e in candidate.coefficients)
    np.testing.assert_allclose(x * 2.0 * D.probe, y * C.probe, rtol=1e-14)
    assert candidate.sources == (*equations[0].sources, *equations[1].sources)
    assert tangent.find(equations[:1], ANGLE, knowledge) == []
    assert tangent.find(equations, LENGTH, knowledge) == []
    zero = [
        equation({k: v for k, v in e.polynomial.items() if k != ONE}, OTHER, ANGLE)
        for e in equations
    ]
    assert tangent.find(zero, ANGLE, knowledge) == []


def test_every_leaf_has_a_pattern_here() -> None:
    here = (
        algebraic, quadratic, trig_polynomial, trig_quartic, sine_and_cosine, simultaneous, tangent
    )  # fmt: skip
    assert {leaf.find for leaf in LEAVES} == {module.find for module in here}


@pytest.mark.parametrize("off", [0.0, 1e-12, 1e-6])
def test_the_same_direction_twice_is_no_pair(off: float) -> None:
    one = tangent._Row(G.const(2.0), G.const(2.0), C, equation({}, OTHER, ANGLE))
    two = tangent._Row(G.const(2.0), G.const(2.0 + off), D, equation({}, OTHER, ANGLE))
    for first, second in ((one, two), (two, one)):
        found = tangent._solve(first, second, ANGLE, SimpleNamespace(graph=G))
        assert (found is None) == (off < 1e-9)
