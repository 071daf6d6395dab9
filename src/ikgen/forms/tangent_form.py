"""`K cos(u) = X`, `K sin(u) = Y` with an unknown factor K of either sign."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.form import Form
from ikgen.forms.formula import Formula, FormulaWriter, equals
from ikgen.forms.lowered_form import LoweredForm, Tolerances, divisor_of
from ikgen.formulas import mathtext as m
from ikgen.formulas.notation import show
from ikgen.model.arrays import Array

__all__ = ["Tangent"]


@dataclass(frozen=True, slots=True)
class Tangent(Form):
    """`K cos = x`, `K sin = y` (IKBT, rule-based solver 3)."""

    name: ClassVar[str] = "tangent"
    branches: ClassVar[int] = 2
    x: Expr
    y: Expr

    @property
    def divisor_parts(self) -> tuple[Expr, ...]:
        """Both sides."""
        return self.x, self.y

    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """Both sides."""
        return np.stack(c[:2]) / max(z[:2])

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """The direction and its opposite."""
        h = np.hypot(c[0], c[1])
        return [(k * c[0] / h, k * c[1] / h) for k in (1, -1)]

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """`x sin - y cos`: the factor of both is gone."""
        c, s = unknown
        return (g.sub(g.mul(self.x, s), g.mul(self.y, c)),)

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredForm:
        """The direction, normalized, times sigma."""
        h = g.add(g.square(self.x), g.square(self.y))
        divisor = divisor_of(g, h, tolerances, 2)
        inverse = g.div(sigma, g.sqrt(divisor.value))
        return LoweredForm((g.mul(self.x, inverse), g.mul(self.y, inverse)), divisor, None, 2)

    def formula(self, w: FormulaWriter) -> Formula:
        """Two arctangents, half a turn apart."""
        x, y = (w.sum(e) for e in w.e)
        k = m.name("K") + m.space()
        equations = (equals(k + w.cosine(), show(x)), equals(k + w.cosine("sin"), show(y)))
        both = (m.function("atan2", show(y), show(x)), m.function("atan2", show(-y), show(-x)))
        either = w.g.add(w.g.square(self.x), w.g.square(self.y))
        return Formula(equations, both, None, w.divisor(either))
