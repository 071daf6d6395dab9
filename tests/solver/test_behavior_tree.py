"""Nodes of the behavior tree by themselves: what succeeds, what is ticked, and what is recorded."""

from __future__ import annotations

from types import SimpleNamespace

import py_trees
import pytest
from py_trees.common import Status

from ikgen.solver.behavior_tree import (
    Action,
    Or,
    _transform,
    choose,
    leaf_node,
    outline,
    tick,
)
from ikgen.solver.leaves import Leaf


class Recording:
    """A session that keeps what is recorded."""

    def __init__(self) -> None:
        self.told: list[tuple[tuple[str, ...], str, str, str]] = []
        self.collected = self.equations = ["old"]
        self.knowledge = None

    def record(self, path: tuple[str, ...], kind: str, outcome: str, detail: str, _: float) -> None:
        self.told.append((path, kind, outcome, detail))

    def try_leaf(self, leaf: Leaf) -> int:
        return len(leaf.name)

    def new_equations(self, made: list[object]) -> None:
        self.equations = made


def tree_of(session: Recording, *done: bool) -> Or:
    """An Or over actions that succeed or fail."""
    node = Or("either")
    node.add_children(
        [
            Action(f"{i}", session, lambda _, ok=ok: (ok, "fine" if ok else "not"))
            for i, ok in enumerate(done)
        ]
    )
    return node


@pytest.mark.parametrize(
    "done", [(), (True,), (False,), (True, False), (False, True), (False, False), (True, True)]
)
def test_either_ticks_all_and_succeeds_where_one_does(done: tuple[bool, ...]) -> None:
    session = Recording()
    node = tree_of(session, *done)
    seen = list(node.tick())
    assert seen == [*node.children, node]
    assert node.status == (Status.SUCCESS if any(done) else Status.FAILURE)
    assert node.current_child is (node.children[-1] if done else None)
    outcomes = ["success" if ok else "failure" for ok in done]
    assert [outcome for _, _, outcome, _ in session.told] == outcomes
    assert [path for path, *_ in session.told] == [("either", f"{i}") for i in range(len(done))]


def test_a_tick_tells_whether_the_tree_did_it_and_records_composites() -> None:
    for done in (True, False):
        session = Recording()
        root = py_trees.composites.Sequence("root", memory=False)
        root.add_children([tree_of(session, done)])
        assert tick(root, session) is done
        word = "success" if done else "failure"
        assert [(path[-1], kind, outcome) for path, kind, outcome, _ in session.told] == [
            ("0", "leaf", word), ("either", "or", word), ("root", "sequence", word),
        ]  # fmt: skip
        assert outline(root) == (("root",), ("root", "either"), ("root", "either", "0"))


@pytest.mark.parametrize(
    ("name", "done", "told"), [("", False, "nothing that fits"), ("abc", True, "3 candidates")]
)
def test_a_leaf_succeeds_with_candidates(name: str, done: bool, told: str) -> None:
    session = Recording()
    node = leaf_node(Leaf(name, lambda *_: []), session)
    list(node.tick())
    assert (node.status == Status.SUCCESS) is done and node.feedback_message == told


@pytest.mark.parametrize("made", [[], ["a", "b"]])
def test_a_transform_succeeds_with_equations_and_puts_them_in_place(made: list[str]) -> None:
    session = Recording()
    found = _transform(lambda equations, knowledge: made if equations == ["old"] else [])(session)
    assert found == (bool(made), f"{len(made)} new equations") and session.equations == made


def test_choosing_tells_the_unknown_its_leaf_and_its_equations_once() -> None:
    sources = tuple(SimpleNamespace(label=label) for label in ("(0,1) px", "(0,2) pz", "(0,1) px"))
    candidate = SimpleNamespace(
        unknown=SimpleNamespace(text="theta_2"), leaf="tangent", sources=sources
    )
    asked: list[bool] = []

    def answer(*, anything: bool) -> SimpleNamespace | None:
        asked.append(anything)
        return SimpleNamespace(candidate=candidate) if anything else None

    session = SimpleNamespace(choose=answer)
    assert choose(session) == (False, "no sound candidate")
    assert choose(session, anything=True) == (True, "theta_2 by tangent from (0,1) px and (0,2) pz")
    assert asked == [False, True]
