"""Constants are read as what they are rounded values of."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
import sympy

from ikgen.kinematics.rigid import exact_cos_sin
from ikgen.symbolic.exact_numbers import exact_number


@pytest.mark.parametrize("twelfth", range(-11, 13))
def test_cosines_of_multiples_of_fifteen_degrees(twelfth: int) -> None:
    c, s = (exact_number(x) for x in exact_cos_sin(twelfth * math.pi / 12))
    angle = twelfth * sympy.pi / 12
    assert c.exact and sympy.simplify(c.sympy - sympy.cos(angle)) == 0
    assert s.exact and sympy.simplify(s.sympy - sympy.sin(angle)) == 0


@pytest.mark.parametrize("text", ["0.4318", "1/3", "-7/12", "0.1625", "1000", "0", "0.123456789"])
def test_fractions_and_decimals(text: str) -> None:
    found = exact_number(float(Fraction(text)))
    assert found.exact and found.sympy == sympy.Rational(text)


def test_products_lose_their_round_off() -> None:
    assert exact_number(0.1 * 0.2).sympy == sympy.Rational(1, 50)


def test_what_is_not_recognised_is_said() -> None:
    assert not exact_number(math.pi / 10).exact
    assert not exact_number(math.cos(0.7)).exact
