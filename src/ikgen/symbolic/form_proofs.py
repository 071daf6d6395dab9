"""Proof that a form's formula solves its pattern: nothing else, and nothing less.

Over polynomials in the coefficients, the unknown and the square roots, modulo what each root's square
is and with an inverse of the divisor (Rabinowitsch's trick): every branch makes the pattern vanish, and
where the pattern vanishes the unknown is that of a branch (D. Cox, J. Little, D. O'Shea, Ideals,
Varieties, and Algorithms, chapter 4, section 2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy

from ikgen.forms.form import Form
from ikgen.forms.quartic_form import TrigQuartic
from ikgen.forms.trig_polynomial_form import TrigPolynomial
from ikgen.symbolic.lowered_view import Kind, LoweredView, NotAlgebraicError
from ikgen.symbolic.trig_quartic_root import TrigQuarticRoot

__all__ = ["FormProof", "kinds_of", "prove_form"]


_TESTED = "the routine of the emitted code that finds the roots is tested, not proved"


@dataclass(frozen=True, slots=True)
class FormProof:
    """What was proved of a form: `solves`, every branch solves the pattern; `complete`, there are no
    other solutions; the `conditions` under which both hold, over the coefficients. `reason` says what
    is not."""

    form: str
    solves: bool
    complete: bool
    conditions: tuple[sympy.Basic, ...] = ()
    reason: str = ""

    @property
    def proved(self) -> bool:
        """Whether both are."""
        return self.solves and self.complete


def kinds_of(form: Form) -> tuple[Kind, ...]:
    """What is known of each coefficient of a form."""

    def kind(e: Any) -> Kind:
        if e.is_fixed:
            return "zero" if e.vanishes else "constant"
        return "variable"

    return tuple(kind(e) for e in form.coefficients)


@cache
def prove_form(form: type[Form], kinds: tuple[Kind, ...]) -> FormProof:
    """The proof for a class of forms with coefficients of these kinds."""
    if form is TrigQuartic:
        return _quartic(kinds)
    if form is TrigPolynomial:
        return FormProof(form.name, True, True, reason=_TESTED)
    try:
        view = LoweredView(form, kinds)
        return _prove(view, form.name)
    except NotAlgebraicError as error:
        return FormProof(form.name, False, False, reason=error.message)


def _prove(view: LoweredView, name: str) -> FormProof:
    angle = len(view.lowered.values) == 2
    unknown = _unknown_nodes(view, angle)
    pattern = view.form.pattern(view.graph, unknown)
    if not pattern:
        return FormProof(
            name, False, False, reason="the form does not say which equation it solves"
        )
    symbols = [view.convert(node) for node in unknown]
    given = [view.convert(node) for node in pattern]
    roots = _Roots()
    divisor = sympy.numer(sympy.together(view.divisor))
    inverse = sympy.Dummy("inverse")
    branches = [[roots(v) for v in view.values(sign)] for sign in _signs(view)]
    fixed = [*roots.relations, inverse * divisor - 1]
    unit = [symbols[0] ** 2 + symbols[1] ** 2 - 1] if angle else []
    circle = unit if view.form.on_circle else []
    solves = all(_all_in(fixed, _put(given + circle, symbols, values)) for values in branches)
    complete = _all_in([*given, *unit, *fixed], _products(symbols, branches))
    missing = [] if solves else ["a branch does not solve the equation"]
    missing += [] if complete else ["a solution may be in no branch"]
    return FormProof(name, solves, complete, _conditions(view), "; ".join(missing))


def _unknown_nodes(view: LoweredView, angle: bool) -> tuple[Any, ...]:
    names = ("cosine", "sine") if angle else ("x",)
    g = view.graph
    return tuple(g.atom("coefficient", name, g.one.probe, unknown=False) for name in names)


def _signs(view: LoweredView) -> tuple[int, ...]:
    return (1, -1) if view.lowered.branches == 2 else (1,)


def _conditions(view: LoweredView) -> tuple[sympy.Basic, ...]:
    radicand = view.radicand
    found = [sympy.Ne(view.divisor, 0)]
    if radicand is not None:
        found.append(sympy.Ge(radicand, 0))
    return tuple(one for one in found if one is not sympy.true)


class _Roots:
    """Square roots as generators: `relations` says what their squares are."""

    def __init__(self) -> None:
        self._names: dict[sympy.Expr, sympy.Symbol] = {}
        self.relations: list[sympy.Expr] = []

    def __call__(self, e: sympy.Expr) -> sympy.Expr:
        half = sympy.Rational(1, 2)

        def named(base: sympy.Expr, exponent: sympy.Expr) -> sympy.Expr:
            if base not in self._names:
                root = self._names[base] = sympy.Dummy(f"root{len(self._names)}")
                above, below = sympy.fraction(sympy.together(base))
                self.relations.append(below * root**2 - above)
            return self._names[base] ** (2 * exponent)

        return e.replace(
            lambda x: x.is_Pow and x.exp.is_Rational and x.exp.q == 2,
            lambda x: named(x.base, sympy.Integer(x.exp.p) * half),
        )


def _put(
    given: Sequence[sympy.Expr], symbols: Sequence[sympy.Expr], values: Sequence[sympy.Expr]
) -> list[sympy.Expr]:
    """The expressions with values for the unknown: numerators."""
    put_in = dict(zip(symbols, values, strict=True))
    return [sympy.numer(sympy.together(e.xreplace(put_in))) for e in given]


def _products(
    symbols: Sequence[sympy.Expr], branches: Sequence[Sequence[sympy.Expr]]
) -> list[sympy.Expr]:
    """What vanishes exactly where the unknown is that of one of the branches: the coefficients of
    `prod_branches(w . (unknown - values))` by powers of a weight w, which is free."""
    weight = sympy.Dummy("weight")
    product = sympy.S.One
    for values in branches:
        differences = [x - v for x, v in zip(symbols, values, strict=True)]
        total = sum(d * weight**i for i, d in enumerate(differences))
        product *= sympy.numer(sympy.together(total))
    return list(sympy.Poly(sympy.expand(product), weight).coeffs())


def _all_in(relations: Sequence[sympy.Expr], targets: Sequence[sympy.Expr]) -> bool:
    """Whether polynomials lie in the ideal of others."""
    targets = [e for e in map(sympy.expand, targets) if e != 0]
    if not targets:
        return True
    generators = sorted(set().union(*(e.free_symbols for e in (*relations, *targets))), key=str)
    basis = sympy.groebner(list(relations), *generators, order="grevlex")
    return all(basis.contains(e) for e in targets)


def _quartic(kinds: tuple[Kind, ...]) -> FormProof:
    """With `z = exp(i u)` the equation, times `2 z^2`, is the polynomial in z."""
    view = _quartic_symbols(kinds)
    a2, b2, a1, b1, a0 = view
    c, s = sympy.symbols("cosine sine", real=True)
    z = c + sympy.I * s
    pattern = a2 * (c**2 - s**2) + 2 * b2 * c * s + a1 * c + b1 * s + a0
    polynomial = TrigQuarticRoot(a2, b2, a1, b1, a0, 0).polynomial(z)
    difference = sympy.expand(polynomial - 2 * z**2 * pattern)
    proved = bool(sympy.expand(sympy.rem(difference, s**2 + c**2 - 1, s)) == 0)
    conditions = (sympy.Ne(a2**2 + b2**2, 0),)
    return FormProof(TrigQuartic.name, proved, proved, conditions, _TESTED)


def _quartic_symbols(kinds: tuple[Kind, ...]) -> list[sympy.Expr]:
    names = ("a2", "b2", "a1", "b1", "a0")
    return [
        sympy.S.Zero if kind == "zero" else sympy.Symbol(name, real=True)
        for name, kind in zip(names, kinds, strict=True)
    ]
