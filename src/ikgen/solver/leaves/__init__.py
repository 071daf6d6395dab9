"""The leaves: rule-based solvers, each a pure function `find(equations, unknown, knowledge)`.

One row a leaf; `ikgen.solver.ranker` chooses among the candidates that they find.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.plugins import PlugIn, plug_ins
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import (
    algebraic,
    quadratic,
    simultaneous,
    sine_and_cosine,
    tangent,
    trig_quartic,
)

__all__ = ["LEAVES", "Leaf", "all_leaves"]

Find = Callable[[Sequence[PolynomialEquation], Variable, Knowledge], list[Candidate]]


@dataclass(frozen=True, slots=True)
class Leaf:
    """A leaf: its name and its function."""

    name: str
    find: Find


LEAVES: tuple[Leaf, ...] = (
    Leaf("algebraic", algebraic.find),
    Leaf("simultaneous", simultaneous.find),
    Leaf("tangent", tangent.find),
    Leaf("sine and cosine", sine_and_cosine.find),
    Leaf("quadratic", quadratic.find),
    Leaf("quartic", trig_quartic.find),
)


def all_leaves() -> tuple[Leaf, ...]:
    """The leaves above and those of other packages: entry points of the group `ikgen.leaves`, each a
    `Leaf`. Theirs are ranked behind ours of the same soundness and number of branches.

    Raises `PlugInError` for one that cannot be loaded: without it the result would be another one.
    """
    return (*LEAVES, *(_plugged_in(one) for one in plug_ins("ikgen.leaves")))


def _plugged_in(plug_in: PlugIn) -> Leaf:
    """A leaf of another package, whose failures name it."""
    leaf = plug_in.load(Leaf)

    def find(
        equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
    ) -> list[Candidate]:
        with plug_in.blamed():
            return leaf.find(equations, unknown, knowledge)

    return replace(leaf, find=find)
