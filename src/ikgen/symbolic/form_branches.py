"""The alternatives of each solution form as SymPy expressions of its coefficients.

The same formulas as in textbooks and in the report; a form that is not among them, of another package
say, is written as it is lowered.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import sympy

from ikgen.errors import UsageError
from ikgen.forms.form import Form
from ikgen.forms.linear_form import Linear
from ikgen.forms.pair_form import LinearPair
from ikgen.forms.quadratic_form import Quadratic
from ikgen.forms.quartic_form import TrigQuartic
from ikgen.forms.sine_cosine_form import SineCosine
from ikgen.forms.tangent_form import Tangent
from ikgen.forms.trig_polynomial_form import CIRCLE, TrigPolynomial
from ikgen.symbolic.lowered_view import LoweredView
from ikgen.symbolic.trig_polynomial_root import MOST_DEGREE, TrigPolynomialRoot
from ikgen.symbolic.trig_quartic_root import TrigQuarticRoot

__all__ = ["Alternatives", "alternatives"]

Expression: TypeAlias = sympy.Expr
_SIGNS = (1, -1)


@dataclass(frozen=True, slots=True)
class Alternatives:
    """Values of the unknown (an angle or a length), what must not vanish for them to hold (`divisor`,
    None for a constant), and what must not be negative for them to be real (`radicand`)."""

    values: tuple[Expression, ...]
    divisor: Expression | None = None
    radicand: Expression | None = None

    @property
    def conditions(self) -> tuple[sympy.Basic, ...]:
        """Both as SymPy conditions; what SymPy knows to hold is left out."""
        found = []
        if self.radicand is not None:
            found.append(sympy.Ge(self.radicand, 0))
        if self.divisor is not None:
            found.append(sympy.Ne(self.divisor, 0))
        return tuple(one for one in found if one is not sympy.true)


def alternatives(form: Form, coefficients: Sequence[Expression]) -> Alternatives:
    """The form's alternatives with these coefficients, in the order of the form's branches.

    Raises `UsageError` for a trigonometric polynomial of too high a degree.
    """
    if isinstance(form, TrigPolynomial):
        return _trig_polynomial(form, coefficients)
    textbook = _TEXTBOOK.get(type(form))
    return textbook(*coefficients) if textbook else _as_lowered(form, coefficients)


def _linear(a: Expression, b: Expression) -> Alternatives:
    return Alternatives((-b / a,), a)


def _quadratic(a: Expression, b: Expression, c: Expression) -> Alternatives:
    if b == 0:
        square = -c / a
        return Alternatives((sympy.sqrt(square), -sympy.sqrt(square)), a, square)
    half, disc = b / (2 * a), sympy.expand(b**2 - 4 * a * c)
    root = sympy.sqrt(disc) / (2 * a)
    return Alternatives((root - half, -root - half), a, disc)


def _pair(
    a1: Expression, b1: Expression, c1: Expression, a2: Expression, b2: Expression, c2: Expression
) -> Alternatives:
    det = a1 * b2 - b1 * a2
    x, y = c1 * b2 - c2 * b1, a1 * c2 - a2 * c1
    return Alternatives((sympy.atan2(y / det, x / det),), det)


def _sine_cosine(a: Expression, b: Expression, c: Expression) -> Alternatives:
    if a == 0:
        angle = sympy.asin(c / b)
        return Alternatives((angle, sympy.pi - angle), b, b**2 - c**2)
    if b == 0:
        angle = sympy.acos(c / a)
        return Alternatives((angle, -angle), a, a**2 - c**2)
    disc = a**2 + b**2 - c**2
    middle, swing = sympy.atan2(b, a), sympy.atan2(sympy.sqrt(disc), c)
    return Alternatives((middle + swing, middle - swing), a**2 + b**2, disc)


def _tangent(x: Expression, y: Expression) -> Alternatives:
    return Alternatives((sympy.atan2(y, x), sympy.atan2(-y, -x)), x**2 + y**2)


def _quartic(
    a2: Expression, b2: Expression, a1: Expression, b1: Expression, a0: Expression
) -> Alternatives:
    values = tuple(TrigQuarticRoot(a2, b2, a1, b1, a0, k) for k in range(4))
    return Alternatives(values, a2**2 + b2**2)


def _trig_polynomial(form: TrigPolynomial, coefficients: Sequence[Expression]) -> Alternatives:
    if max(form.harmonics) > MOST_DEGREE:
        raise UsageError(
            f"a trigonometric polynomial of degree {max(form.harmonics):,} has no roots in SymPy's numbers",
            hint="leave the SymPy output out; the emitted solvers find the roots",
        )
    *parts, constant = coefficients
    triples = zip(form.harmonics, parts[::2], parts[1::2], strict=True)
    terms = [x for triple in triples for x in triple]
    span = (-math.pi, math.pi) if form.span == CIRCLE else form.span
    values = [TrigPolynomialRoot(k, *span, constant, *terms) for k in range(form.branches)]
    return Alternatives(tuple(values), sum((x**2 for x in parts), sympy.S.Zero))


def _as_lowered(form: Form, coefficients: Sequence[Expression]) -> Alternatives:
    """The form as every output language computes it."""
    view = LoweredView(type(form), tuple(_kind(c) for c in coefficients))
    put_in = dict(zip(view.coefficients, coefficients, strict=True))
    signs = _SIGNS if form.branches == 2 else (1,)
    values = tuple(view.value(sign).xreplace(put_in) for sign in signs)
    radicand = view.radicand.xreplace(put_in) if view.radicand is not None else None
    return Alternatives(values, view.divisor.xreplace(put_in), radicand)


def _kind(coefficient: Expression) -> str:
    return "zero" if coefficient == 0 else "variable"


_TEXTBOOK: dict[type[Form], Callable[..., Alternatives]] = {
    Linear: _linear,
    Quadratic: _quadratic,
    LinearPair: _pair,
    SineCosine: _sine_cosine,
    Tangent: _tangent,
    TrigQuartic: _quartic,
}
