"""Where an interval of a held joint is expected to end."""

from __future__ import annotations

import math

import pytest

from ikgen.runtime.python.branch_ends import _interpolated


@pytest.mark.parametrize("count", [2, 3, 4])
def test_a_zero_of_values_of_an_inverse_polynomial_is_found(count: int) -> None:
    """x is a polynomial of the value, of as many terms as there are values."""
    terms = [0.7, -0.4, 0.11, 0.05][:count]
    known = [(sum(t * y**k for k, t in enumerate(terms)), y) for y in (-1.3, 0.4, 2.1, 0.9)[:count]]
    assert _interpolated(known) == pytest.approx(0.7, abs=1e-12)


def test_values_that_are_alike_tell_nothing() -> None:
    assert _interpolated([(0.1, 0.5), (0.2, 0.5)]) == math.inf
    assert _interpolated([(0.3, 0.5)]) == 0.3
