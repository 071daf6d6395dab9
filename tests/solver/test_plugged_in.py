"""A leaf of another package takes part like ikgen's own."""

from __future__ import annotations

import re
from importlib.metadata import EntryPoint
from pathlib import Path

import numpy as np
import pytest
from tests.solver.leaves.test_leaves import CASES
from tests.support.solving import import_text, module_of
from tests.support.tables import table

from ikgen import plugins
from ikgen.emit.python.python_emitter import emit_module
from ikgen.errors import PlugInError
from ikgen.importers.dh.dh_table import read_dh_table
from ikgen.report.behavior import behavior_section
from ikgen.report.document import Picture
from ikgen.solver import leaves
from ikgen.solver.behavior_tree import Action, Tree, the_tree
from ikgen.solver.leaves import LEAVES, Leaf
from ikgen.solver.session import Session
from ikgen.solver.solve import solve_chain

TABLES = Path(__file__).resolve().parents[1] / "robots/tables"
PAGES = Path(__file__).resolve().parents[2] / "docs/how-to"


def documented(page: str, title: str, name: str) -> object:
    """What the code of that title on a page defines by a name."""
    text = (PAGES / page).read_text()
    code = re.search(rf'^```python title="{title}"\n(.*?)^```', text, re.M | re.S)
    assert code is not None
    names: dict[str, object] = {}
    exec(compile(code.group(1), page, "exec", dont_inherit=True), names)
    return names[name]


SLIDE = documented("add-a-leaf.md", "leaf", "SLIDE")
assert isinstance(SLIDE, Leaf)


def test_given_leaves_take_the_place_of_the_own_ones() -> None:
    dh = table(*CASES["two sliding joints"][1])
    own = [leaf for leaf in LEAVES if leaf.name not in ("algebraic", "quadratic")]
    assert solve_chain(dh, leaves=own).open_joints
    graph = solve_chain(dh, leaves=[*own, SLIDE])
    assert not graph.open_joints
    assert "slide" in {s.candidate.leaf for s in graph.steps}
    assert "slide" in {tick.node for tick in graph.ticks}


def test_a_leaf_brings_a_form_of_its_own(tmp_path: Path) -> None:
    square = documented("add-a-leaf.md", "form", "SQUARE")
    assert isinstance(square, Leaf)
    _, dh = read_dh_table(TABLES / "Wachtveitl.toml", free=(), locked={})
    others = [leaf for leaf in LEAVES if leaf.name == "simultaneous"]
    assert solve_chain(dh, leaves=others).open_joints
    graph = solve_chain(dh, leaves=[*others, square])
    assert not graph.open_joints
    assert "completed square" in {s.candidate.form.name for s in graph.steps}
    module = import_text(emit_module(module_of(dh, graph)), tmp_path)
    rng = np.random.default_rng(3)
    for q in rng.uniform(0.2, 1.4, (40, dh.dof)):
        pose = module.forward(q)
        found = module.solve(pose, limits=False).q
        assert np.abs(module.forward(found) - pose).max() < 1e-9
        assert np.abs(found - q).max(axis=1).min() < 1e-6


def test_entry_points_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = EntryPoint("slide", "tests.solver.test_plugged_in:SLIDE", "ikgen.leaves")
    monkeypatch.setattr(plugins, "entry_points", lambda group: [entry])
    names = [leaf.name for leaf in leaves.all_leaves()]
    assert names == [*(leaf.name for leaf in LEAVES), "slide"]


def documented_tree() -> Tree:
    """The tree of the page on trees, as a package of its own would have it."""
    text = (PAGES / "add-a-tree.md").read_text()
    code = re.search(r"^```python[^\n]*\n(.*?)^```", text, re.M | re.S)
    assert code is not None
    names: dict[str, object] = {}
    exec(compile(code.group(1), "add-a-tree.md", "exec", dont_inherit=True), names)
    tree = names["TREE"]
    assert isinstance(tree, Tree)
    return tree


@pytest.mark.parametrize("case", ["two sliding joints"])
def test_another_tree_solves_and_is_told(case: str) -> None:
    graph = solve_chain(table(*CASES[case][1]), tree=documented_tree())
    assert not graph.open_joints
    assert any("ways" in path for path in graph.outline)
    assert {tick.node for tick in graph.ticks} > {"collect equations", "ways"}


def test_the_report_tells_what_a_tree_solved_that_words_it_otherwise() -> None:
    def take(session: Session) -> tuple[bool, str]:
        session.collect()
        for leaf in LEAVES:
            session.try_leaf(leaf)
        return session.choose(anything=True) is not None, "another one"

    tree = Tree("at once", lambda session, _: Action("at once", session, take))
    graph = solve_chain(table(*CASES["two sliding joints"][1]), tree=tree)
    assert not graph.open_joints
    assert [step.round for step in graph.steps] == [t.round for t in graph.ticks]
    (picture,) = (block for block in behavior_section(graph) if isinstance(block, Picture))
    for step in graph.steps:
        assert f"</math> by {step.candidate.leaf} from " in picture.svg


def test_the_tree_of_another_package_takes_the_place_of_the_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    entry = EntryPoint("mine", "tests.solver.test_plugged_in:documented_tree", "ikgen.trees")
    monkeypatch.setattr(plugins, "entry_points", lambda group: [entry])
    assert the_tree().name == "one leaf at a time"


def test_a_tree_that_succeeds_with_nothing_solved_ends_the_derivation() -> None:
    idle = Tree("idle", lambda session, _: Action("idle", session, lambda _: (True, "")))
    graph = solve_chain(table(*CASES["planar arm"][1]), tree=idle)
    assert graph.open_joints == (0, 1, 2) and len(graph.ticks) == 1


def test_two_trees_are_one_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    entries = [
        EntryPoint(n, "tests.solver.test_plugged_in:documented_tree", "ikgen.trees") for n in "ab"
    ]
    monkeypatch.setattr(plugins, "entry_points", lambda group: entries)
    with pytest.raises(PlugInError, match="several"):
        the_tree()
