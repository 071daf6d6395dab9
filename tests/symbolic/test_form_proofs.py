"""Every form's formula is proved to solve its pattern, and wrong ones are found out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
import sympy

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.errors import UsageError
from ikgen.forms.form import Form
from ikgen.forms.linear_form import Linear
from ikgen.forms.lowered_form import LoweredForm, Tolerances
from ikgen.forms.pair_form import LinearPair
from ikgen.forms.quadratic_form import Quadratic
from ikgen.forms.quartic_form import TrigQuartic
from ikgen.forms.sine_cosine_form import SineCosine
from ikgen.forms.tangent_form import Tangent
from ikgen.forms.trig_polynomial_form import TrigPolynomial
from ikgen.symbolic.form_branches import alternatives
from ikgen.symbolic.form_proofs import prove_form
from ikgen.symbolic.lowered_view import LoweredView
from ikgen.symbolic.trig_polynomial_root import TrigPolynomialRoot
from ikgen.symbolic.trig_quartic_root import TrigQuarticRoot

V, C, O = "variable", "constant", "zero"  # noqa: E741
CASES = [
    (Linear, (V, V)), (Linear, (C, V)),
    (Quadratic, (V, V, V)), (Quadratic, (C, O, V)),
    (LinearPair, (V,) * 6), (LinearPair, (C, O, V, O, C, V)), (LinearPair, (O, C, V, C, V, V)),
    (SineCosine, (V, V, V)), (SineCosine, (C, C, V)), (SineCosine, (C, O, V)), (SineCosine, (O, C, V)),
    (SineCosine, (V, O, V)),
    (Tangent, (V, V)),
    (TrigQuartic, (V,) * 5), (TrigQuartic, (V, O, V, V, V)),
]  # fmt: skip


@pytest.mark.parametrize(("form", "kinds"), CASES)
def test_form_solves_its_pattern(form: type[Form], kinds: tuple[str, ...]) -> None:
    proof = prove_form(form, kinds)
    assert proof.solves and proof.complete, proof.reason


def test_conditions_are_the_divisor_and_the_radicand() -> None:
    a, b, c = sympy.symbols("a b c", real=True)
    found = set(prove_form(SineCosine, (V, V, V)).conditions)
    assert found == {sympy.Ne(a**2 + b**2, 0), sympy.Ge(a**2 + b**2 - c**2, 0)}


@dataclass(frozen=True, slots=True)
class WrongSign(Quadratic):
    """The roots of `a x^2 - b x + c`."""

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredForm:
        return Quadratic(self.a, g.neg(self.b), self.c).lower(g, sigma, tolerances)


@dataclass(frozen=True, slots=True)
class OneRoot(Quadratic):
    """One root of two."""

    branches: ClassVar[int] = 1

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredForm:
        made = Quadratic(self.a, self.b, self.c).lower(g, g.one, tolerances)
        return LoweredForm(made.values, made.divisor, made.guard, 1, made.under)


@dataclass(frozen=True, slots=True)
class Silent(Linear):
    """A form that does not say what it solves."""

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        return ()


def test_a_wrong_branch_is_found_out() -> None:
    proof = prove_form(WrongSign, (V, V, V))
    assert not proof.solves and "does not solve" in proof.reason


def test_a_missing_branch_is_found_out() -> None:
    proof = prove_form(OneRoot, (V, V, V))
    assert proof.solves and not proof.complete and "may be in no branch" in proof.reason


def test_a_form_without_a_pattern_is_not_proved() -> None:
    proof = prove_form(Silent, (V, V))
    assert not proof.proved and "does not say" in proof.reason


@pytest.mark.parametrize(("form", "kinds"), [case for case in CASES if case[0] is not TrigQuartic])
def test_textbook_and_emitted_formulas_agree(form: type[Form], kinds: tuple[str, ...]) -> None:
    view = LoweredView(form, kinds)
    given = view.coefficients
    textbook = alternatives(view.form, given).values
    at = {s: sympy.Rational(k + 7, 9) for k, s in enumerate(given) if s.is_Symbol}
    at = {s: x / (3 if s is given[-1] else 1) for s, x in at.items()}
    signs = (1, -1) if len(textbook) == 2 else (1,)
    emitted = {_angle(view.value(sign).xreplace(at)) for sign in signs}
    assert {_angle(value.xreplace(at)) for value in textbook} == emitted


def _angle(value: sympy.Expr) -> tuple[str, str]:
    """The value, angles up to whole turns."""
    n = sympy.N(value, 30)
    return str(sympy.N(sympy.cos(n), 12)), str(sympy.N(sympy.sin(n), 12))


def test_roots_of_a_trigonometric_polynomial_of_any_degree() -> None:
    u = sympy.Symbol("u", real=True)
    terms = [(4, 0.3, -0.8), (5, 1.1, 0.2), (9, -0.4, 0.6)]
    flat = [x for term in terms for x in term]
    low, high, a0 = -0.6, 1.1, 0.1
    left = a0 + sum(a * sympy.cos(n * u) + b * sympy.sin(n * u) for n, a, b in terms)
    values = sympy.lambdify(u, left, "numpy")(np.linspace(low, high, 20_001))
    count = int((np.diff(values > 0.0) != 0).sum())
    roots = [TrigPolynomialRoot(k, low, high, a0, *flat).evalf() for k in range(count + 1)]
    assert count > 2 and roots[count] is sympy.nan
    assert all(abs(float(left.subs(u, x))) < 1e-12 for x in roots[:count])
    assert all(low <= x <= high for x in roots[:count])
    arrays = sympy.lambdify(u, TrigPolynomialRoot(1, low, high, u, *flat), "numpy")
    assert abs(arrays(np.array([a0, 9.0]))[0] - float(roots[1])) < 1e-12
    assert np.isnan(arrays(np.array([a0, 9.0]))[1])


def test_a_trigonometric_polynomial_of_a_high_degree_is_not_written() -> None:
    terms = [sympy.Symbol(x) for x in ("a", "b", "a0")]
    made = alternatives(TrigPolynomial((), (5,), (-1.0, 1.0)), terms)
    assert len(made.values) == 5 and made.values[0].func is TrigPolynomialRoot
    with pytest.raises(UsageError, match="degree 12,000 has no roots in SymPy"):
        alternatives(TrigPolynomial((), (12_000,), (-1e-3, 1e-3)), terms)
    assert prove_form(TrigPolynomial, (V, V, V)).proved


def test_roots_of_a_trigonometric_polynomial() -> None:
    u = sympy.Symbol("u", real=True)
    given = [sympy.Rational(x, 10) for x in (11, -4, 3, 7, -2)]
    a2, b2, a1, b1, a0 = given
    left = (
        a2 * sympy.cos(2 * u) + b2 * sympy.sin(2 * u) + a1 * sympy.cos(u) + b1 * sympy.sin(u) + a0
    )
    roots = [float(TrigQuarticRoot(*given, k).evalf()) for k in range(4)]
    assert roots == sorted(roots) and len({round(x, 6) for x in roots}) == 4
    assert all(abs(float(left.subs(u, x))) < 1e-12 for x in roots)
    arrays = sympy.lambdify(u, TrigQuarticRoot(*given[:4], u, 2), "numpy")(np.array([-0.2, 9.0]))
    assert abs(arrays[0] - roots[2]) < 1e-12 and np.isnan(arrays[1])
