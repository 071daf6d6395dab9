"""What each form's functions give for coefficients made by hand: divisors, folds, discriminants, slopes."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest
from tests.support.probed import given

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.form import Form
from ikgen.forms.linear_form import Linear
from ikgen.forms.pair_form import LinearPair
from ikgen.forms.quadratic_form import Quadratic
from ikgen.forms.quartic_form import TrigQuartic
from ikgen.forms.sine_cosine_form import SineCosine
from ikgen.forms.tangent_form import Tangent
from ikgen.model.arrays import Array

COEFFICIENTS = [
    np.array(c)
    for c in ((3.0, -0.5), (-2.0, 0.7), (0.4, 1.1), (1.3, -0.9), (2.5, 0.6), (-0.8, 0.2))
]
SIZES = [4.0, 5.0, 11.0, 7.0, 13.0, 17.0]


def form_of(form: type[Form], columns: int = 2) -> tuple[ExpressionGraph, Form]:
    graph = ExpressionGraph(columns)
    count = len(fields(form))
    return graph, form(*(given(graph, c) for c in COEFFICIENTS[:count]))


A, B, C, D, E, F = COEFFICIENTS
DIVISORS: list[tuple[type[Form], list[Array]]] = [
    (Linear, [A / 4.0]),
    (Quadratic, [A / 4.0]),
    (SineCosine, [A / 5.0, B / 5.0]),
    (Tangent, [A / 5.0, B / 5.0]),
    (LinearPair, [(A * E - B * D) / (4.0 * 13.0 + 5.0 * 7.0)]),
    (TrigQuartic, [A / 11.0, B / 11.0, C / 11.0, D / 11.0]),
]


@pytest.mark.parametrize(("form", "expected"), DIVISORS, ids=lambda x: getattr(x, "name", ""))
def test_divisors_are_in_natural_units(form: type[Form], expected: list[Array]) -> None:
    _, one = form_of(form)
    count = len(one.coefficients)
    found = one.divisor(COEFFICIENTS[:count], SIZES[:count])
    assert found.shape == (len(expected), 2)
    np.testing.assert_allclose(found, expected, rtol=1e-15)
    assert all(any(part is e for e in one.coefficients) for part in one.divisor_parts)


def test_an_equation_s_derivative_is_where_its_branches_meet() -> None:
    _, one = form_of(SineCosine)
    u = np.array([0.3, 2.0])
    found = one.fold(COEFFICIENTS[:3], SIZES[:3], u)
    assert found is not None
    np.testing.assert_allclose(found, [(A * np.sin(u) - B * np.cos(u)) / 5.0], rtol=1e-14)


def test_discriminants_are_relative() -> None:
    _, quadratic = form_of(Quadratic)
    _, sine = form_of(SineCosine)
    for one, expected in (
        (quadratic, (B**2 - 4 * A * C) / (B**2 + abs(4 * A * C))),
        (sine, 1.0 - C**2 / (A**2 + B**2)),
    ):
        found = one.discriminant()
        assert found is not None
        np.testing.assert_allclose(found, expected, rtol=1e-14)


def test_a_pattern_vanishes_at_the_roots_alone() -> None:
    roots: dict[type[Form], list[tuple[Array, ...]]] = {}
    for form in (Linear, Quadratic, SineCosine, Tangent, LinearPair):
        graph, one = form_of(form)
        c = [x.copy() for x in COEFFICIENTS]
        if form is SineCosine:
            c[2] = 0.3 * c[2]
        if form is Quadratic:
            c[2] = -0.5 * np.sign(c[0])
        one = form(*(given(graph, x) for x in c[: len(fields(form))]))
        for values in one.values(one.probe):
            for away in (0.0, 0.25):
                unknown = tuple(given(graph, v + away) for v in values)
                rest = [e.probe for e in one.pattern(graph, unknown)]
                assert (np.abs(rest).max() < 1e-12) == (away == 0.0)
            roots.setdefault(form, []).append(values)
    assert {form: len(found) for form, found in roots.items()} == {
        Linear: 1, Quadratic: 2, SineCosine: 2, Tangent: 2, LinearPair: 1,
    }  # fmt: skip


def test_a_quartic_s_slope_is_its_derivative() -> None:
    graph, one = form_of(TrigQuartic)
    u, h = np.array([0.7, -1.9]), 1e-6

    def at(angle: Array) -> tuple:
        return given(graph, np.cos(angle)), given(graph, np.sin(angle))

    slope = one.slope(graph, at(u))
    assert slope is not None
    (up,), (down,) = (one.pattern(graph, at(u + step)) for step in (h, -h))
    np.testing.assert_allclose(slope.probe, (up.probe - down.probe) / (2 * h), rtol=1e-8)
    steep = one.steepness((np.cos(u), np.sin(u)))
    assert steep is not None
    largest = np.abs(one.probe).max(axis=0)
    np.testing.assert_allclose(steep * largest, np.abs(slope.probe), rtol=1e-12)
