"""Two equations `A_i cos(u) + B_i sin(u) = C_i`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.form import Form
from ikgen.forms.formula import Formula, FormulaWriter, equals, linear_combination
from ikgen.forms.lowered_form import LoweredForm, Tolerances, divisor_of
from ikgen.formulas import mathtext as m
from ikgen.formulas.notation import quotient, show
from ikgen.model.arrays import Array

__all__ = ["LinearPair"]

_ALIKE = 1e-13


def _alike(one: Array, other: Array, size: float) -> bool:
    """Whether two coefficients are the same at all probes but for round-off."""
    return bool(np.all(np.abs(one - other) <= _ALIKE * size))


def _core(e: Expr) -> Expr:
    """What is left of an expression without its constant factors and its sign."""
    while e.op == "neg" or (e.op == "mul" and any(one.is_fixed for one in e.args)):
        e = e.args[-1] if e.args[0].is_fixed else e.args[0]
    return e


@dataclass(frozen=True, slots=True)
class LinearPair(Form):
    """`a1 cos + b1 sin = c1`, `a2 cos + b2 sin = c2` (IKBT, rule-based solver 5)."""

    name: ClassVar[str] = "pair"
    branches: ClassVar[int] = 1
    on_circle: ClassVar[bool] = False
    a1: Expr
    b1: Expr
    c1: Expr
    a2: Expr
    b2: Expr
    c2: Expr

    @property
    def divisor_parts(self) -> tuple[Expr, ...]:
        """The matrix."""
        return self.a1, self.b1, self.a2, self.b2

    @property
    def rotation(self) -> int:
        """1 or -1 where the matrix is a rotation, or a reflection, times a length: the determinant is the
        square of that then, with this sign; else 0."""
        for sign in (1, -1):
            pairs = ((self.a1, sign, self.b2), (self.b1, -sign, self.a2))
            if all(_alike(x.probe, s * y.probe, x.scale + y.scale) for x, s, y in pairs):
                return sign
        return 0

    @property
    def turns_scaled(self) -> bool:
        """Whether the second row is the first one turned by a right angle, times a number: the determinant
        is a square then, times that number."""
        if _core(self.a1) is not _core(self.b2) or _core(self.b1) is not _core(self.a2):
            return False
        a1, b1, a2, b2 = (x.probe for x in self.divisor_parts)
        size = (self.a1.scale + self.b1.scale) * (self.a2.scale + self.b2.scale)
        return _alike(a1 * a2, -b1 * b2, size)

    @property
    def is_determinant(self) -> bool:
        """Whether it is no sum of squares."""
        return self.rotation == 0

    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """The determinant, or both parts of the length that it is the square of."""
        if not self.is_determinant:
            return np.array([c[0], c[3]]) / float(np.hypot(z[0], z[3]))
        size = z[0] * z[4] + z[1] * z[3]
        return (c[0] * c[4] - c[1] * c[3])[None] / size

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """Cramer's rule."""
        det = c[0] * c[4] - c[1] * c[3]
        return [((c[2] * c[4] - c[5] * c[1]) / det, (c[0] * c[5] - c[3] * c[2]) / det)]

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """Both equations."""
        rows = (([self.a1, self.b1], self.c1), ([self.a2, self.b2], self.c2))
        return tuple(g.sub(g.dot(row, [*unknown]), c) for row, c in rows)

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredForm:
        """Cramer's rule with one division; by a rotation the constant sides are turned back, over its
        length squared."""
        sign = self.rotation
        y = g.sub(g.mul(self.a1, self.c2), g.mul(self.a2, self.c1))
        if sign == 0:
            det = g.sub(g.mul(self.a1, self.b2), g.mul(self.b1, self.a2))
            x = g.sub(g.mul(self.c1, self.b2), g.mul(self.c2, self.b1))
        else:
            det = g.dot([self.a1, self.a2], [self.a1, self.a2])
            x = g.dot([self.a1, self.a2], [self.c1, self.c2])
            y = y if sign > 0 else g.neg(y)
        divisor = divisor_of(g, det, tolerances, 2 if sign else 1, squared=self.turns_scaled)
        if det.is_fixed:
            return LoweredForm((g.div(x, det), g.div(y, det)), divisor, None, 1)
        inverse = g.div(g.one, divisor.value)
        return LoweredForm((g.mul(x, inverse), g.mul(y, inverse)), divisor, None, 1)

    def formula(self, w: FormulaWriter) -> Formula:
        """One arctangent; the determinant is left out where its sign is known."""
        det = w.minor(0, 4, 3, 1)
        sums = [w.sum(e) for e in w.e] if det.is_const else w.coefficients()
        a1, b1, c1, a2, b2, c2 = sums
        both = (w.cosine(), w.cosine("sin"))
        equations = tuple(
            equals(linear_combination([(a, both[0]), (b, both[1])]), show(c))
            for a, b, c in ((a1, b1, c1), (a2, b2, c2))
        )
        up, across = w.minor(0, 5, 3, 2), w.minor(2, 4, 5, 1)
        if np.all(det.probe <= 1e-12 * det.scale):
            det, up, across = w.g.neg(det), w.g.neg(up), w.g.neg(across)
        below, y, x = w.sum(det), w.sum(up), w.sum(across)
        if bool(np.all(det.probe >= -1e-12 * det.scale)) or below.value is not None:
            arguments = (show(y), show(x))
        else:
            arguments = (quotient(y, below), quotient(x, below))
        return Formula(equations, (m.function("atan2", *arguments),), None, w.divisor(det))
