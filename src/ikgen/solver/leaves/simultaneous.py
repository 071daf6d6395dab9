"""Simultaneous-equations leaf: two equations linear in the cosine and sine of the unknown
(IKBT, rule-based solver 5, there for orthogonal coefficients; here for any)."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from ikgen.algebra.expression import Expr
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import determinant_vanishes, in_harmonics
from ikgen.forms.pair_form import LinearPair
from ikgen.solver.candidate import Candidate

__all__ = ["find"]

MOST_EQUATIONS = 16
"""Pairs are sought among this many equations, those with the simplest coefficients first."""


def _weight(coefficients: tuple[Expr, Expr, Expr]) -> tuple[int, int]:
    fixed = sum(not e.is_fixed for e in coefficients[:2])
    return fixed, sum(e.id for e in coefficients)


def find(
    equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
) -> list[Candidate]:
    """Pairs of linear equations in the unknown alone with a determinant that does not vanish."""
    g = knowledge.graph
    linear: list[tuple[tuple[Expr, Expr, Expr], PolynomialEquation]] = []
    for e, h, degree in in_harmonics(equations, unknown):
        if degree > 1:
            continue
        row = (h.get((1, "c"), g.zero), h.get((1, "s"), g.zero), g.neg(h.get((0, "c"), g.zero)))
        linear.append((row, e))
    linear.sort(key=lambda item: _weight(item[0]))
    out: list[Candidate] = []
    for (one, e1), (two, e2) in itertools.combinations(linear[:MOST_EQUATIONS], 2):
        if not determinant_vanishes(one[:2], two[:2]):
            sources = (*e1.sources, *e2.sources)
            out.append(Candidate(unknown, "simultaneous", LinearPair(*one, *two), sources))
    return out
