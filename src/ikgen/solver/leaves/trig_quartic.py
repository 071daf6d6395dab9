"""Quartic leaf (Pieper): `a2 cos 2u + b2 sin 2u + a1 cos u + b1 sin u + a0 = 0`, at most four roots.

D. L. Pieper, The kinematics of manipulators under computer control, 1968.
"""

from __future__ import annotations

from collections.abc import Sequence

from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import in_harmonics
from ikgen.forms.quartic_form import TrigQuartic
from ikgen.solver.candidate import Candidate

__all__ = ["find"]

TERMS = ((2, "c"), (2, "s"), (1, "c"), (1, "s"), (0, "c"))


def find(
    equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
) -> list[Candidate]:
    """Equations of degree two in the cosine and sine of the unknown alone."""
    g = knowledge.graph
    out: list[Candidate] = []
    for e, h, degree in in_harmonics(equations, unknown):
        if degree != 2:
            continue
        form = TrigQuartic(*(h.get(term, g.zero) for term in TERMS))
        out.append(Candidate(unknown, "quartic", form, e.sources))
    return out
