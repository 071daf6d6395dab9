"""The leaves: rule-based solvers, each a pure function `find(equations, unknown, knowledge)`.

One row a leaf, in the order in which `ikgen.solver.ranker` prefers what they find.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.plugins import PlugIn, plug_ins
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import (
    algebraic,
    quadratic,
    simultaneous,
    sine_and_cosine,
    tangent,
    trig_polynomial,
    trig_quartic,
)

__all__ = ["LEAVES", "Find", "Leaf", "all_leaves"]

Find = Callable[[Sequence[PolynomialEquation], Variable, Knowledge], list[Candidate]]


@dataclass(frozen=True, slots=True)
class Leaf:
    """A leaf: its name, its function, and what it finds: the names of its candidates, those that are
    preferred first, each with a sentence for the reader of a report on how they solve."""

    name: str
    find: Find
    finds: Mapping[str, str] = field(default_factory=dict, hash=False)


LEAVES: tuple[Leaf, ...] = (
    Leaf("algebraic", algebraic.find, {
        "algebraic": "The unknown stands alone in a linear equation: it is the quotient of what is known.",
    }),
    Leaf("simultaneous", simultaneous.find, {
        "simultaneous": "Two equations that are linear in cosine and sine of the unknown are solved "
        "together, and give one angle.",
    }),
    Leaf("tangent", tangent.find, {
        "tangent": "The quotient of two equations leaves the tangent of the unknown; the sign of what was "
        "divided out is not known, so that two angles half a turn apart are left.",
    }),
    Leaf("sine and cosine", sine_and_cosine.find, {
        "sine or cosine": "One equation gives the cosine of the unknown, or its sine, alone: two angles "
        "that mirror each other.",
        "sine and cosine": "One equation a cos + b sin = c describes a line that cuts the unit circle in "
        "two points: two angles.",
        "x2y2": "The sum of two or three squared equations drops one unknown; what is left has the form "
        "a cos + b sin = c and two angles.",
    }),
    Leaf("quadratic", quadratic.find, {
        "quadratic": "The unknown solves a polynomial of degree two: two roots.",
    }),
    Leaf("quartic", trig_quartic.find, {
        "quartic": "Two equations of degree two in cosine and sine meet in up to four points of the unit "
        "circle: up to four angles.",
    }),
    Leaf("trigonometric polynomial", trig_polynomial.find, {
        "trigonometric polynomial": "One equation in multiples of the unknown, as joints leave it that are "
        "geared to each other: its roots are found one by one.",
    }),
)  # fmt: skip
"""In the order of preference, among candidates of as many branches."""


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
