"""Ratios of geared joints as fractions."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ikgen.model.gear_ratio import MOST_PARTS, common_share, is_whole

PARTS = st.integers(1, 2000)


@given(PARTS, PARTS)
def test_a_ratio_of_whole_numbers_is_found(p: int, q: int) -> None:
    assert common_share([1.0, p / q]) == Fraction(p, q).denominator
    assert common_share([1.0, -p / q]) == Fraction(p, q).denominator


@given(st.lists(st.fractions(Fraction(1, 50), 50, max_denominator=50), min_size=1, max_size=3))
def test_all_are_multiples_of_the_share(ratios: list[Fraction]) -> None:
    share = common_share([float(x) for x in ratios])
    assert share == math.lcm(*(x.denominator for x in ratios))
    assert all(is_whole(share * float(x)) for x in ratios)


@pytest.mark.parametrize("decimal", ["1.1393", "0.333333", "1.05851325", "0.72349546", "2.2e-3"])
def test_decimals_of_files(decimal: str) -> None:
    share = common_share([1.0, float(decimal)])
    assert 1 < share <= MOST_PARTS
    turns = share * float(decimal)
    assert abs(turns / round(turns) - 1.0) < 1e-10


def test_what_is_next_to_a_simple_ratio_but_not_it_is_none() -> None:
    assert common_share([1.0, 0.7 + 1e-9]) == 1 and not is_whole(0.7 + 1e-9)
    assert common_share([1.0, 1 / 9973, 1 / 9967]) == 1  # the common multiple is too large
    assert is_whole(0.0) and is_whole(-3.0) and not is_whole(1e-3)
