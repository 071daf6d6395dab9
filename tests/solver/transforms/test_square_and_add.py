"""The square-and-add transform: what it makes holds, has one unknown, and opens an arm."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.polynomials import polynomial_values
from tests.support.sessions import collected_session
from tests.support.tables import Row, table

from ikgen.algebra import polynomial as poly
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import AngleSplit
from ikgen.equations.probes import make_probes
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
    session = collected_session(table(*rows))
    made = square_and_add.apply(session.equations, session.knowledge)
    assert made
    for e in made:
        assert np.abs(polynomial_values(e.polynomial, session.probes.values)).max() < 1e-9
        assert e.rank == len(e.unknowns) == 1 and len(e.sources) == 2
        assert e.polynomial


def test_it_solves_what_the_rules_alone_do_not() -> None:
    graph = solve_chain(table(*WRIST_FIRST))
    assert not graph.open_joints and graph.sound
    rankers = {t.path[-2]: t.outcome for t in graph.ticks if t.round == 1 and t.node == "ranker"}
    assert rankers == {"rules": "failure", "after square and add": "success"}


def test_coefficients_that_are_turned_drop_the_unknown_out() -> None:
    """`K cos u = P`, `K sin u = Q` with K unknown: `K^2 = P^2 + Q^2`, wherever the two stand."""
    dh = table(("R", "-1", 0.0, 0.0), ("R", "1", 0.3, 0.0), ("R", "-1", 0.1, 0.0))
    probes = make_probes(dh)
    system = EquationSet(ExpressionGraph(len(probes.values)), dh, probes.values, probes.pose)
    knowledge = Knowledge(system)
    g, u, v = system.graph, probes.values[:, 0], probes.values[:, 1]
    k = {((((0, 1, 0), "c"),), ()): g.one}
    K = np.cos(v)

    def known(name: str, values: np.ndarray) -> dict:
        return {poly.ONE: g.atom("pose", name, values, unknown=False)}

    double = poly.scale(g, k, g.const(2.0))
    p, q = known("p", K * np.cos(u)), known("q", 2.0 * K * np.sin(u))
    a = known("a", K * np.cos(u) + K * np.sin(u))
    b = known("b", K * np.cos(u) - K * np.sin(u))
    minus = poly.scale(g, k, g.minus_one)
    for s1, s2, right in (
        (AngleSplit(k, {}, p), AngleSplit({}, double, q), True),
        (AngleSplit({}, double, q), AngleSplit(k, {}, p), True),
        (AngleSplit(k, k, a), AngleSplit(k, minus, b), True),
        (AngleSplit(k, minus, b), AngleSplit(k, k, a), True),
        (AngleSplit(k, k, a), AngleSplit(k, k, a), False),
        (AngleSplit(k, {}, p), AngleSplit(k, {}, p), False),
        (AngleSplit({}, double, q), AngleSplit({}, double, q), False),
        (AngleSplit(k, k, a), AngleSplit(k, {}, p), False),
        (AngleSplit(k, {}, p), AngleSplit(k, k, a), False),
        (AngleSplit(k, {}, p), AngleSplit({}, p, q), False),
    ):
        found = square_and_add._rotated(s1, s2, knowledge)
        assert (found is not None) == right
        if found is not None:
            assert len(found) > 1 and np.abs(polynomial_values(found, probes.values)).max() < 1e-12


TURNS = (Variable("angle", (1, 0, 0)), Variable("angle", (0, 1, 0)))


def three_turns() -> Knowledge:
    dh = table(("R", "-1", 0.0, 0.0), ("R", "1", 0.3, 0.0), ("R", "-1", 0.1, 0.0))
    probes = make_probes(dh)
    return Knowledge(
        EquationSet(ExpressionGraph(len(probes.values)), dh, probes.values, probes.pose)
    )


@pytest.mark.parametrize(
    ("size", "off"), [(1.0, 1e-3), (1e3, 1e-3), (1e3, 1e-8), (1e-3, 1e-8), (1e-3, 1e-3)]
)
def test_coefficients_that_are_all_but_parallel_are_no_pair(size: float, off: float) -> None:
    """However large they are."""
    knowledge = three_turns()
    g = knowledge.graph
    rest = {poly.ONE: g.one}

    def known(value: float) -> dict:
        return {poly.ONE: g.atom("pose", repr(value), np.full(g.probes, value), unknown=False)}

    one = AngleSplit(known(size), known(size), rest)
    two = AngleSplit(known(size), known(size * (1.0 + off * 1e-3)), rest)
    found = square_and_add._known_coefficients(one, two, knowledge)
    assert (found is not None) == (off == 1e-3)


def test_sixty_pairs_of_one_unknown_are_the_most() -> None:
    knowledge = three_turns()
    g, rng = knowledge.graph, np.random.default_rng(0)
    equations = []
    for i in range(12):
        values = {
            (((v.combination, kind),), ()): g.atom("pose", f"{i}{v.text}{kind}", at, unknown=False)
            for v in TURNS
            for kind, at in zip("cs", rng.uniform(0.5, 1.5, (2, g.probes)), strict=True)
        }
        equations.append(PolynomialEquation(values, tuple(sorted(TURNS)), (), 2))
    made = square_and_add.apply(equations, knowledge)
    assert [sum(e.unknowns == (v,) for e in made) for v in TURNS] == [60, 60] and len(made) == 120
