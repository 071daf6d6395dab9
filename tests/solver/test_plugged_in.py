"""A leaf of another package takes part like ikgen's own."""

from __future__ import annotations

import re
from collections.abc import Sequence
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest
from tests.solver.test_leaves import CASES, table

from ikgen import plugins
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import powers
from ikgen.errors import PlugInError
from ikgen.solver import leaves
from ikgen.solver.behavior_tree import Tree, the_tree
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import LEAVES, Leaf
from ikgen.solver.solve import solve_chain


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
    entry = EntryPoint("slide", "tests.solver.test_plugged_in:SLIDE", "ikgen.leaves")
    monkeypatch.setattr(plugins, "entry_points", lambda group: [entry])
    names = [leaf.name for leaf in leaves.all_leaves()]
    assert names == [*(leaf.name for leaf in LEAVES), "slide"]


TREE_PAGE = Path(__file__).resolve().parents[2] / "docs/how-to/add-a-tree.md"


def documented_tree() -> Tree:
    """The tree of the page on trees, as a package of its own would have it."""
    code = re.search(r"^```python[^\n]*\n(.*?)^```", TREE_PAGE.read_text(), re.M | re.S)
    assert code is not None
    names: dict[str, object] = {}
    exec(code.group(1), names)
    tree = names["TREE"]
    assert isinstance(tree, Tree)
    return tree


@pytest.mark.parametrize("case", ["two sliding joints"])
def test_another_tree_solves_and_is_told(case: str) -> None:
    graph = solve_chain(table(*CASES[case][1]), tree=documented_tree())
    assert not graph.open_joints
    assert any("ways" in path for path in graph.outline)
    assert {tick.node for tick in graph.ticks} > {"collect equations", "ways"}


def test_the_tree_of_another_package_takes_the_place_of_the_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    entry = EntryPoint("mine", "tests.solver.test_plugged_in:documented_tree", "ikgen.trees")
    monkeypatch.setattr(plugins, "entry_points", lambda group: [entry])
    assert the_tree().name == "one leaf at a time"


def test_two_trees_are_one_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    entries = [
        EntryPoint(n, "tests.solver.test_plugged_in:documented_tree", "ikgen.trees") for n in "ab"
    ]
    monkeypatch.setattr(plugins, "entry_points", lambda group: entries)
    with pytest.raises(PlugInError, match="several"):
        the_tree()
