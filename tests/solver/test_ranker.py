"""Judgements of constructed candidates, and the order of ranks."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from tests.support.constructed import Constructed

from ikgen.equations.knowledge import Variable
from ikgen.forms.pair_form import LinearPair
from ikgen.forms.sine_cosine_form import SineCosine
from ikgen.forms.tangent_form import Tangent
from ikgen.solver.candidate import Candidate, Judgement
from ikgen.solver.leaves import LEAVES
from ikgen.solver.ranker import judge, rank_key, why_not

GOOD = Judgement(weak=False, folds=False, margin=1.0, fragile=0.0, cost=10.0)


@pytest.fixture(scope="module")
def arm() -> Constructed:
    return Constructed()


def test_what_does_not_reproduce_the_probes_is_dropped(arm: Constructed) -> None:
    one = arm.graph.one
    right = arm.tangent(one)
    assert arm.judged(arm.candidate(right)) is not None
    assert arm.judged(arm.candidate(Tangent(right.y, right.x))) is None
    almost = Tangent(arm.graph.add(arm.c1, arm.graph.const(1e-3)), arm.s1)
    assert arm.judged(arm.candidate(almost)) is None


def test_what_is_right_at_half_of_the_probes_is_dropped(arm: Constructed) -> None:
    one = arm.graph.one
    pair = arm.pair(one)
    half = replace(pair, c1=arm.graph.unary("abs", arm.c1))
    assert arm.judged(arm.candidate(pair)) is not None
    assert arm.judged(arm.candidate(half)) is None


def test_either_branch_may_be_the_truth(arm: Constructed) -> None:
    backwards = arm.tangent(arm.graph.minus_one)
    assert arm.judged(arm.candidate(backwards)) is not None
    assert arm.judged(arm.candidate(arm.pair(arm.graph.minus_one))) is not None


def test_a_divisor_that_vanishes_everywhere_is_none(arm: Constructed) -> None:
    g = arm.graph
    nothing = g.sub(g.add(g.square(arm.c2), g.square(arm.s2)), g.one)
    assert nothing is not g.zero and nothing.vanishes
    assert arm.judged(arm.candidate(arm.tangent(nothing))) is None


@pytest.mark.parametrize(
    ("apart", "weak"), [(0.3, False), (1e-2, False), (1e-5, True), (0.0, True)]
)
def test_a_quartic_whose_roots_lie_in_pairs_is_weak(
    arm: Constructed, apart: float, weak: bool
) -> None:
    judged = arm.found(arm.paired(apart), leaf="quartic")
    assert judged.is_weak == weak and judged.judgement is not None
    assert judged.judgement.margin > 0.1


def test_a_divisor_that_vanishes_at_right_angles_is_weak(arm: Constructed) -> None:
    strong, weak = arm.found(arm.tangent(arm.graph.one)), arm.found(arm.tangent(arm.c2))
    assert strong.judgement is not None and weak.judgement is not None
    assert not strong.is_weak and strong.is_sound and strong.judgement.margin > 0.1
    assert weak.is_weak and not weak.is_sound and weak.judgement.margin < 1e-6


def test_branches_that_meet_at_a_regular_configuration_fold(arm: Constructed) -> None:
    folding = arm.found(arm.folding())
    assert folding.judgement is not None and folding.judgement.folds
    assert not folding.is_weak and not folding.is_sound


def test_cost_counts_what_is_new_for_each_branch(arm: Constructed) -> None:
    g = arm.graph
    factor = g.add(arm.c2, g.const(3.0))
    candidate = arm.candidate(arm.tangent(factor))

    def cost(used: set[int], weight: dict[int, float]) -> float:
        judged = judge(
            candidate, arm.truth, arm.probes, used, lambda support: weight.get(support, 1.0)
        )
        assert judged is not None and judged.judgement is not None
        return judged.judgement.cost

    products = [e.support for e in candidate.coefficients]
    assert cost(set(), {}) == 3.0
    assert cost({factor.id}, {}) == 2.0
    assert cost({factor.id}, dict.fromkeys(products, 4.0)) == 8.0
    assert cost({e.id for e in candidate.coefficients}, {}) == 0.0


def ranked(arm: Constructed, **changes: object) -> Candidate:
    """A sound tangent candidate, with other judgements."""
    return replace(arm.candidate(arm.tangent(arm.graph.one)), judgement=replace(GOOD, **changes))


def test_soundness_comes_before_branches_these_before_leaf_this_before_cost(
    arm: Constructed,
) -> None:
    one = arm.graph.one
    single = replace(arm.candidate(arm.pair(one), "quadratic"), judgement=replace(GOOD, cost=99.0))
    linear = SineCosine(one, arm.graph.zero, arm.c1)
    other = replace(arm.candidate(linear, "sine or cosine"), judgement=replace(GOOD, cost=0.0))
    assert (single.branches, other.branches) == (1, 2)
    order = [
        single,
        ranked(arm, cost=8.0),
        ranked(arm, cost=9.0),
        ranked(arm, fragile=0.4, cost=1.0),
        other,
        replace(arm.candidate(arm.quartic(), "quartic"), judgement=GOOD),
        replace(single, judgement=replace(GOOD, weak=True)),
        ranked(arm, folds=True, cost=0.0),
    ]
    combinations = [rank_key(c) for c in order]
    assert all(a < b for a, b in pairwise(combinations))


def test_leaves_come_in_the_order_of_preference_strangers_last(arm: Constructed) -> None:
    base = ranked(arm)
    names = [name for leaf in LEAVES for name in leaf.finds]
    assert names.index("tangent") < names.index("sine or cosine") < names.index("x2y2")
    names.append("of another package")
    combinations = [rank_key(replace(base, leaf=name)) for name in names]
    assert all(a < b for a, b in pairwise(combinations))


def test_what_is_a_tangent_but_for_rounding_ranks_as_one(arm: Constructed) -> None:
    plain = replace(arm.candidate(arm.folding(), "x2y2"), judgement=GOOD)
    almost = replace(plain, judgement=replace(GOOD, almost_tangent=True))
    sine = replace(plain, leaf="sine or cosine")
    assert rank_key(almost) < rank_key(sine) < rank_key(plain)


def test_sums_of_squares_are_avoided_where_one_branch_needs_none(arm: Constructed) -> None:
    one = arm.graph.one
    plain = replace(arm.candidate(arm.pair(one)), judgement=replace(GOOD, cost=90.0))
    squared = replace(arm.candidate(arm.pair(one), squared=True), judgement=GOOD)
    assert rank_key(plain) < rank_key(squared)
    both = [
        replace(arm.candidate(arm.tangent(one), squared=s), judgement=GOOD) for s in (False, True)
    ]
    assert rank_key(both[0]) == rank_key(both[1])


def test_a_thin_determinant_comes_behind_a_length_squared(arm: Constructed) -> None:
    g = arm.graph
    length = LinearPair(arm.c2, arm.s2, arm.c1, g.neg(arm.s2), arm.c2, arm.s1)
    plain = replace(length, b2=arm.s1)
    assert plain.is_determinant and not length.is_determinant
    for margin, better in ((0.01, length), (0.5, plain)):
        costs = {length: 20.0, plain: 10.0}
        candidates = [
            replace(
                arm.candidate(form, "simultaneous"),
                judgement=replace(GOOD, margin=margin, cost=cost),
            )
            for form, cost in costs.items()
        ]
        assert min(candidates, key=rank_key).form is better


def test_the_order_does_not_depend_on_chance(arm: Constructed) -> None:
    base = ranked(arm)
    second = replace(base, unknown=Variable("angle", (0, 1, 0)))
    assert rank_key(base) < rank_key(second)
    other = replace(base, form=arm.tangent(arm.s2))
    assert rank_key(base) != rank_key(other)
    assert np.all([isinstance(x, int) for x in rank_key(base)[-1]])


def test_what_is_wrong_with_a_candidate_is_where_it_ranks_behind(arm: Constructed) -> None:
    g, one = arm.graph, arm.graph.one
    base = ranked(arm)
    pair = replace(arm.candidate(arm.pair(one)), judgement=GOOD)
    determinant = replace(
        LinearPair(arm.c2, arm.s2, arm.c1, g.neg(arm.s2), arm.c2, arm.s1), b2=g.one
    )
    thin = replace(GOOD, margin=0.01, cost=1.0)
    for other, best, words in (
        (replace(base, judgement=replace(GOOD, weak=True)), base, "fails or folds"),
        (ranked(arm, cost=1.0), pair, "more branches"),
        (replace(base, leaf="quadratic", judgement=replace(GOOD, cost=1.0)), base, "less direct"),
        (ranked(arm, fragile=0.4, cost=1.0), base, "at more singular"),
        (replace(pair, form=determinant, judgement=thin), pair, "nearly zero"),
        (replace(arm.candidate(arm.pair(one), squared=True), judgement=thin), pair, "squared"),
        (ranked(arm, cost=11.0), base, "more to compute"),
        (replace(base, unknown=Variable("angle", (0, 1, 0))), base, "equal"),
        (base, base, "equal"),
    ):
        assert words in why_not(other, best)


def test_what_ranks_before_the_one_taken_was_passed_over(arm: Constructed) -> None:
    base, folding = ranked(arm), ranked(arm, folds=True)
    assert "not found to hold" in why_not(base, folding)
    quartic = replace(arm.candidate(arm.quartic(), "quartic"), judgement=GOOD)
    assert rank_key(quartic) < rank_key(folding)
    assert why_not(quartic, folding) == "more branches"
