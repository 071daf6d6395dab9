"""The behavior tree, as in the figure of the IKBT paper.

    solve one unknown: Sequence
    ├── collect equations              sorts the scalar equations by number of unknowns
    └── Selector
        ├── Sequence: rules            OR over the leaves, then the ranker if a good candidate was found
        ├── Sequence: square and add   the transform, then the same
        ├── Sequence: substitution     another transform, then the same
        └── take what there is         the ranker, whatever the candidates

Nodes read and write a `Session`; this module is the only one that knows py_trees. Its `Parallel` fails
as soon as one child fails, so the paper's "OR" (tick all, succeed if any did) is a composite of our own.
Another package may offer a tree of its own, built from the same nodes, by the group `ikgen.trees`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from ikgen.equations.knowledge import Knowledge, PolynomialEquation
from ikgen.errors import PlugInError
from ikgen.plugins import plug_ins
from ikgen.solver.leaves import Leaf
from ikgen.solver.session import Session
from ikgen.solver.transforms import square_and_add, substitution

__all__ = [
    "TREE",
    "Action",
    "Or",
    "Tree",
    "build_tree",
    "choose",
    "collect",
    "leaf_node",
    "outline",
    "the_tree",
    "tick",
]

Transform = Callable[[Sequence[PolynomialEquation], Knowledge], list[PolynomialEquation]]


def _path(node: Behaviour) -> tuple[str, ...]:
    """The names from the root to a node."""
    above = _path(node.parent) if node.parent is not None else ()
    return (*above, str(node.name))


class Action(Behaviour):
    """A node that runs a function of the session and records what came of it."""

    def __init__(
        self, name: str, session: Session, act: Callable[[Session], tuple[bool, str]]
    ) -> None:
        super().__init__(name)
        self.session = session
        self.act = act

    def update(self) -> Status:
        """Run the function; success or failure is its answer."""
        started = time.perf_counter()
        done, detail = self.act(self.session)
        self.feedback_message = detail
        outcome = "success" if done else "failure"
        self.session.record(_path(self), "leaf", outcome, detail, started)
        return Status.SUCCESS if done else Status.FAILURE


class Or(py_trees.composites.Composite):
    """Ticks every child, whatever the others answer; succeeds if any did (the paper's "OR")."""

    def tick(self) -> Iterator[Behaviour]:
        """One pass over all children."""
        succeeded = False
        for child in self.children:
            yield from child.tick()
            succeeded = succeeded or child.status == Status.SUCCESS
        self.status = Status.SUCCESS if succeeded else Status.FAILURE
        self.current_child = self.children[-1] if self.children else None
        yield self


def collect(session: Session) -> tuple[bool, str]:
    """Sort the scalar equations by number of unknowns."""
    session.collect()
    count = len(session.equations)
    return count > 0, f"{count} equations with one or two unknowns"


def leaf_node(leaf: Leaf, session: Session) -> Action:
    """A node that collects what a leaf proposes."""

    def act(session: Session) -> tuple[bool, str]:
        found = session.try_leaf(leaf)
        return found > 0, f"{found} candidates" if found else "nothing that fits"

    return Action(leaf.name, session, act)


def _transform(transform: Transform) -> Callable[[Session], tuple[bool, str]]:
    def act(session: Session) -> tuple[bool, str]:
        made = transform(session.collected, session.knowledge)
        session.new_equations(made)
        return bool(made), f"{len(made)} new equations"

    return act


def choose(session: Session, *, anything: bool = False) -> tuple[bool, str]:
    """Take the best sound candidate as the next step; with `anything` the best whatever it is."""
    step = session.choose(anything=anything)
    if step is None:
        return False, "no sound candidate"
    c = step.candidate
    places = " and ".join(dict.fromkeys(e.label for e in c.sources))
    return True, f"{c.unknown.text} by {c.leaf} from {places}"


def _attempt(
    name: str, session: Session, leaves: Sequence[Leaf], first: list[Behaviour]
) -> Behaviour:
    sequence = py_trees.composites.Sequence(name, memory=False)
    rules = Or(f"{name}: leaves")
    rules.add_children([leaf_node(leaf, session) for leaf in leaves])
    sequence.add_children([*first, rules, Action("ranker", session, choose)])
    return sequence


def build_tree(session: Session, leaves: Sequence[Leaf]) -> Behaviour:
    """The tree that solves one unknown a tick."""
    root = py_trees.composites.Sequence("solve one unknown", memory=False)
    ways = py_trees.composites.Selector("ways", memory=False)
    square = Action("square and add", session, _transform(square_and_add.apply))
    substitute = Action("substitution", session, _transform(substitution.apply))
    ways.add_children(
        [
            _attempt("rules", session, leaves, []),
            _attempt("after square and add", session, leaves, [square]),
            _attempt("after substitution", session, leaves, [substitute]),
            Action("take what there is", session, partial(choose, anything=True)),
        ]
    )
    root.add_children([Action("collect equations", session, collect), ways])
    return root


@dataclass(frozen=True, slots=True)
class Tree:
    """A way to solve one unknown a tick: `build` takes the session and the leaves to use."""

    name: str
    build: Callable[[Session, Sequence[Leaf]], Behaviour]


TREE = Tree("ikgen", build_tree)


def the_tree() -> Tree:
    """The tree of another package where one is installed, else ikgen's own.

    Raises `PlugInError` where several packages offer one.
    """
    found = plug_ins("ikgen.trees")
    if len(found) > 1:
        words = " and ".join(f"'{one.name}' of {one.package}" for one in found)
        raise PlugInError(f"several behavior trees are installed: {words}", hint="keep one of them")
    return found[0].load(Tree) if found else TREE


def tick(tree: Behaviour, session: Session) -> bool:
    """One tick of the tree; whether an unknown was solved. Composites go into the trace as they end."""
    started = time.perf_counter()
    for node in tree.tick():
        if node.children:
            outcome = "success" if node.status == Status.SUCCESS else "failure"
            kind = type(node).__name__.lower()
            session.record(_path(node), kind, outcome, "", started)
    return bool(tree.status == Status.SUCCESS)


def outline(tree: Behaviour) -> tuple[tuple[str, ...], ...]:
    """The paths of all nodes, parents before their children."""
    below = (path for child in tree.children for path in outline(child))
    return (_path(tree), *below)
