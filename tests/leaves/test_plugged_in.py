"""A leaf of another package takes part like ikgen's own."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import EntryPoint

import pytest
from test_leaves import CASES, table

from ikgen import plugins
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import powers
from ikgen.solver import leaves
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import LEAVES, Leaf
from ikgen.solver.run import solve_chain


def find_slide(
    equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
) -> list[Candidate]:
    """`A x + B = 0` in a sliding joint, as a package of its own would write it."""
    out: list[Candidate] = []
    for e in equations:
        if unknown.kind == "dist" and e.unknowns == (unknown,):
            p = powers(e, unknown)
            if p is not None and max(p) == 1:
                coefficients = (p[1], p.get(0, knowledge.graph.zero))
                out.append(Candidate(unknown, "slide", "linear", coefficients, e.sources))
    return out


SLIDE = Leaf("slide", find_slide)


def test_given_leaves_take_the_place_of_the_own_ones() -> None:
    dh = table(*CASES["two sliding joints"][1])
    own = [leaf for leaf in LEAVES if leaf.name not in ("algebraic", "quadratic")]
    assert solve_chain(dh, leaves=own).open_joints
    graph = solve_chain(dh, leaves=[*own, SLIDE])
    assert not graph.open_joints
    assert "slide" in {s.candidate.leaf for s in graph.steps}
    assert "slide" in {tick.node for tick in graph.ticks}


def test_entry_points_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = EntryPoint("slide", "test_plugged_in:SLIDE", "ikgen.leaves")
    monkeypatch.setattr(plugins, "entry_points", lambda group: [entry])
    names = [leaf.name for leaf in leaves.all_leaves()]
    assert names == [*(leaf.name for leaf in LEAVES), "slide"]
