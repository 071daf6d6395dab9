"""`A cos(u) + B sin(u) = C`."""

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
    Divisor,
    LoweredForm,
    Tolerances,
    at_least,
    divisor_of,
    natural_size,
)
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.normal_form import Sum
from ikgen.formulas.notation import quotient, show
from ikgen.model.arrays import Array

__all__ = ["SineCosine"]


@dataclass(frozen=True, slots=True)
class SineCosine(Form):
    """`a cos + b sin = c` (IKBT, rule-based solvers 2, 4 and 6)."""

    name: ClassVar[str] = "sincos"
    branches: ClassVar[int] = 2
    a: Expr
    b: Expr
    c: Expr

    @property
    def divisor_parts(self) -> tuple[Expr, ...]:
        """The amplitude."""
        return self.a, self.b

    @property
    def tangent_without(self) -> Expr:
        """The constant side."""
        return self.c

    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """The amplitude."""
        return np.stack(c[:2]) / max(z[:2])

    def fold(self, c: Sequence[Array], z: Sequence[float], unknown: Array) -> Array:
        """The equation's derivative, `b cos - a sin`, whose square is the discriminant."""
        return (c[0] * np.sin(unknown) - c[1] * np.cos(unknown))[None] / max(z[:2])

    def discriminant(self) -> Array:
        """`a^2 + b^2 - c^2`"""
        a, b, c = self.probe
        with np.errstate(all="ignore"):
            return np.asarray(1.0 - c**2 / (a**2 + b**2))

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """Where a line meets the circle."""
        a, b, r = c
        h = a * a + b * b
        w = np.sqrt(np.maximum(h - r * r, 0))
        return [((a * r - k * b * w) / h, (b * r + k * a * w) / h) for k in (1, -1)]

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """`a cos + b sin - c`"""
        return (g.sub(g.dot([self.a, self.b], [*unknown]), self.c),)

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredForm:
        """Without arctangents: cosine and sine of both intersections."""
        a, b, r = self.a, self.b, self.c
        if a.is_fixed and b.is_fixed and (a.vanishes or b.vanishes):
            return self._single(g, sigma, tolerances)
        h = g.add(g.square(a), g.square(b))
        divisor = divisor_of(g, h, tolerances, 2)
        disc = g.sub(h, g.square(r))
        guard = tolerances.guard(g, disc, natural_size(h), h)
        w = g.mul(sigma, g.sqrt(at_least(g, disc, g.mul(g.const(tolerances.fold), h))))
        inverse = g.div(g.one, divisor.value)
        cosine = g.mul(g.sub(g.mul(a, r), g.mul(b, w)), inverse)
        sine = g.mul(g.add(g.mul(b, r), g.mul(a, w)), inverse)
        return LoweredForm((cosine, sine), divisor, guard, 2, (disc, h))

    def _single(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredForm:
        """`a cos = c` or `b sin = c` with a fixed coefficient; the other of the pair takes sigma."""
        ratio = g.div(self.c, self.b if self.a.vanishes else self.a)
        disc = g.sub(g.one, g.square(ratio))
        guard = tolerances.guard(g, disc, 1.0)
        bounded = g.binary("max", g.minus_one, g.binary("min", g.one, ratio))
        other = g.mul(sigma, g.sqrt(at_least(g, disc, g.const(tolerances.fold))))
        pair = (other, bounded) if self.a.vanishes else (bounded, other)
        return LoweredForm(pair, Divisor(g.one), guard, 2, (disc, g.one))

    def formula(self, w: FormulaWriter) -> Formula:
        """asin or acos where one coefficient vanishes, else two arctangents."""
        g = w.g
        a, b, c = w.coefficients()
        equation = equals(linear_combination([(a, w.cosine()), (b, w.cosine("sin"))]), show(c))
        if a.is_zero:
            ratio = m.function("asin", quotient(c, b))
            both = (ratio, m.name("pi") + m.minus() + ratio)
            return Formula((equation,), both, _bound(c, b), w.divisor(self.b))
        if b.is_zero:
            ratio = m.function("acos", quotient(c, a))
            both = (ratio, m.minus(sign=True) + ratio)
            return Formula((equation,), both, _bound(c, a), w.divisor(self.a))
        squares = g.add(g.square(self.a), g.square(self.b))
        inside = show(w.radicand(g.sub(squares, g.square(self.c))))
        swing = m.function("atan2", m.radical(inside), show(c))
        middle = m.function("atan2", show(b), show(a))
        reach = inside + m.relation("\\ge ", "≥") + m.name("0")
        both = (middle + m.plus() + swing, middle + m.minus() + swing)
        return Formula((equation,), both, reach, w.divisor(squares))


def _bound(above: Sum, below: Sum) -> Math:
    """`|C| <= |A|`, where a sine or cosine is C / A."""
    value = below.value
    one = m.number(abs(value)) if value is not None else m.group(show(below), "||")
    if all(t.coefficient < 0 for t in above.terms):
        above = -above
    return m.group(show(above), "||") + m.relation("\\le ", "≤") + one
