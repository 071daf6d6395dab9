"""The leaves: rule-based solvers, each a pure function `find(equations, unknown, knowledge)`.

One row a leaf. `preference` breaks ties between candidates for the same unknown: IKBT's ranker prefers
forms with one solution and with atan2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import entry_points

from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import (
    algebraic,
    root,
    simultaneous,
    sine_and_cosine,
    tangent,
    trig_quartic,
)

__all__ = ["LEAVES", "Leaf", "all_leaves"]

Find = Callable[[Sequence[PolynomialEquation], Variable, Knowledge], list[Candidate]]


@dataclass(frozen=True, slots=True)
class Leaf:
    """A leaf by name, with its function and the paper's name for it."""

    name: str
    find: Find


LEAVES: tuple[Leaf, ...] = (
    Leaf("algebraic", algebraic.find),
    Leaf("simultaneous", simultaneous.find),
    Leaf("tangent", tangent.find),
    Leaf("sine and cosine", sine_and_cosine.find),
    Leaf("quadratic", root.find),
    Leaf("quartic", trig_quartic.find),
)


def all_leaves() -> tuple[Leaf, ...]:
    """The leaves above and those of other packages: entry points of the group `ikgen.leaves`, each a
    `Leaf`. Theirs are ranked behind ours of the same soundness and number of branches."""
    others = sorted(entry_points(group="ikgen.leaves"), key=lambda entry: entry.name)
    return (*LEAVES, *(entry.load() for entry in others))
