"""The square-and-add transform: what it makes holds, has one unknown, and opens an arm."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.polynomials import polynomial_values
from tests.support.tables import Row, table

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Knowledge
from ikgen.equations.probes import make_probes
from ikgen.solver.session import Session
from ikgen.solver.solve import solve_chain
from ikgen.solver.transforms import square_and_add

WRIST_FIRST: tuple[Row, ...] = (
    ("R", "-1", 0.0, 0.0), ("R", "1", 0.0, 0.0), ("R", "-1", 0.1, 0.0), ("R", "0", 0.3, 0.0),
)  # fmt: skip
FOUR: tuple[Row, ...] = (
    ("R", "-1", 0.0, 0.0), ("R", "1", 0.3, 0.0), ("R", "-1", 0.0, 0.1), ("R", "1", 0.2, 0.0),
)  # fmt: skip


@pytest.mark.parametrize("rows", [WRIST_FIRST, FOUR])
def test_what_it_makes_holds_and_has_one_unknown(rows: tuple[Row, ...]) -> None:
    dh = table(*rows)
    probes = make_probes(dh)
    system = EquationSet(ExpressionGraph(len(probes.values)), dh, probes.values, probes.pose)
    _ = system.equations
    session = Session(system, probes, Knowledge(system))
    session.start()
    session.collect()
    made = square_and_add.apply(session.equations, session.knowledge)
    assert made
    for e in made:
        assert np.abs(polynomial_values(e.polynomial, probes.values)).max() < 1e-9
        assert e.rank == len(e.unknowns) == 1 and len(e.sources) == 2
        assert e.polynomial


def test_it_solves_what_the_rules_alone_do_not() -> None:
    graph = solve_chain(table(*WRIST_FIRST))
    assert not graph.open_joints and graph.sound
    rankers = {t.path[-2]: t.outcome for t in graph.ticks if t.round == 1 and t.node == "ranker"}
    assert rankers == {"rules": "failure", "after square and add": "success"}
