"""Quadratic leaf: `A x^2 + B x + C = 0` in a prismatic variable."""

from __future__ import annotations

from collections.abc import Sequence

from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import powers
from ikgen.forms.quadratic_form import Quadratic
from ikgen.solver.candidate import Candidate

__all__ = ["find"]


def find(
    equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
) -> list[Candidate]:
    """Quadratic equations in the unknown alone."""
    if unknown.kind != "prismatic":
        return []
    zero = knowledge.graph.zero
    out: list[Candidate] = []
    for e in equations:
        if e.unknowns != (unknown,):
            continue
        p = powers(e, unknown)
        if p is not None and max(p) == 2:
            form = Quadratic(p[2], p.get(1, zero), p.get(0, zero))
            out.append(Candidate(unknown, "quadratic", form, e.sources))
    return out
