"""Conditions over a form's coefficients in textbook notation."""

from __future__ import annotations

import sympy

from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.normal_form import Sum, Symbol, Term
from ikgen.formulas.notation import show

__all__ = ["condition_notation"]

_RELATIONS = {sympy.Ne: ("\\ne ", "≠"), sympy.Ge: ("\\ge ", "≥")}


def condition_notation(condition: sympy.Basic) -> Math:
    """A relation between a polynomial in the coefficients, possibly over one, and zero."""
    left = sympy.expand(condition.lhs)
    terms = tuple(_term(term) for term in sympy.Add.make_args(left))
    first = sorted(terms, key=lambda term: term.coefficient < 0)
    relation = m.relation(*_RELATIONS[type(condition)])
    return show(Sum(tuple(first))) + relation + show_zero()


def show_zero() -> Math:
    """0"""
    return show(Sum(()))


def _term(term: sympy.Expr) -> Term:
    number, rest = term.as_coeff_Mul()
    powers = sorted(rest.as_powers_dict().items(), key=str) if rest != 1 else []
    factors = tuple((Symbol("param", _indexed(str(x))), int(n)) for x, n in powers)
    return Term(float(number), factors)


def _indexed(name: str) -> str:
    """a_1 for a1."""
    return f"{name[0]}_{name[1:]}" if len(name) == 2 and name[1].isdigit() else name
