"""What expressions are computed from, each once, through what atoms stand for."""

from __future__ import annotations

import numpy as np
from tests.support.probed import given

from ikgen.algebra.dependencies import dependencies
from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph

G = ExpressionGraph(3)
POSE = given(G, np.array([0.3, 0.5, 0.7]))
SOLVED = given(G, np.array([0.2, 0.4, 0.9]))
VALUE = G.square(POSE)
NEXT = G.mul(SOLVED, POSE)


def ids(found: list[Expr]) -> list[int]:
    return sorted(one.id for one in found)


def test_each_is_given_once_through_what_an_atom_stands_for() -> None:
    found = list(dependencies([NEXT, VALUE], {SOLVED.id: VALUE}))
    assert ids(found) == ids([NEXT, SOLVED, VALUE, POSE])


def test_an_atom_without_a_definition_follows_from_nothing() -> None:
    assert ids(list(dependencies([NEXT], {}))) == ids([NEXT, SOLVED, POSE])


def test_what_the_known_follow_from_is_left_out() -> None:
    definition = {SOLVED.id: VALUE}
    found = list(dependencies([G.square(SOLVED)], definition, {SOLVED.id}))
    assert ids(found) == ids([G.square(SOLVED), SOLVED])
