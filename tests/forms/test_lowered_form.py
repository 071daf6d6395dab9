"""Divisors, their thresholds and the tolerances of square roots."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.support.probed import given

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.lowered_form import (
    ROUNDED,
    Tolerances,
    at_least,
    divisor_of,
    leading,
    sign_of_squares,
)

SHARES = np.array([1.0, 0.5, 1e-2, 1e-5, 1e-9, 0.0])


@pytest.mark.parametrize("size", [1.0, 20.0])
def test_shares_of_a_divisor_are_of_the_power_that_it_is(size: float) -> None:
    g = ExpressionGraph(len(SHARES))
    plain = divisor_of(g, given(g, -size * SHARES), Tolerances())
    squares = leading(g, (given(g, size * SHARES), g.zero), Tolerances())
    for divisor, power in ((plain, 1), (squares, 2)):
        assert divisor.power == power
        for share in (1e-3, 1e-7):
            above = divisor.above(g, share)
            assert above is not None
            assert list(above.probe > 0.5) == list(share < SHARES)


def test_a_divisor_is_one_where_it_vanishes() -> None:
    g = ExpressionGraph(len(SHARES))
    tolerances = Tolerances(singular=1e-7, flag=1e-3)
    divisor = divisor_of(g, given(g, 3.0 * SHARES), tolerances)
    assert divisor.regular is not None and divisor.clear is not None
    assert list(divisor.regular.probe > 0.5) == list(SHARES > 1e-7)
    assert list(divisor.clear.probe > 0.5) == list(SHARES > 1e-3)
    np.testing.assert_array_equal(divisor.value.probe, np.where(SHARES > 1e-7, 3.0 * SHARES, 1.0))


def test_a_constant_divisor_has_no_conditions() -> None:
    g = ExpressionGraph(2)
    divisor = divisor_of(g, g.param("a_1", 0.3), Tolerances())
    assert divisor.regular is None and divisor.clear is None
    assert divisor.above(g, 0.5) is None


def test_a_square_root_may_be_a_little_outside_its_domain_more_where_digits_were_lost() -> None:
    g = ExpressionGraph(4)
    value = given(g, [-1e-13, -1e-6, -1e-6, -1.0])
    rough = g.binary("gt", given(g, [0.0, 0.0, 1.0, 1.0]), g.zero)
    plain = Tolerances().guard(g, value, 1.0)
    wide = replace(Tolerances(), rough=rough).guard(g, value, 1.0)
    assert list(plain.probe) == [1.0, 0.0, 0.0, 0.0]
    assert list(wide.probe) == [1.0, 0.0, 1.0, 0.0]
    for size in (1e-4, 1e4):  # of what the root is taken of
        scaled = given(g, size * value.probe)
        assert list(Tolerances().guard(g, scaled, size).probe) == list(plain.probe)
        found = replace(Tolerances(), rough=rough).guard(g, scaled, size)
        assert list(found.probe) == list(wide.probe)


def test_branches_start_apart_only_where_rows_are_refined() -> None:
    g = ExpressionGraph(2)
    value = given(g, [0.5, -0.1])
    assert at_least(g, value, g.zero) is value
    assert list(at_least(g, value, g.const(0.2)).probe) == [0.5, 0.2]
    exact, rounded = (Tolerances.for_model_error(x) for x in (0.1 * ROUNDED, 1e-4))
    assert exact.fold == 0.0 < rounded.fold
    assert rounded.clamp > 1e-4 > Tolerances.for_model_error(0.0).clamp


def test_directions_that_the_file_turns_count_as_of_a_continuum() -> None:
    g, error = ExpressionGraph(len(SHARES)), 2e-4
    tolerances = Tolerances.for_model_error(error)
    plain = divisor_of(g, given(g, SHARES), tolerances)
    norm = leading(g, (given(g, SHARES), g.zero), tolerances)
    for divisor, share in ((plain, 5.0 * error), (norm, 50.0 * error)):
        assert divisor.clear is not None
        assert list(divisor.clear.probe > 0.5) == list(share < SHARES)
    assert Tolerances.for_model_error(1e-9).norm == Tolerances.for_model_error(1e-9).flag == 1e-4


def test_a_root_may_be_as_far_outside_as_an_earlier_one_moved_it() -> None:
    """A geometry that is 1e-5 off moves what follows from a root of 1e-4 by some 1e-3, and by as much more
    as the root's unknown moves it; what is outside by more than half its size is near no solution."""
    value, under = (
        np.array([-8e-3, -8e-3, -2e-4, 2e-3, -2e-1, -0.6]),
        np.array([1e-4, 1.0, 1.0, 1.0, 1e-8, 1e-12]),
    )
    g = ExpressionGraph(len(value))
    tolerances = Tolerances.for_model_error(1e-5)
    plain = tolerances.guard(g, given(g, value), 1.0)
    assert list(plain.probe > 0.5) == [False, False, True, True, False, False]
    after = replace(tolerances, margin=lambda e: given(g, under)).guard(g, given(g, value), 1.0)
    assert list(after.probe > 0.5) == [True, False, True, True, True, False]
    farther = replace(tolerances, margin=lambda e: given(g, under), moved=lambda e: 300.0)
    found = farther.guard(g, given(g, value), 1.0)
    assert list(found.probe > 0.5) == [True, True, True, True, True, False]
    twice = replace(tolerances, margin=lambda e: given(g, under)).guard(
        g, given(g, 2.0 * value), 2.0
    )
    assert list(twice.probe > 0.5) == list(after.probe > 0.5)


def test_a_root_may_be_as_far_outside_as_round_off_of_what_came_before_moved_it() -> None:
    """Of an exact geometry: what loses 1e-13 at random configurations loses 1e-9 behind a root of 1e-8."""
    value, under = np.array([-9e-10, -9e-10, -2e-9]), np.array([1e-8, 1.0, 1e-8])
    g = ExpressionGraph(len(value))
    tolerances = replace(Tolerances.for_model_error(0.0), lost=lambda e: 1e-13)
    plain = tolerances.guard(g, given(g, value), 1.0)
    assert list(plain.probe > 0.5) == [False, False, False]
    after = replace(tolerances, margin=lambda e: given(g, under)).guard(g, given(g, value), 1.0)
    assert list(after.probe > 0.5) == [True, False, False]


def test_sums_of_squares_are_told_by_how_they_are_written() -> None:
    g = ExpressionGraph(3)
    a, b = given(g, np.array([1.0, 2.0, 3.0])), given(g, np.array([2.0, -1.0, 0.5]))
    square = g.add(g.square(a), g.square(b))
    assert sign_of_squares(square) == sign_of_squares(g.mul(g.const(0.5), square)) == 1
    assert sign_of_squares(g.neg(square)) == sign_of_squares(g.mul(g.const(-2.0), square)) == -1
    assert sign_of_squares(g.sub(g.neg(g.square(a)), g.square(b))) == -1
    for neither in (a, g.mul(a, b), g.sub(g.square(a), g.square(b)), g.add(square, b)):
        assert sign_of_squares(neither) == 0
