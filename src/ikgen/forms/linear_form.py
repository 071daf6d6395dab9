"""`A x + B = 0`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.form import Form
from ikgen.forms.formula import Formula, FormulaWriter, equals, linear_combination
from ikgen.forms.lowered_form import LoweredForm, Tolerances, divisor_of
from ikgen.formulas.notation import quotient, show
from ikgen.model.arrays import Array

__all__ = ["Linear"]


@dataclass(frozen=True, slots=True)
class Linear(Form):
    """`a x + b = 0` in an unknown length (IKBT, rule-based solver 1)."""

    name: ClassVar[str] = "linear"
    branches: ClassVar[int] = 1
    a: Expr
    b: Expr

    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """`a`"""
        return c[0][None] / z[0]

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """`-b / a`"""
        return [(-c[1] / c[0],)]

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """`a x + b`"""
        return (g.add(g.mul(self.a, unknown[0]), self.b),)

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredForm:
        """`-b / a`"""
        divisor = divisor_of(g, self.a, tolerances)
        return LoweredForm((g.div(g.neg(self.b), divisor.value),), divisor, None, 1)

    def formula(self, w: FormulaWriter) -> Formula:
        """The equation is left out where it is the solution already."""
        a, b = (w.sum(e) for e in w.e)
        equation = equals(linear_combination([(a, w.length())]), show(-b))
        shown = () if a.value == 1.0 else (equation,)
        return Formula(shown, (quotient(-b, a),), None, w.divisor(self.a))
