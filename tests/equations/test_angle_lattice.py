"""The lattice of known angles: what follows from solved ones, and what the rest is written on."""

from __future__ import annotations

import itertools
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.support.tables import geared, table

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.algebra.polynomial import AngleCombination, canonical
from ikgen.equations.angle_lattice import AngleLattice
from ikgen.equations.known_combinations import Terms
from ikgen.equations.variables import JointVariables

ARM = table(
    ("R", "0", 0.0, 0.1),
    ("R", "0", 0.4, 0.0),
    ("R", "0", 0.3, 0.0),
    ("R", "1", 0.2, 0.0),
    ("P", "1", 0.0, 0.0),
)
"""Three parallel axes, one across, a sliding joint."""
GROUPS = ((0, 1, 2), (3,))
ANGLES = np.random.default_rng(0).uniform(-3.0, 3.0, (6, ARM.dof))
SMALL = st.integers(-1, 1)


@st.composite
def keys(draw: st.DrawFn) -> AngleCombination:
    """A combination of the angles of one group."""
    group = draw(st.sampled_from(GROUPS))
    parts = draw(st.tuples(*(SMALL for _ in group)).filter(any))
    return canonical(tuple(dict(zip(group, parts, strict=True)).get(j, 0) for j in range(5)))[0]


SOLVED = st.lists(keys(), max_size=3, unique=True)


def lattice_of(solved: list[AngleCombination]) -> AngleLattice:
    """The lattice where `solved` are known."""
    graph = ExpressionGraph(len(ANGLES))
    lattice = AngleLattice(graph, JointVariables(graph, ARM, ANGLES))
    for combination in solved:
        lattice.add(combination)
    lattice.rebuild()
    return lattice


def test_multiples_of_a_geared_angle_stay_multiples_of_it() -> None:
    """3v is the sum of all but for u + v + w, too, where u + 4v + w is known."""
    graph = ExpressionGraph(len(ANGLES))
    arm = geared(table(*[("R", "0", 0.3, 0.0)] * 4))
    lattice = AngleLattice(graph, JointVariables(graph, arm, ANGLES[:, :3]))
    lattice.add((1, 4, 1))
    lattice.rebuild()
    for times in (2, 3, 4):
        assert lattice.represent((0, times, 0)) == (times, (0, 1, 0), (0, 0, 0))


def test_what_would_leave_parts_of_a_turn_is_told() -> None:
    """2u leaves u but for half a turn, and so do u + v and u - v; u + v and v leave nothing."""
    assert lattice_of([]).leaves_parts((2, 0, 0, 0, 0))
    assert not lattice_of([]).leaves_parts((1, 1, 0, 0, 0))
    one = lattice_of([(1, 1, 0, 0, 0)])
    assert not one.leaves_parts((0, 1, 0, 0, 0))
    assert one.leaves_parts((1, -1, 0, 0, 0))
    assert one.leaves_parts((5, 1, 0, 0, 0)) and not one.leaves_parts((0, 0, 0, 1, 0))
    assert not lattice_of([(1, 0, 0, 0, 0)]).leaves_parts((2, 1, 0, 0, 0))


def rank_by_hand(combinations: list[AngleCombination]) -> int:
    """Rank over the rationals, by elimination."""
    rows = [[Fraction(k) for k in combination] for combination in combinations]
    rank = 0
    for column in range(5):
        pivot = next((r for r in rows[rank:] if r[column]), None)
        if pivot is None:
            continue
        rows.remove(pivot)
        rows.insert(rank, pivot)
        for r in rows[rank + 1 :]:
            factor = r[column] / pivot[column]
            r[:] = [a - factor * b for a, b in zip(r, pivot, strict=True)]
        rank += 1
    return rank


def listed(solved: list[AngleCombination]) -> dict[AngleCombination, Terms]:
    """All that follows from `solved` with its pairs, group by group, small factors first."""
    found: dict[AngleCombination, Terms] = {(0,) * 5: ()}
    by_group: dict[bool, list[AngleCombination]] = {}
    for combination in solved:
        by_group.setdefault(bool(combination[3]), []).append(combination)
    for mine in by_group.values():
        choices = itertools.product(range(-2, 3), repeat=len(mine))
        for factors in sorted(choices, key=lambda c: (sum(map(abs, c)), c)):
            pairs = list(zip(factors, mine, strict=True))
            total = tuple(sum(f * k[j] for f, k in pairs) for j in range(5))
            found.setdefault(total, tuple((f, k) for f, k in pairs if f))
    return found


def candidates() -> list[AngleCombination]:
    """All combinations of each group with factors from -3 to 3."""
    three = [(*c, 0, 0) for c in itertools.product(range(-3, 4), repeat=3)]
    return [*three, *((0, 0, 0, k, 0) for k in range(-3, 4))]


