"""Trigonometric polynomials of degree three and more in the unknown alone, as geared joints leave them.

A joint that follows another by a gear turns a multiple of it, and so do the sums of both: the harmonics
of the equation are whole numbers, however many.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import in_harmonics
from ikgen.forms.trig_polynomial_form import CIRCLE, TrigPolynomial
from ikgen.kinematics.whole_turns import range_of
from ikgen.solver.candidate import Candidate

__all__ = ["find"]

_MOST = 32
"""Roots beyond which there is no candidate: code for all of them would take minutes to compile."""


def find(
    equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
) -> list[Candidate]:
    """Equations of degree three and more in the cosine and sine of the unknown alone."""
    g = knowledge.graph
    out: list[Candidate] = []
    for e, h, degree in in_harmonics(equations, unknown):
        if degree <= 2:
            continue
        found = tuple(sorted({k for k, _ in h} - {0}))
        terms = [h.get((k, kind), g.zero) for k in found for kind in "cs"]
        form = TrigPolynomial((*terms, h.get((0, "c"), g.zero)), found, _span(unknown, knowledge))
        if form.branches > _MOST:
            continue
        out.append(Candidate(unknown, "trigonometric polynomial", form, e.sources))
    return out


def _span(unknown: Variable, knowledge: Knowledge) -> tuple[float, float]:
    """Where the unknown's values are looked for: of a joint where its own are, of other angles on the whole
    circle."""
    span = -math.pi, math.pi
    if unknown.joint is not None:
        span = range_of(knowledge.variables.dh, unknown.joint)
    return CIRCLE if span == (-math.pi, math.pi) else span
