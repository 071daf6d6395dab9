"""The substitution transform: what it makes holds and has fewer unknowns, and saves an arm its branches."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.polynomials import polynomial_values
from tests.support.sessions import collected_session
from tests.support.tables import Row, table

from ikgen.algebra import polynomial as poly
from ikgen.algebra.polynomial import Polynomial
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.solver.session import Session
from ikgen.solver.solve import solve_chain
from ikgen.solver.transforms import substitution

BRANCHES_TOLD_LATER: tuple[Row, ...] = (
    ("R", "0", 0.0, 0.0), ("P", "0", 0.3, 0.0), ("R", "1", 0.0, 0.1), ("R", "-1", 0.33, 0.0),
)  # fmt: skip
THREE: tuple[Row, ...] = (("R", "0", 0.0, 0.0), ("P", "1", 0.3, 0.0), ("R", "1", 0.1, 0.0))
FIRST, THIRD = Variable("angle", (1, 0, 0)), Variable("angle", (0, 0, 1))


def session_of(rows: tuple[Row, ...]) -> Session:
    return collected_session(table(*rows))


def test_what_it_makes_holds_and_has_fewer_unknowns() -> None:
    session = session_of(BRANCHES_TOLD_LATER)
    collected = session.collected
    made = substitution.apply(collected, session.knowledge)
    assert made[: len(collected)] == collected  # beside which some of the new ones are of use
    new = made[len(collected) :]
    assert any(e.rank == 1 for e in new)
    for e in new:
        assert np.abs(polynomial_values(e.polynomial, session.probes.values)).max() < 1e-9
        assert e.rank == len(e.unknowns) and e.rank <= 2 and len(e.sources) == 2


def test_it_spares_branches_that_another_step_tells() -> None:
    """Where unknowns with branches are not to be the first, all are solved without."""
    dh = table(*BRANCHES_TOLD_LATER)
    assert int(np.prod([s.branches for s in solve_chain(dh).steps])) == 2
    passed = [session_of(BRANCHES_TOLD_LATER).joint_variable(j) for j in (0, 2, 3)]
    graph = solve_chain(dh, passed_over=passed)
    assert not graph.open_joints and graph.sound and all(s.branches == 1 for s in graph.steps)
    rankers = [(t.path[-2], t.outcome) for t in graph.ticks if t.round == 1 and t.node == "ranker"]
    assert rankers[-1] == ("after substitution", "success")


def two_equations(
    one: dict[object, float], other: dict[object, float]
) -> tuple[Knowledge, list[PolynomialEquation]]:
    session = session_of(THREE)
    knowledge, out = session.knowledge, []
    for words in (one, other):
        p: Polynomial = {m: knowledge.graph.const(v) for m, v in words.items()}  # type: ignore[misc]
        unknowns, rank = knowledge.unknowns_of(p)
        out.append(PolynomialEquation(p, unknowns, (), rank))
    return knowledge, out


def cosine(v: Variable) -> object:
    return ((v.combination, "c"),), ()


def sine(v: Variable) -> object:
    return ((v.combination, "s"),), ()


SLID = (), ((1, 1),)


@pytest.mark.parametrize(
    ("one", "other", "left"),
    [
        pytest.param(
            {cosine(FIRST): 1.0, poly.ONE: 0.5}, {cosine(FIRST): 2.0, cosine(THIRD): 1.0},
            {cosine(THIRD): -0.5, poly.ONE: 0.5}, id="an angle",
        ),
        pytest.param(
            {SLID: 3.0, poly.ONE: 0.5}, {SLID: 1.5, sine(THIRD): 1.0},
            {sine(THIRD): -2.0, poly.ONE: 0.5}, id="a slide",
        ),
        pytest.param(
            {cosine(FIRST): 1.0, sine(FIRST): 2.0, SLID: 1.0},
            {cosine(FIRST): 2.0, sine(FIRST): 4.0, poly.ONE: 1.0},
            {SLID: 1.0, poly.ONE: -0.5}, id="both of an angle",
        ),
        pytest.param(
            {cosine(FIRST): 1.0, sine(FIRST): 2.0, SLID: 1.0},
            {cosine(FIRST): 2.0, sine(FIRST): 3.0, poly.ONE: 1.0}, None, id="no multiple",
        ),
        pytest.param(
            {cosine(FIRST): 1.0, SLID: 1.0}, {sine(FIRST): 1.0, poly.ONE: 1.0}, None, id="others",
        ),
        pytest.param(
            {cosine(FIRST): 1.0, SLID: 1.0}, {cosine(FIRST): 1.0, sine(THIRD): 1.0}, None,
            id="as many unknowns",
        ),
        pytest.param(
            {cosine(FIRST): 1.0, poly.ONE: 1.0}, {cosine(FIRST): 1.0, poly.ONE: 2.0}, None,
            id="nothing left",
        ),
    ],
)  # fmt: skip
def test_a_multiple_of_a_part_is_taken_away(
    one: dict[object, float], other: dict[object, float], left: dict[object, float] | None
) -> None:
    knowledge, equations = two_equations(one, other)
    made = substitution.apply(equations, knowledge)
    if left is None:
        assert not made
        return
    assert made[:2] == equations and len(made) == 3
    found = {m: float(value.probe[0]) for m, value in made[2].polynomial.items()}
    scale = found[poly.ONE] / left[poly.ONE]  # either is taken from the other
    assert found == pytest.approx({m: scale * v for m, v in left.items()})  # type: ignore[comparison-overlap]


def test_sixty_pairs_of_one_unknown_are_the_most() -> None:
    knowledge, (long, short) = two_equations(
        {cosine(FIRST): 1.0, cosine(THIRD): 1.0}, {cosine(FIRST): 1.0, poly.ONE: 1.0}
    )
    made = substitution.apply([long] * 20 + [short] * 6, knowledge)
    # 25 pairs of the first, 24 of the second, 11 of the third: six short ones among the first two alone
    assert len(made) == 26 + 12