@settings(deadline=None)
@given(SOLVED)
def test_known_is_what_small_combinations_of_solved_ones_give(
    solved: list[AngleCombination],
) -> None:
    known = lattice_of(solved).known
    follow = listed(solved)
    for combination in candidates():
        assert known.get(combination) == follow.get(combination)
    for combination, terms in follow.items():
        assert known[combination] == terms
    assert sorted(filter(any, follow), key=known.order) == list(filter(any, follow))
    for group in GROUPS:
        mine = [combination for combination in solved if any(combination[j] for j in group)]
        for factors in itertools.product(range(-2, 3), repeat=len(mine)):
            total = sum((f * np.array(k) for f, k in zip(factors, mine, strict=True)), np.zeros(5))
            assert tuple(int(x) for x in total) in known


@settings(deadline=None)
@given(SOLVED, st.lists(keys(), min_size=1, max_size=4))
def test_pairs_are_the_cosine_and_sine(
    solved: list[AngleCombination], asked: list[AngleCombination]
) -> None:
    lattice = lattice_of(solved)
    for combination in (*listed(solved), *asked):
        pair = lattice.pair(combination)
        assert (pair is not None) == (combination in lattice.known)
        if pair is not None:
            angle = ANGLES @ np.array(combination)
            np.testing.assert_allclose(pair[0].probe, np.cos(angle), atol=1e-12)
            np.testing.assert_allclose(pair[1].probe, np.sin(angle), atol=1e-12)


@settings(deadline=None)
@given(SOLVED, keys())
def test_an_unknown_angle_is_a_representative_and_a_known_shift(
    solved: list[AngleCombination], combination: AngleCombination
) -> None:
    lattice = lattice_of(solved)
    if combination in lattice.known:
        return
    factor, representative, shift = lattice.represent(combination)
    assert np.array_equal(factor * np.array(representative) + np.array(shift), combination)
    assert shift in lattice.known
    assert representative not in lattice.known
    assert lattice.represent(combination) == (factor, representative, shift)


def test_sums_with_a_solved_angle_are_written_on_the_joint_s_own() -> None:
    lattice = lattice_of([(0, 0, 1, 0, 0)])
    own = (0, 1, 0, 0, 0)
    assert lattice.represent((0, 1, 1, 0, 0)) == (1, own, (0, 0, 1, 0, 0))
    assert lattice.represent((0, 1, -1, 0, 0)) == (1, own, (0, 0, -1, 0, 0))
    assert lattice.represent((0, 2, 1, 0, 0)) == (2, own, (0, 0, 1, 0, 0))


def test_a_multiple_too_large_to_be_known_stands_for_itself() -> None:
    key = (0, 0, 0, 4, 0)
    lattice = lattice_of([(0, 0, 0, 1, 0)])
    assert key not in lattice.known
    assert lattice.represent(key) == (1, key, (0, 0, 0, 0, 0))


@settings(deadline=None)
@given(SOLVED, st.lists(keys(), max_size=4))
def test_the_rank_counts_what_solved_ones_leave_open(
    solved: list[AngleCombination], asked: list[AngleCombination]
) -> None:
    expected = rank_by_hand([*solved, *asked]) - rank_by_hand(solved)
    assert lattice_of(solved).rank(asked) == expected


@pytest.mark.parametrize("combination", [(1, 0, 0, 0, 0), (0, 1, 1, 0, 0)])
def test_a_lattice_over_another_graph_learns_by_itself(combination: AngleCombination) -> None:
    lattice = lattice_of([(0, 0, 0, 1, 0)])
    graph = ExpressionGraph(len(ANGLES))
    other = lattice.over(graph, JointVariables(graph, ARM, ANGLES))
    other.represent(combination)
    other.add(combination)
    other.rebuild()
    assert (
        combination in other.known
        and combination not in lattice.known
        and combination not in lattice.solved
    )
    lattice.add((1, 1, 0, 0, 0))
    lattice.rebuild()
    assert (1, 1, 0, 0, 0) not in other.known


@pytest.mark.parametrize("ratio", [1, -2, 3, 7, -180, 10000])
def test_angles_that_follow_fast_are_known_with_their_driver(ratio: int) -> None:
    """Axis 2 turns `ratio` times as far as axis 1, parallel to it."""
    driven = replace(ARM.rows[1], driver=0, scale=float(ratio))
    rows = (ARM.rows[0], driven, *(replace(row, driver=i) for i, row in enumerate(ARM.rows[2:], 1)))
    dh = replace(ARM, rows=rows, joints=(ARM.joints[0], *ARM.joints[2:]))
    graph, angles = ExpressionGraph(len(ANGLES)), ANGLES[:, :4]
    variables = JointVariables(graph, dh, angles)
    lattice = AngleLattice(graph, variables)
    lattice.add((1, 0, 0, 0))
    lattice.rebuild()
    for factor in (ratio, 1 + ratio):
        pair = lattice.pair((factor, 0, 0, 0))
        assert pair is not None
        wanted = np.cos(factor * angles[:, 0]), np.sin(factor * angles[:, 0])
        assert np.abs(np.array([e.probe for e in pair]) - wanted).max() < 1e-15 * (20 + abs(ratio))
    most = 2 if abs(ratio) < 2 else abs(ratio) + 4
    assert variables.largest_factor == most
    assert lattice.pair((most + 1, 0, 0, 0)) is None
