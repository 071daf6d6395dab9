"""Which candidate becomes a step, on candidates constructed to fail at known configurations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.support.constructed import Constructed

from ikgen.algebra.expression import Expr
from ikgen.equations.knowledge import Variable
from ikgen.forms.form import Form
from ikgen.solver.candidate import Candidate
from ikgen.solver.choice import Chooser, Step
from ikgen.solver.ranker import rank_key


@pytest.fixture(scope="module")
def arm() -> Constructed:
    return Constructed()


def choose(
    arm: Constructed, *candidates: Candidate, anything: bool = False, ranked: bool = True
) -> Step | None:
    """The step taken, the candidates ranked first or in the order given."""
    order = sorted(candidates, key=rank_key) if ranked else list(candidates)
    return Chooser(arm.system, arm.probes).choose(order, anything=anything)


def found(arm: Constructed, *forms: Form) -> list[Candidate]:
    """Judged candidates."""
    return [arm.found(form) for form in forms]


def test_the_best_sound_candidate_is_taken_alone(arm: Constructed) -> None:
    weak, sound, dear = found(
        arm, arm.pair(arm.c2), arm.tangent(arm.graph.one), arm.tangent(arm.graph.const(2.0))
    )
    step = choose(arm, weak, sound, dear)
    assert step is not None and step.candidate is sound
    assert step.sound and not step.fallbacks
    assert set(map(id, step.rejected)) == {id(weak), id(dear)}


def test_no_candidates_are_no_step(arm: Constructed) -> None:
    assert choose(arm, anything=True) is None


def test_a_zero_that_no_probe_met_is_found(arm: Constructed) -> None:
    """The factor vanishes where cos(q2) is a third, off every right angle."""
    g = arm.graph
    [hidden] = found(arm, arm.tangent(g.sub(arm.c2, g.const(1.0 / 3.0))))
    assert hidden.is_sound
    assert choose(arm, hidden) is None
    step = choose(arm, hidden, anything=True)
    assert step is not None and not step.sound


def test_a_fallback_covers_where_the_first_fails(arm: Constructed) -> None:
    first, second = found(arm, arm.tangent(arm.c2), arm.tangent(arm.s2))
    assert first.is_weak and second.is_weak
    step = choose(arm, first, second)
    assert step is not None and step.sound
    assert [step.candidate, *step.fallbacks] == sorted([first, second], key=rank_key)


def test_a_fallback_that_fails_at_the_same_place_covers_nothing(arm: Constructed) -> None:
    g = arm.graph
    first, same = found(arm, arm.tangent(arm.c2), arm.tangent(g.mul(arm.c2, arm.s2)))
    assert choose(arm, first, same) is None
    step = choose(arm, first, same, anything=True)
    assert step is not None and not step.fallbacks and not step.sound


def test_two_fallbacks_are_the_most(arm: Constructed) -> None:
    """Four zeros; each candidate holds at one of those where another fails."""
    g = arm.graph
    at = [g.sub(arm.c2, g.const(x)) for x in (-0.7, -0.2, 0.3, 0.8)]

    def factor(*zeros: int) -> Expr:
        product = g.one
        for i in zeros:
            product = g.mul(product, at[i])
        return product

    three = [factor(0, 1, 2), factor(1, 2, 3), factor(0, 2, 3), factor(0, 1, 3)]
    assert choose(arm, *found(arm, *(arm.tangent(f) for f in three))) is None
    two = [factor(0, 1), factor(1, 2), factor(0, 2)]
    step = choose(arm, *found(arm, *(arm.tangent(f) for f in two)))
    assert step is not None and step.sound and len(step.fallbacks) == 2


def test_a_fallback_has_no_more_branches_than_the_first(arm: Constructed) -> None:
    single, double = found(arm, arm.pair(arm.c2), arm.tangent(arm.s2))
    step = choose(arm, single, double)
    assert step is not None and step.sound and step.branches == 2
    assert step.candidate is double and step.fallbacks == (single,)


def test_branches_that_meet_are_taken_before_a_quartic(arm: Constructed) -> None:
    folding, quartic = found(arm, arm.folding(), arm.quartic())
    assert quartic.is_sound and not folding.is_sound
    assert choose(arm, folding, quartic) is None
    step = choose(arm, folding, quartic, anything=True)
    assert step is not None and step.candidate is folding
    assert step.sound  # it loses digits there, no solution


def test_a_quartic_is_taken_before_what_fails(arm: Constructed) -> None:
    weak, quartic = found(arm, arm.tangent(arm.c2), arm.quartic())
    step = choose(arm, weak, quartic, anything=True)
    assert step is not None and step.candidate is quartic and step.sound


def test_what_fails_is_taken_where_there_is_nothing_else_and_is_not_sound(
    arm: Constructed,
) -> None:
    [weak] = found(arm, arm.tangent(arm.c2))
    assert choose(arm, weak) is None
    step = choose(arm, weak, anything=True)
    assert step is not None and step.candidate is weak and not step.sound


def test_two_candidates_of_an_unknown_are_tried_with_fallbacks(arm: Constructed) -> None:
    """The first fails at three places, of which each other holds at one alone."""
    g = arm.graph
    at = [g.sub(arm.c2, g.const(x)) for x in (-0.7, 0.1, 0.8)]
    whole = g.mul(g.mul(at[0], at[1]), at[2])
    pairs = [g.mul(at[0], at[1]), g.mul(at[1], at[2]), g.mul(at[0], at[2])]
    first, *others = found(arm, arm.tangent(whole), *map(arm.tangent, pairs))
    step = choose(arm, first, *others, ranked=False)
    assert step is not None and step.candidate is others[0] and len(step.fallbacks) == 2
    worse = [first, first, *others]
    assert choose(arm, *worse, ranked=False) is None


@pytest.mark.parametrize("hidden", [5, 6])
def test_six_that_fail_where_no_probe_is_are_enough(arm: Constructed, hidden: int) -> None:
    g = arm.graph
    zeros = [g.sub(arm.c2, g.const(0.1 * k + 0.05)) for k in range(hidden)]
    sound, *others = found(arm, arm.tangent(g.one), *map(arm.tangent, zeros))
    step = choose(arm, *others, sound, ranked=False)
    assert step is not None and (step.candidate is sound) == (hidden < 6)
    assert bool(step.fallbacks) == (hidden == 6)


def test_where_branches_meet_is_remembered_by_unknown(arm: Constructed) -> None:
    """One form for two angles, though it is true of the first alone: it folds where that, or the other, is
    the second angle or opposite to it."""
    chooser, first = Chooser(arm.system, arm.probes), arm.candidate(arm.folding())
    other = replace(first, unknown=Variable("angle", (0, 0, 1)))
    for candidate, joint in ((first, 0), (other, 2)):
        at = chooser._weak_at(candidate)
        assert len(at)
        np.testing.assert_allclose(np.sin(at[:, joint] - at[:, 1]), 0.0, atol=2e-3)
