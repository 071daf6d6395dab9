"""Each leaf on the smallest arm that wants it, and the rules around them."""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.support.solving import emitted
from tests.support.tables import Row, geared, table

from ikgen.equations.probes import dh_pose
from ikgen.importers.dh.dh_table import read_dh_table
from ikgen.report.document import Paragraph
from ikgen.report.leaf_words import leaf_sentence
from ikgen.solver.leaves import LEAVES, Find, Leaf
from ikgen.solver.solve import solve_chain

TABLES = Path(__file__).resolve().parents[2] / "robots/tables"
SPHERICAL = (("R", "-1", 0.0, 0.4), ("R", "1", 0.0, 0.0), ("R", "-1", 0.0, 0.0))
CASES: dict[str, tuple[set[str], tuple[Row, ...]]] = {
    "two sliding joints": (
        {"algebraic", "simultaneous"},
        (("P", "0", 0.0, 0.0), ("P", "1", 0.0, 0.0), ("R", "1", 0.2, 0.0)),
    ),
    "planar arm": (
        {"simultaneous", "x2y2"},
        (("R", "0", 0.0, 0.0), ("R", "0", 0.5, 0.0), ("R", "0", 0.4, 0.0)),
    ),
    "spherical wrist": (
        {"sine and cosine", "x2y2", "tangent", "simultaneous"},
        (("R", "0", 0.0, 0.0), ("R", "-1", 0.1, 0.0), ("R", "0", 0.5, 0.1), *SPHERICAL),
    ),
    "elbow not parallel to the shoulder": (
        {"quartic", "simultaneous", "tangent"},
        (("R", "0", 0.0, 0.0), ("R", "-1", 0.3, 0.1), ("R", "1", 0.5, 0.2), *SPHERICAL),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_leaves_solve_what_they_are_for(name: str, tmp_path: Path) -> None:
    leaves, rows = CASES[name]
    dh = table(*rows)
    graph = solve_chain(dh)
    assert not graph.open_joints
    assert {s.candidate.leaf for s in graph.steps} == leaves
    module = emitted(dh, tmp_path)
    q = np.random.default_rng(0).uniform(-2.0, 2.0, (60, dh.dof))
    for at, pose in zip(q, dh_pose(dh, q), strict=True):
        found = module.solve(pose, limits=False).q
        assert np.abs(module.forward(found) - pose).max() < 1e-9
        turn = np.array([row.revolute for row in dh.rows])
        gap = np.where(turn, np.abs((found - at + np.pi) % (2 * np.pi) - np.pi), np.abs(found - at))
        assert gap.max(axis=1).min() < 1e-6


@pytest.mark.parametrize(
    ("leaf", "case"),
    [("sine and cosine", "planar arm"), ("quartic", "elbow not parallel to the shoulder")],
)
def test_without_its_leaf_an_arm_stays_open(leaf: str, case: str) -> None:
    others = [one for one in LEAVES if one.name != leaf]
    assert solve_chain(table(*CASES[case][1]), leaves=others).open_joints


def test_every_leaf_solves_some_arm() -> None:
    chains = [table(*rows) for _, rows in CASES.values()]
    chains.append(read_dh_table(TABLES / "Wachtveitl.toml", free=(), locked={})[1])
    chains.append(geared(table(*CASES["planar arm"][1], ("R", "0", 0.2, 0.0))))
    assert {leaf.name for leaf in LEAVES} <= {
        step.candidate.leaf for dh in chains for step in solve_chain(dh).steps
    }


def test_a_divisor_that_vanishes_at_right_angles_is_never_taken_alone() -> None:
    for _, rows in CASES.values():
        for step in solve_chain(table(*rows)).steps:
            assert not step.candidate.is_weak or step.fallbacks


def given_names(find: Find) -> set[str]:
    """The names that a leaf's module gives candidates: literals, or variables that hold one of some."""
    tree = ast.parse(inspect.getsource(sys.modules[find.__module__]))
    values: dict[str, list[ast.expr]] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            values.setdefault(node.targets[0].id, []).append(node.value)

    def texts(node: ast.expr) -> Iterator[str]:
        if isinstance(node, ast.IfExp):
            yield from [*texts(node.body), *texts(node.orelse)]
        elif isinstance(node, ast.Name):
            for value in values[node.id]:
                yield from texts(value)
        else:
            assert isinstance(node, ast.Constant) and isinstance(node.value, str), ast.unparse(node)
            yield node.value

    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    made = [c for c in calls if isinstance(c.func, ast.Name) and c.func.id == "Candidate"]
    return {name for call in made for name in texts(call.args[1])}


@pytest.mark.parametrize("leaf", LEAVES, ids=lambda leaf: leaf.name)
def test_what_a_leaf_finds_has_a_rank_and_a_sentence(leaf: Leaf) -> None:
    assert given_names(leaf.find) == set(leaf.finds)
    for name, sentence in leaf.finds.items():
        assert sentence.endswith(".") and leaf_sentence(name) == [Paragraph((sentence,))]


def test_no_two_leaves_give_one_name() -> None:
    names = [name for leaf in LEAVES for name in leaf.finds]
    assert len(set(names)) == len(names)


def test_every_tick_is_recorded() -> None:
    graph = solve_chain(table(*CASES["spherical wrist"][1]))
    rounds = {tick.round for tick in graph.ticks}
    assert rounds == set(range(1, len(graph.steps) + 1))
    assert {tick.outcome for tick in graph.ticks} == {"success", "failure"}


def test_two_axes_on_one_line_stay_open() -> None:
    graph = solve_chain(
        table(
            ("R", "0", 0.0, 0.0), ("R", "1", 0.3, 0.0), ("R", "1", 0.2, 0.0), ("R", "0", 0.0, 0.1)
        )
    )
    assert graph.open_joints
