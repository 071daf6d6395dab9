"""Ring laws of trigonometric polynomials, against their values at random angles."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.support.polynomials import polynomial_values

from ikgen.algebra import polynomial as poly
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.algebra.polynomial import AngleCombination, Monomial, Polynomial, canonical

PROBES = 4
GROUP = (0, 0, 2, 3)
"""Angles 0 and 1 are of parallel axes, 2 is by itself, 3 is a length."""
ONE: Monomial = ((), ())
ANGLES = np.random.default_rng(3).uniform(-3.0, 3.0, (PROBES, 4))

Words = list[tuple[Monomial, Fraction, int]]
SMALL = st.integers(-2, 2)


def group_of(combination: AngleCombination) -> int:
    """The group of the combination's first angle."""
    return next((GROUP[j] for j, k in enumerate(combination) if k), -1)


@st.composite
def monomials(draw: st.DrawFn) -> Monomial:
    """A product of at most one function a group, and of a power of the length."""
    trigs = []
    for combinations in (
        st.tuples(SMALL, SMALL, st.just(0), st.just(0)),
        st.sampled_from([(0, 0, 1, 0)]),
    ):
        combination, sign = canonical(draw(combinations))
        if sign and draw(st.booleans()):
            trigs.append((combination, draw(st.sampled_from("cs"))))
    power = draw(st.integers(0, 2))
    return tuple(trigs), ((3, power),) if power else ()


QUARTERS = st.integers(-12, 12).map(lambda n: Fraction(n, 4))
"""Numbers whose sums and products are exact, so that terms cancel entirely."""

POLYNOMIALS: st.SearchStrategy[Words] = st.lists(
    st.tuples(monomials(), QUARTERS, st.integers(0, 2)),
    max_size=4,
)


def made(g: ExpressionGraph, words: Words) -> Polynomial:
    """The polynomial of (monomial, number, which atom its coefficient holds) terms."""
    probe = np.random.default_rng(5).uniform(0.5, 1.5, (3, PROBES))
    out: Polynomial = {}
    for mono, number, i in words:
        atom = g.atom("pose", f"p{i}", probe[i], unknown=False) if i else g.one
        if number:
            out = poly.add(g, out, {mono: g.mul(g.const(float(number)), atom)})
    return out


def value(p: Polynomial) -> np.ndarray:
    """Its values (PROBES,), each coefficient's at one set of angles."""
    return polynomial_values(p, ANGLES)


def assert_same(g: ExpressionGraph, a: Polynomial, b: Polynomial) -> None:
    """Equal polynomials have the same terms, and nothing is left of their difference."""
    np.testing.assert_allclose(value(a), value(b), atol=1e-8)
    assert set(a) == set(b)
    assert poly.subtract(g, a, b) == {}


@settings(deadline=None)
@given(POLYNOMIALS, POLYNOMIALS)
def test_values_are_those_of_the_operation(a: Words, b: Words) -> None:
    g = ExpressionGraph(PROBES)
    p, q = made(g, a), made(g, b)
    expected = sum((float(c) * value({m: g.one}) * _atom(i) for m, c, i in a), np.zeros(PROBES))
    np.testing.assert_allclose(value(p), expected, atol=1e-9)
    np.testing.assert_allclose(value(poly.add(g, p, q)), value(p) + value(q), atol=1e-9)
    np.testing.assert_allclose(value(poly.subtract(g, p, q)), value(p) - value(q), atol=1e-9)
    product = poly.multiply(g, group_of, p, q)
    np.testing.assert_allclose(value(product), value(p) * value(q), rtol=1e-9, atol=1e-8)
    factor = g.const(-1.5)
    np.testing.assert_allclose(value(poly.scale(g, p, factor)), -1.5 * value(p), atol=1e-9)


def _atom(i: int) -> np.ndarray:
    probe = np.random.default_rng(5).uniform(0.5, 1.5, (3, PROBES))
    return probe[i] if i else np.ones(PROBES)


@settings(deadline=None, max_examples=60)
@given(POLYNOMIALS, POLYNOMIALS, POLYNOMIALS)
def test_equal_polynomials_have_equal_terms(a: Words, b: Words, c: Words) -> None:
    g = ExpressionGraph(PROBES)
    p, q, r = made(g, a), made(g, b), made(g, c)

    def times(x: Polynomial, y: Polynomial) -> Polynomial:
        return poly.multiply(g, group_of, x, y)

    assert_same(g, poly.add(g, p, q), poly.add(g, q, p))
    assert_same(g, times(p, q), times(q, p))
    assert_same(g, times(p, poly.add(g, q, r)), poly.add(g, times(p, q), times(p, r)))
    assert_same(g, times(times(p, q), r), times(p, times(q, r)))
    assert_same(g, times(p, {ONE: g.one}), p)
    assert poly.subtract(g, p, p) == {}


@given(st.tuples(SMALL, SMALL, SMALL))
def test_a_canonical_key_starts_positive(combination: AngleCombination) -> None:
    found, sign = canonical(combination)
    assert tuple(k * sign for k in found) == combination
    assert next((k for k in found if k), 0) >= 0
    assert (sign == 0) == (not any(combination))


@given(st.tuples(SMALL, SMALL, st.just(0), st.just(0)).filter(any))
def test_the_squares_of_cosine_and_sine_are_one_by_construction(
    combination: AngleCombination,
) -> None:
    g = ExpressionGraph(PROBES)
    combination = canonical(combination)[0]
    parts = [{(((combination, kind),), ()): g.one} for kind in "cs"]
    squares = [poly.multiply(g, group_of, p, p) for p in parts]
    assert poly.add(g, *squares) == {ONE: g.one}


def test_products_within_a_group_become_sums_and_others_stay() -> None:
    g = ExpressionGraph(PROBES)
    c1, s2, c3 = (
        {(((combination, kind),), ()): g.one}
        for combination, kind in (((1, 0, 0, 0), "c"), ((0, 1, 0, 0), "s"), ((0, 0, 1, 0), "c"))
    )
    within = poly.multiply(g, group_of, c1, s2)
    assert set(within) == {((((1, 1, 0, 0), "s"),), ()), ((((1, -1, 0, 0), "s"),), ())}
    across = poly.multiply(g, group_of, c3, c1)
    assert set(across) == {((((1, 0, 0, 0), "c"), ((0, 0, 1, 0), "c")), ())}
