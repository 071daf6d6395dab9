"""`A x^2 + B x + C = 0`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.form import Form
from ikgen.forms.formula import Formula, FormulaWriter, equals, linear_combination
from ikgen.forms.lowered_form import (
    LoweredForm,
    Tolerances,
    divisor_of,
    natural_size,
    sign_of_squares,
)
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.notation import grouped, quotient, show
from ikgen.model.arrays import Array

__all__ = ["Quadratic"]


@dataclass(frozen=True, slots=True)
class Quadratic(Form):
    """`a x^2 + b x + c = 0` in an unknown length."""

    name: ClassVar[str] = "root"
    branches: ClassVar[int] = 2
    a: Expr
    b: Expr
    c: Expr

    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """`a`"""
        return c[0][None] / z[0]

    def discriminant(self) -> Array:
        """`b^2 - 4 a c`"""
        a, b, c = self.probe
        with np.errstate(all="ignore"):
            return np.asarray((b**2 - 4 * a * c) / (b**2 + np.abs(4 * a * c)))

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """`(-b ± sqrt(b^2 - 4 a c)) / 2 a`"""
        w = np.sqrt(np.maximum(c[1] ** 2 - 4 * c[0] * c[2], 0))
        return [((-c[1] + w) / (2 * c[0]),), ((-c[1] - w) / (2 * c[0]),)]

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """`a x^2 + b x + c`"""
        (x,) = unknown
        return (g.add(g.mul(g.add(g.mul(self.a, x), self.b), x), self.c),)

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredForm:
        """With `b / 2` in place of `b`."""
        a, b, c = self.a, self.b, self.c
        sign = sign_of_squares(a)
        if sign < 0:
            a, b, c = g.neg(a), g.neg(b), g.neg(c)
        divisor = divisor_of(g, a, tolerances, 2 if sign else 1)
        half = g.mul(g.const(0.5), b)
        disc = g.sub(g.square(half), g.mul(a, c))
        size = natural_size(disc)
        guard = tolerances.guard(g, disc, size)
        w = g.mul(sigma, g.sqrt(disc))
        value = g.div(g.sub(w, half), divisor.value)
        return LoweredForm((value,), divisor, guard, 2, (disc, g.const(size)))

    def formula(self, w: FormulaWriter) -> Formula:
        """The roots as short as the coefficients allow."""
        a, b, c = (w.sum(e) for e in w.e)
        x = w.length()
        equation = equals(linear_combination([(a, m.power(x, 2)), (b, x)]), show(-c))
        if b.is_zero:
            over = quotient(-c, a)
            both = (m.radical(over), m.minus(sign=True) + m.radical(over))
            return Formula((equation,), both, over, w.divisor(self.a))
        g = w.g
        under = g.sub(g.square(self.b), g.mul(g.const(4.0), g.mul(self.a, self.c)))
        if a.value is not None:
            return self._monic(w, equation, under, a.value)
        inside = show(w.radicand(under))
        below = m.number(2.0) + m.space() + grouped(a)
        tops = (m.minus(sign=True) + grouped(b) + s + m.radical(inside) for s in _signs())
        return Formula(
            (equation,), tuple(m.fraction(top, below) for top in tops), inside, w.divisor(self.a)
        )

    def _monic(self, w: FormulaWriter, equation: Math, under: Expr, a: float) -> Formula:
        """For a number as leading coefficient."""
        g = w.g
        half = w.sum(g.mul(g.const(-0.5 / a), self.b))
        quarter = show(w.radicand(g.mul(g.const(0.25 / a**2), under)))
        start = Math(()) if half.is_zero else show(half)
        both = tuple(start + sign + m.radical(quarter) for sign in _signs())
        return Formula((equation,), both, quarter)


def _signs() -> tuple[Math, Math]:
    return m.plus(), m.minus()
