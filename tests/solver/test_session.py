"""What a session remembers of its steps: what is computed already, and for how many branches."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest
from tests.support.constructed import Constructed
from tests.support.tables import table

from ikgen.equations.knowledge import Knowledge, Variable
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import Leaf
from ikgen.solver.session import Session, first_fork
from ikgen.solver.solve import solve_chain

FIRST, SECOND = Variable("angle", (1, 0, 0)), Variable("angle", (0, 1, 0))


def session_of(arm: Constructed) -> Session:
    session = Session(arm.system, arm.probes, Knowledge(arm.system))
    session.start()
    session.equations = [SimpleNamespace(unknowns=(FIRST,))]  # type: ignore[list-item]
    return session


def leaf(candidate: Candidate) -> Leaf:
    """One that always finds this."""
    return Leaf("found", lambda equations, unknown, knowledge: [candidate])


def costs(session: Session, one: Leaf) -> list[float]:
    session.candidates = []
    assert session.try_leaf(one) == len(session.candidates) == 1
    return [c.judgement.cost for c in session.candidates if c.judgement is not None]


def test_what_a_step_computes_costs_nothing_afterwards() -> None:
    arm = Constructed()
    g = arm.graph
    inner = g.add(arm.c2, g.const(3.0))
    first = leaf(arm.candidate(arm.tangent(inner)))
    other = leaf(arm.candidate(arm.tangent(g.mul(inner, inner))))
    session = session_of(arm)
    assert costs(session, other) == [4.0] and costs(session, first) == [3.0]
    step = session.choose()
    assert step is not None and session.steps == [step] and step.branches == 2
    assert costs(session, first) == [0.0]
    assert all(cost > 0.0 for cost in costs(session, other))


def test_what_a_later_step_needs_costs_as_often_as_it_branches() -> None:
    session = session_of(Constructed())
    session._forks = [(0b001, 2.0), (0b010, 2.0), (0b100, 8.0)]
    weights = {support: session.weight_of(support) for support in (0, 1, 2, 3, 4, 5, 8)}
    assert weights == {0: 1.0, 1: 2.0, 2: 2.0, 3: 2.0, 4: 8.0, 5: 8.0, 8: 1.0}


def test_only_what_has_branches_makes_more_of_them() -> None:
    arm = Constructed()
    session = session_of(arm)
    for make, unknown, level in (
        (arm.tangent, FIRST, 2.0),
        (arm.pair, FIRST, 2.0),
        (arm.tangent, SECOND, 4.0),
    ):
        made = arm.found(make(arm.graph.one))
        session.candidates = [replace(made, unknown=unknown)]
        assert session.choose(anything=True) is not None
        assert session._forks[-1][1] == level
    known = session._forks[0][0] & session._forks[2][0]
    assert not known and session._forks[0][0] and session._forks[2][0]


def test_the_first_unknown_with_branches_may_be_passed_over() -> None:
    arm = Constructed()
    session = session_of(arm)
    session.passed_over = (FIRST,)
    session.candidates = [arm.found(arm.tangent(arm.graph.one))]
    assert session.choose(anything=True) is None and first_fork(session.steps) is None
    session.candidates.append(arm.found(arm.pair(arm.graph.one)))
    step = session.choose()
    assert step is not None and step.branches == 1 and first_fork(session.steps) is None
    session.candidates = [replace(arm.found(arm.tangent(arm.graph.one)), unknown=SECOND)]
    assert session.choose(anything=True) is not None
    assert first_fork(session.steps) == SECOND


@pytest.fixture(scope="module")
def planar() -> object:
    return solve_chain(table(("R", "0", 0.0, 0.0), ("R", "0", 0.5, 0.0), ("R", "0", 0.4, 0.0)))


def test_graphs_are_told_and_compared_without_what_is_known(planar) -> None:
    assert ", _known=" not in repr(planar) and ", open_joints=" in repr(planar)
    assert replace(planar, _known=planar.workspace()) == planar
    assert replace(planar, passed=(*planar.passed, FIRST)) != planar
