"""What is known: equations in what is not hold at the probes, and a workspace is one's own."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.support.polynomials import polynomial_values
from tests.support.tables import table

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.algebra.polynomial import Polynomial
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Knowledge, Variable
from ikgen.equations.probes import make_probes

ARM = table(
    ("R", "0", 0.0, 0.2),
    ("R", "1", 0.1, 0.0),
    ("R", "0", 0.4, 0.0),
    ("P", "1", 0.0, 0.0),
)
"""A waist, two parallel axes, a sliding joint."""
PROBES = make_probes(ARM)
SLIDING = 3


def nothing_known() -> Knowledge:
    """The arm's knowledge before anything was solved."""
    graph = ExpressionGraph(len(PROBES.values))
    knowledge = Knowledge(EquationSet(graph, ARM, PROBES.values, PROBES.pose))
    assert knowledge.equations.equations
    knowledge.refresh()
    return knowledge


def learn(knowledge: Knowledge, variable: Variable) -> None:
    """Take a variable as solved."""
    if variable.kind == "angle":
        knowledge.learn_angle(variable.combination)
    else:
        knowledge.learn_distance(SLIDING)


VARIABLES = (
    Variable("angle", (1, 0, 0, 0)),
    Variable("angle", (0, 1, 0, 0)),
    Variable("angle", (0, 0, 1, 0)),
    Variable("angle", (0, 1, 1, 0)),
    Variable("prismatic", (0, 0, 0, 1)),
)


def value(polynomial: Polynomial) -> np.ndarray:
    """A polynomial's values at the probes."""
    return polynomial_values(polynomial, PROBES.values)


@settings(max_examples=12, deadline=None)
@given(st.sets(st.sampled_from(VARIABLES), max_size=3))
def test_equations_hold_and_name_only_what_is_open(solved: set[Variable]) -> None:
    k = nothing_known()
    for variable in sorted(solved):
        learn(k, variable)
    for equation in k.equations.equations:
        p = k.polynomial_equation(equation)
        assert np.abs(value(p.polynomial)).max() < 1e-9
        assert not [v for v in p.unknowns if k.is_known(v)]
        assert p.rank <= len(p.unknowns)
        assert all(k.known_expr(c) for c in p.polynomial.values())
        if k.known_expr(equation.left) and k.known_expr(equation.right):
            assert not p.unknowns and not p.rank


def test_a_solved_angle_makes_its_sums_linear_in_the_other() -> None:
    k = nothing_known()
    k.learn_angle((0, 0, 1, 0))
    c23 = k.variables.pair((0, 1, 1, 0))[0]
    reduced = k.reduce(k.convert(c23))
    assert {trigs[0][0] for trigs, _ in reduced} == {(0, 1, 0, 0)}
    np.testing.assert_allclose(value(reduced), c23.probe, atol=1e-12)


def test_the_last_angle_of_a_sum_follows() -> None:
    k = nothing_known()
    c2 = k.variables.pair((0, 1, 0, 0))[0]
    k.learn_angle((0, 1, 1, 0))
    assert not k.is_known(VARIABLES[1]) and not k.known_expr(c2)
    k.learn_angle((0, 0, 1, 0))
    assert k.is_known(VARIABLES[1]) and k.known_expr(c2)
    assert set(k.composition((0, 1, 0, 0))) == {(1, (0, 1, 1, 0)), (-1, (0, 0, 1, 0))}
    np.testing.assert_allclose(k.binding[c2.id].probe, c2.probe, atol=1e-12)


@pytest.mark.parametrize(("mine", "others"), [(VARIABLES[0], VARIABLES[4]), VARIABLES[4:0:-1][:2]])
def test_a_workspace_and_its_origin_learn_apart(mine: Variable, others: Variable) -> None:
    k = nothing_known()
    equations = k.equations.equations
    before = [k.polynomial_equation(e) for e in equations]
    work = k.workspace()
    count = k.graph.const(1234.5).id
    learn(work, others)
    changed = [work.polynomial_equation(e) for e in work.equations.equations]
    assert work.is_known(others) and not k.is_known(others)
    assert not k.known_mask and not k.binding
    after = [k.polynomial_equation(e) for e in equations]
    assert after == before != changed
    assert k.graph.const(2345.5).id == count + 1
    learn(k, mine)
    assert k.is_known(mine) and not work.is_known(mine)


def test_definitions_found_in_a_workspace_stay_there() -> None:
    k = nothing_known()
    c2 = k.variables.pair((0, 1, 0, 0))[0]
    work = k.workspace()
    for key in ((0, 1, 1, 0), (0, 0, 1, 0)):
        work.learn_angle(key)
    assert c2.id in work.binding and not k.binding
    assert work.known_expr(c2) and not k.known_expr(c2)


def test_a_workspace_starts_with_what_is_known() -> None:
    k = nothing_known()
    for variable in VARIABLES[2:]:
        learn(k, variable)
    work = k.workspace()
    assert work.known_mask == k.known_mask and work.binding == k.binding
    assert [v for v in VARIABLES if work.is_known(v)] == list(VARIABLES[1:])
    assert work.graph is not k.graph
    assert work.variables.graph is work.equations.graph is work.graph


def test_indices_of_sums_are_names_and_tell_them_apart() -> None:
    sums = [(0, 1, 1, 0), (0, 1, -1, 0), (0, 2, -1, 0), (0, 1, 0, -3), (0, 0, 1, 0)]
    names = [Variable("angle", one).index for one in sums]
    assert names == ["23", "2_minus_3", "2x2_minus_3", "2_minus_3x4", "3"]
