"""A leaf of ikgen with a form of its own: an angle whose double alone is in an equation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import in_harmonics
from ikgen.forms.form import Form
from ikgen.forms.lowered_form import LoweredBranches, Tolerances, divisor_of, natural_size
from ikgen.model.arrays import Array
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import Leaf

__all__ = ["DOUBLE_ANGLE", "DoubleAngle"]


@dataclass(frozen=True, slots=True)
class DoubleAngle(Form):
    """`a cos(2u) + b sin(2u) + c = 0`: a line cuts the circle of 2u in two points, each of two angles u."""

    name: ClassVar[str] = "double angle"
    branches: ClassVar[int] = 4
    a: Expr
    b: Expr
    c: Expr

    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """Both coefficients of the double angle."""
        return np.stack(c[:2]) / max(z[:2])

    def discriminant(self) -> Array:
        """How far the line is inside the circle."""
        a, b, c = self.probe
        return np.asarray((a * a + b * b - c * c) / (a * a + b * b))

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """The angles, those of one point after those of the other."""
        middle, swing = np.arctan2(c[1], c[0]), np.arccos(-c[2] / np.hypot(c[0], c[1]))
        turns = [(middle + s * swing) / 2 + t for s in (1, -1) for t in (0.0, np.pi)]
        return [(np.cos(t), np.sin(t)) for t in turns]

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """The equation, with cosine and sine of 2u by those of u."""
        c, s = unknown
        double = [g.sub(g.square(c), g.square(s)), g.mul(g.const(2.0), g.mul(c, s))]
        return (g.add(g.dot([self.a, self.b], double), self.c),)

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredBranches:
        """Cosine and sine of 2u at both points, and of the half of that and half a turn on."""
        square = g.add(g.square(self.a), g.square(self.b))
        under = g.sub(square, g.square(self.c))
        divisor = divisor_of(g, square, tolerances, power=2)
        root, values = g.sqrt(under), []
        for w in (root, g.neg(root)):
            c = g.div(g.sub(g.neg(g.mul(self.a, self.c)), g.mul(self.b, w)), divisor.value)
            s = g.div(g.sub(g.mul(self.a, w), g.mul(self.b, self.c)), divisor.value)
            cosine, sine = (
                g.sqrt(g.mul(g.const(0.5), x)) for x in (g.add(g.one, c), g.sub(g.one, c))
            )
            sine = g.select(g.binary("gt", s, g.zero), sine, g.neg(sine))
            values += [(cosine, sine), (g.neg(cosine), g.neg(sine))]
        guard = tolerances.guard(g, under, natural_size(square), square)
        return LoweredBranches(tuple(values), divisor, (guard,) * 4, (under, square))


def find(
    equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
) -> list[Candidate]:
    """Equations in the unknown alone that have its double and no single one."""
    out, zero = [], knowledge.graph.zero
    for e, h, degree in in_harmonics(equations, unknown):
        if degree == 2 and not {(1, "c"), (1, "s")} & set(h):
            form = DoubleAngle(*(h.get(term, zero) for term in ((2, "c"), (2, "s"), (0, "c"))))
            out.append(Candidate(unknown, "double angle", form, e.sources))
    return out


DOUBLE_ANGLE = Leaf(
    "double angle", find, {"double angle": "Only the double of the unknown is left: four angles."}
)
