"""Sine-and-cosine leaf: `A cos(u) + B sin(u) = C` (IKBT, rule-based solver 4), and its special case
"sine or cosine" where A or B vanishes (solver 2). Equations that are sums of squares are IKBT's
"x^2 y^2" (solver 6): the squares have dropped the other unknowns out."""

from __future__ import annotations

from collections.abc import Sequence

from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import in_harmonics
from ikgen.forms.sine_cosine_form import SineCosine
from ikgen.forms.tangent_form import Tangent
from ikgen.solver.candidate import Candidate

__all__ = ["find"]


def find(
    equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
) -> list[Candidate]:
    """Equations linear in the cosine and sine of the unknown alone."""
    g = knowledge.graph
    out: list[Candidate] = []
    for e, h, degree in in_harmonics(equations, unknown):
        if degree > 1:
            continue
        a, b, c = h.get((1, "c"), g.zero), h.get((1, "s"), g.zero), g.neg(h.get((0, "c"), g.zero))
        if c is g.zero:
            out.append(Candidate(unknown, "sine and cosine", Tangent(b, g.neg(a)), e.sources))
            continue
        single = a is g.zero or b is g.zero
        leaf = "sine or cosine" if single else "sine and cosine"
        name = "x2y2" if e.squared else leaf
        out.append(Candidate(unknown, name, SineCosine(a, b, c), e.sources))
    return out
