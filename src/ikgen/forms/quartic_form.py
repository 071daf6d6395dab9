"""`a2 cos(2u) + b2 sin(2u) + a1 cos(u) + b1 sin(u) + a0 = 0`: at most four roots."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.companion_roots import companion_roots
from ikgen.forms.form import Form
from ikgen.forms.formula import Formula, FormulaWriter, equals
from ikgen.forms.lowered_form import ROUNDED, LoweredRoutine, Tolerances, leading
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.notation import angle, show
from ikgen.model.arrays import Array
from ikgen.program.routines import TRIG_QUARTIC, TRIG_QUARTIC_WIDE

__all__ = ["TrigQuartic"]

ComplexArray = NDArray[np.complex128]

_WIDEST = 0.1
"""Imaginary part (rad) of a root that counts as real at most."""


@dataclass(frozen=True, slots=True)
class TrigQuartic(Form):
    """A trigonometric polynomial of degree two (Pieper 1968)."""

    name: ClassVar[str] = "quartic"
    branches: ClassVar[int] = 4
    remark: ClassVar[tuple[str | Math, ...]] = (
        "The unknown is a root of a polynomial of degree four. The polynomial in ",
        m.name("z") + m.relation() + m.function("exp", m.name("i") + m.name("theta")),
        " is written above; its roots on the unit circle are the real solutions. The emitted code finds "
        "them in closed form by Ferrari's resolvent, as the points where the lines of a degenerate conic "
        "meet the circle.",
    )
    a2: Expr
    b2: Expr
    a1: Expr
    b1: Expr
    a0: Expr

    @property
    def divisor_parts(self) -> tuple[Expr, ...]:
        """All coefficients but the constant."""
        return self.coefficients[:4]

    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """All coefficients but the constant."""
        return np.stack(c[:4]) / max(z[:4])

    def steepness(self, unknown: tuple[Array, ...]) -> Array | None:
        """The polynomial's derivative at the root, over the largest coefficient."""
        a2, b2, a1, b1, _ = self.probe
        c, s = unknown
        with np.errstate(all="ignore"):
            slope = 2.0 * (b2 * (c * c - s * s) - 2.0 * a2 * c * s) + b1 * c - a1 * s
            return np.asarray(np.abs(slope) / np.abs(np.stack(self.probe)).max(axis=0))

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """Roots from the companion matrix of the self-inversive polynomial in exp(i u)."""
        a2, b2, a1, b1, a0 = c
        low = np.stack([a2 - 1j * b2, a1 - 1j * b1, 2 * a0 + 0j, a1 + 1j * b1, a2 + 1j * b2])
        roots = _unit_roots(low.T)
        return [(roots[:, k].real, roots[:, k].imag) for k in range(4)]

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """The polynomial, `cos(2u)` and `sin(2u)` by the cosine and sine of u."""
        c, s = unknown
        double = [g.sub(g.square(c), g.square(s)), g.mul(g.const(2.0), g.mul(c, s))]
        return (g.add(g.dot([*self.coefficients[:4]], [*double, c, s]), self.a0),)

    def slope(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> Expr | None:
        """The polynomial's derivative at the root."""
        c, s = unknown
        double = [g.mul(g.const(-4.0), g.mul(c, s)), g.sub(g.square(c), g.square(s))]
        double[1] = g.mul(g.const(2.0), double[1])
        return g.dot([*self.coefficients[:4]], [*double, g.neg(s), c])

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredRoutine:
        """A call of `TRIG_QUARTIC`, or where rows are refined of `TRIG_QUARTIC_WIDE`: two roots that the
        file's geometry has may be as far beside the circle as it moves the polynomial's value."""
        divisor = leading(g, self.divisor_parts, tolerances)
        if tolerances.error <= ROUNDED:
            return LoweredRoutine(TRIG_QUARTIC.name, self.coefficients, divisor)
        wide = g.const(min(tolerances.clamp**0.5, _WIDEST))
        return LoweredRoutine(TRIG_QUARTIC_WIDE.name, (*self.coefficients, wide), divisor)

    def instead(self, g: ExpressionGraph, seed: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """`sin(u - seed) = 0`"""
        c, s = seed
        return g.zero, g.zero, g.neg(s), c, g.zero

    def formula(self, w: FormulaWriter) -> Formula:
        """The polynomial in cosines and sines, and in z = exp(i u)."""
        theta = angle(w.unknown.combination)
        letters = [m.name(x, i) for x, i in ("a2", "b2", "a1", "b1", "a0")]
        twice = m.number(2.0) + m.space() + theta
        marks = [
            m.function("cos", twice), m.function("sin", twice), m.function("cos", theta),
            m.function("sin", theta), Math(()),
        ]  # fmt: skip
        terms = [a + m.space() + t for a, t in zip(letters, marks, strict=True)]
        equation = equals(m.join(terms, m.plus()), m.name("0"))
        values = [equals(a, show(w.sum(e))) for a, e in zip(letters, w.e, strict=True)]
        roots = tuple(m.function("arg", m.name("z", str(i + 1))) for i in range(4))
        return Formula((equation, *values, _self_inversive(letters)), roots)


def _unit_roots(polynomials: ComplexArray) -> ComplexArray:
    """The roots (n, 4) of self-inversive polynomials (n, 5), highest power first; NaN for those that are
    off the unit circle, or infinite."""
    roots = np.full((len(polynomials), 4), np.nan + 1j * np.nan)
    size = np.abs(polynomials).max(axis=1)
    finite = np.isfinite(size)
    whole = finite & (np.abs(polynomials[:, 0]) >= 1e-13 * size) & (size > 0.0)
    roots[whole] = companion_roots(polynomials[whole])
    short = finite & ~whole & (polynomials[:, 1] != 0.0)
    roots[short, :2] = companion_roots(polynomials[short, 1:4])
    with np.errstate(invalid="ignore"):
        length = np.abs(roots)
        return np.where(np.abs(length - 1) < 1e-4, roots / length, np.nan + 1j * np.nan)


def _self_inversive(letters: list[Math]) -> Math:
    """The polynomial in z = exp(i theta) whose roots on the unit circle are the solutions."""
    a2, b2, a1, b1, a0 = letters
    i = m.name("i")
    z = m.name("z")
    low, high = m.minus(), m.plus()
    parts = [
        m.group(a2 + low + i + m.space() + b2) + m.power(z, 4),
        m.group(a1 + low + i + m.space() + b1) + m.power(z, 3),
        m.number(2.0) + m.space() + a0 + m.space() + m.power(z, 2),
        m.group(a1 + high + i + m.space() + b1) + z,
        m.group(a2 + high + i + m.space() + b2),
    ]
    return equals(m.join(parts, m.plus()), m.name("0"))
