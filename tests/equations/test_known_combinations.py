"""Combinations that follow from many solved ones."""

from __future__ import annotations

from ikgen.algebra.polynomial import AngleCombination
from ikgen.equations.known_combinations import KnownCombinations

COUNT = 40


def unit(joint: int) -> AngleCombination:
    return tuple(int(j == joint) for j in range(COUNT))


def test_many_solved_angles_of_one_group_are_not_listed() -> None:
    """Forty of them have 5^40 combinations."""
    known = KnownCombinations([unit(j) for j in range(COUNT)], (0,) * COUNT)
    whole = (1,) * COUNT
    assert known[whole] == tuple((1, unit(j)) for j in range(COUNT))
    assert (3,) + (0,) * (COUNT - 1) not in known


def test_dependent_solved_angles_give_the_fewest_terms() -> None:
    total = (1, 1) + (0,) * (COUNT - 2)
    known = KnownCombinations([unit(0), unit(1), total], (0,) * COUNT)
    assert known[total] == ((1, total),)
    assert known[(2, 1) + (0,) * (COUNT - 2)] == ((1, unit(0)), (1, total))
    assert known[(1, 0) + (0,) * (COUNT - 2)] == ((1, unit(0)),)


def test_nothing_follows_in_a_group_without_solved_angles() -> None:
    known = KnownCombinations([unit(0)], (*[0] * 20, *[1] * 20))
    assert unit(0) in known and unit(1) not in known and unit(30) not in known
    assert known[(0,) * COUNT] == ()


def test_larger_factors_are_taken_where_they_are_asked_for() -> None:
    thrice = (3,) + (0,) * (COUNT - 1)
    assert KnownCombinations([unit(0)], (0,) * COUNT, 3)[thrice] == ((3, unit(0)),)
    assert thrice not in KnownCombinations([unit(0)], (0,) * COUNT)
