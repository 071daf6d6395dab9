"""`a0 + sum(a_i cos(n_i u) + b_i sin(n_i u)) = 0`, of any degree: what a geared joint leaves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ikgen.algebra.angle_sums import angle_sum
from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.form import Form
from ikgen.forms.formula import Formula, FormulaWriter, equals
from ikgen.forms.lowered_form import LoweredRoutine, Tolerances, leading
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.notation import angle, show
from ikgen.model.arrays import Array
from ikgen.program.routines import TRIG_POLYNOMIAL
from ikgen.runtime.python.roots.trig_polynomial_roots import trig_polynomial_roots

__all__ = ["CIRCLE", "TrigPolynomial", "most_roots"]

_TOUCH = 1e-3
"""By how much (rad) the imaginary part of a pair of roots that counts as one moves the fastest term."""

_WIDEST = 0.1
"""The same where rows are refined, at most."""

CIRCLE = (-2.9, -2.9 + 2.0 * math.pi + 1e-5)
"""The whole circle, and a little more than once, so that a root where it begins is inside; that is at no
angle where arms often have one."""

_MORE = 4
"""By how many roots a polynomial has more in an interval than its fastest term, of arms: the exponentials
allow twice the number of terms, which may be dozens."""


def most_roots(harmonics: Sequence[int], span: float) -> int:
    """How many roots a trigonometric polynomial of these harmonics has at most in an interval of length
    `span` (rad): on the circle twice as many as its degree, in a part of it `_MORE` than the fastest term
    has, or fewer where the exponentials in it allow fewer.

    M. Voorhoeve, Zeros of exponential polynomials, 1977: `m` exponentials whose frequencies lie `d` apart
    at most have `m - 1 + d span / (2 pi)` real zeros in an interval at most.
    """
    fastest = max(harmonics)
    if span > 2.0 * math.pi * (1.0 - 1e-9):
        return 2 * fastest
    return math.floor(fastest * span / math.pi) + min(2 * len(harmonics), _MORE)


@dataclass(frozen=True, slots=True)
class TrigPolynomial(Form):
    """A trigonometric polynomial: `terms` are a and b of each of the `harmonics`, then a0; its roots are
    looked for in `span` (rad)."""

    name: ClassVar[str] = "trigonometric polynomial"
    remark: ClassVar[tuple[str | Math, ...]] = (
        "The unknown is a root of the trigonometric polynomial above. The emitted code finds all that "
        "lie where the joint's values are looked for: intervals are halved until bounds of the derivatives "
        "show that a part has no root, or that the polynomial goes or bends one way there: then signs "
        "tell.",
    )
    terms: tuple[Expr, ...]
    harmonics: tuple[int, ...]
    span: tuple[float, float]

    @property
    def branches(self) -> int:  # type: ignore[override]
        """How many roots there are at most."""
        return most_roots(self.harmonics, self.span[1] - self.span[0])

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The coefficients of the terms, and the constant."""
        return self.terms

    @property
    def divisor_parts(self) -> tuple[Expr, ...]:
        """All coefficients but the constant."""
        return self.terms[:-1]

    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """All coefficients but the constant."""
        return np.stack(c[:-1]) / max(z[:-1])

    def steepness(self, unknown: tuple[Array, ...]) -> Array | None:
        """The polynomial's derivative at the root, over the largest coefficient of a derivative."""
        t = np.arctan2(unknown[1], unknown[0])
        slope = np.zeros_like(t)
        for i, n in enumerate(self.harmonics):
            a, b = (self.terms[2 * i + k].probe for k in (0, 1))
            slope += n * (b * np.cos(n * t) - a * np.sin(n * t))
        with np.errstate(all="ignore"):
            size = np.abs(np.stack(self.probe)).max(axis=0) * max(self.harmonics)
            return np.asarray(np.abs(slope) / size)

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """The roots in the interval."""
        a, b = (np.stack(c[k:-1:2], axis=1) for k in (0, 1))
        n = np.array(self.harmonics, dtype=float)
        roots = trig_polynomial_roots(n, a, b, np.array(c[-1]), self.span, _TOUCH, self.branches)
        return [(np.cos(t), np.sin(t)) for t in roots.T]

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """The polynomial, with multiples of u by the cosine and sine of u."""
        return (g.add(g.dot([*self.terms[:-1]], self._multiples(g, unknown)), self.terms[-1]),)

    def slope(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> Expr | None:
        """The polynomial's derivative at the root."""
        multiples = self._multiples(g, unknown)
        turned = []
        for i, n in enumerate(self.harmonics):
            c, s = multiples[2 * i : 2 * i + 2]
            turned += [g.mul(g.const(-float(n)), s), g.mul(g.const(float(n)), c)]
        return g.dot([*self.terms[:-1]], turned)

    def _multiples(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> list[Expr]:
        """Cosine and sine of each multiple of u."""
        return [x for n in self.harmonics for x in _multiple(g, n, unknown)]

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredRoutine:
        """A call of `TRIG_POLYNOMIAL`; where rows are refined, two roots that the file's
        geometry has may be as far beside the real ones as it moves the polynomial's value."""
        divisor = leading(g, self.divisor_parts, tolerances)
        touch = min(max(tolerances.clamp**0.5, _TOUCH), _WIDEST)
        numbers = (*self.harmonics, *self.span, touch, self.branches)
        rest = tuple(g.const(float(x)) for x in numbers)
        return LoweredRoutine(TRIG_POLYNOMIAL.name, (*self.terms, *rest), divisor)

    def instead(self, g: ExpressionGraph, seed: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """`sin(n (u - seed)) = 0` with the least harmonic n"""
        c, s = _multiple(g, self.harmonics[0], seed)
        return g.neg(s), c, *[g.zero] * (len(self.terms) - 2)

    def formula(self, w: FormulaWriter) -> Formula:
        """The polynomial in cosines and sines, and where its roots are looked for."""
        theta = angle(w.unknown.combination)
        letters = [m.name(x, str(n)) for n in self.harmonics for x in "ab"]
        marks = [
            m.function(f, (m.number(float(n)) + m.space() if n > 1 else Math(())) + theta)
            for n in self.harmonics
            for f in ("cos", "sin")
        ]
        parts = [a + m.space() + t for a, t in zip(letters, marks, strict=True)]
        constant = m.name("a", "0")
        equation = equals(m.join([*parts, constant], m.plus()), m.name("0"))
        values = [equals(a, show(w.sum(e))) for a, e in zip([*letters, constant], w.e, strict=True)]
        roots = tuple(m.name("t", str(i + 1)) for i in range(self.branches))
        return Formula((equation, *values), roots)


def _multiple(g: ExpressionGraph, n: int, unknown: tuple[Expr, ...]) -> tuple[Expr, Expr]:
    """Cosine and sine of n times an angle, by doubling."""
    c, s = unknown
    found: tuple[Expr, Expr] | None = None
    turn = c, s
    while n:
        if n % 2:
            found = turn if found is None else angle_sum(g, found, turn)
        n //= 2
        if n:
            turn = angle_sum(g, turn, turn)
    assert found is not None
    return found
