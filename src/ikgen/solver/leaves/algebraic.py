"""Algebraic leaf: `A x + B = 0` in a prismatic variable (IKBT, rule-based solver 1)."""

from __future__ import annotations

from collections.abc import Sequence

from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import powers
from ikgen.forms.linear_form import Linear
from ikgen.solver.candidate import Candidate

__all__ = ["find"]


def find(
    equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
) -> list[Candidate]:
    """Linear equations in the unknown alone."""
    if unknown.kind != "prismatic":
        return []
    out: list[Candidate] = []
    zero = knowledge.graph.zero
    for e in equations:
        if e.unknowns != (unknown,):
            continue
        p = powers(e, unknown)
        if p is not None and max(p) == 1:
            form = Linear(p[1], p.get(0, zero))
            out.append(Candidate(unknown, "algebraic", form, e.sources))
    return out
