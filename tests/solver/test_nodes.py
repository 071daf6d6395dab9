"""Nodes of the tree and leaves on equations made by hand."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from tests.support.probed import given

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations import matching
from ikgen.equations.knowledge import Variable
from ikgen.solver.behavior_tree import collect
from ikgen.solver.leaves import simultaneous

UNKNOWN = Variable("angle", (1, 0))


@pytest.mark.parametrize("count", [0, 1, 3])
def test_collecting_fails_without_an_equation(count: int) -> None:
    asked = []
    session = SimpleNamespace(collect=lambda: asked.append(1), equations=[None] * count)
    assert collect(session) == (count > 0, f"{count} equations with one or two unknowns")
    assert asked == [1]


def found(monkeypatch: pytest.MonkeyPatch, double: bool, alike: bool) -> list[tuple[str, ...]]:
    """Sources of the pairs out of three equations in one angle, the last with the double angle too where
    that is asked for, the first two multiples of each other where that is."""
    g = ExpressionGraph(4)
    rng = np.random.default_rng(0)
    rows = rng.uniform(0.5, 1.5, (3, 3, 4))
    if alike:
        rows[1, :2] = 2.0 * rows[0, :2]
    terms = [
        {key: given(g, row[i]) for i, key in enumerate(((1, "c"), (1, "s"), (0, "c")))}
        for row in rows
    ]
    if double:
        terms[2][2, "c"] = given(g, rows[0, 0])
    equations = [SimpleNamespace(unknowns=(UNKNOWN,), sources=(name,)) for name in "abc"]
    equations.append(SimpleNamespace(unknowns=(UNKNOWN, UNKNOWN), sources=("d",)))
    of = {e.sources: h for e, h in zip(equations, terms, strict=False)}
    monkeypatch.setattr(matching, "harmonics", lambda e, unknown: of[e.sources])
    pairs = simultaneous.find(equations, UNKNOWN, SimpleNamespace(graph=g))
    return [pair.sources for pair in pairs]


def test_pairs_are_of_equations_without_double_angles(monkeypatch: pytest.MonkeyPatch) -> None:
    assert len(found(monkeypatch, double=False, alike=False)) == 3
    assert found(monkeypatch, double=True, alike=False) == [("a", "b")]


def test_pairs_are_independent(monkeypatch: pytest.MonkeyPatch) -> None:
    pairs = found(monkeypatch, double=False, alike=True)
    assert len(pairs) == 2 and ("a", "b") not in pairs
