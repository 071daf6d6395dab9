"""Leaves written in SymPy: an equation and its solutions, compiled to a form and proved before use."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import sympy

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import harmonics, powers
from ikgen.errors import PlugInError
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import Leaf
from ikgen.symbolic.form_proofs import prove_form
from ikgen.symbolic.sympy_form import Recipe, SympyForm, form_class

__all__ = ["sympy_leaf"]

Key = int | tuple[int, str]
Slots = Mapping[Key, sympy.Expr]


def sympy_leaf(
    name: str, unknown: sympy.Symbol, equation: sympy.Expr, *solutions: sympy.Expr
) -> Leaf:
    """The leaf for equations `equation = 0` in one unknown, with one or two `solutions`.

    A length occurs in powers, an angle as `cos(u)`, `sin(u)`, `cos(2 u)` or `sin(2 u)`; each of these,
    and 1, has a coefficient of its own, a symbol, or a number for one of them: then the equation is
    scaled to it. Solutions are algebraic in the coefficients, with one square root at most; those of an
    angle may be written with `atan2`.

    Raises `PlugInError` where a solution does not solve the equation, or one may be missing: both are
    proved.
    """
    if not 1 <= len(solutions) <= 2:
        raise _refused(name, f"has {len(solutions)} solutions", "give one or two")
    coefficients = tuple(sorted(equation.free_symbols - {unknown}, key=str))
    recipe = Recipe(unknown, sympy.expand(equation), coefficients, solutions)
    slots = _slots(name, recipe)
    form = form_class(name, recipe)
    proof = prove_form(form, ("variable",) * len(coefficients))
    if not proof.proved:
        raise _refused(name, f"is not proved: {proof.reason}", "mend its equation or its solutions")
    return Leaf(name, _finder(name, form, slots))


def _slots(name: str, recipe: Recipe) -> Slots:
    """What stands before each power or harmonic."""
    u, e = recipe.unknown, recipe.equation
    found: dict[Key, sympy.Expr] = {}
    if recipe.angle:
        kinds = (("c", sympy.cos), ("s", sympy.sin))
        marks = {(k, kind): function(k * u) for k in (1, 2) for kind, function in kinds}
        found = {key: e.coeff(mark) for key, mark in marks.items() if e.coeff(mark) != 0}
        rest = e - sum(found[key] * mark for key, mark in marks.items() if key in found)
        if sympy.expand(rest) != 0:
            found[0, "c"] = sympy.expand(rest)
    elif e.is_polynomial(u):
        found = {int(power): x for (power,), x in sympy.Poly(e, u).terms()}
    plain = [x for x in found.values() if x.is_Symbol or x.is_number]
    symbols = [x for x in plain if x.is_Symbol]
    whole = len(plain) == len(found) and sorted(symbols, key=str) == [*recipe.coefficients]
    if not whole or len(plain) - len(symbols) > 1 or len(found) < 2:
        hint = "a coefficient of its own before each power, cosine and sine; a number before one at most"
        raise _refused(name, f"has an equation that cannot be matched: {e}", hint)
    return found


def _finder(
    name: str, form: type[SympyForm], slots: Slots
) -> Callable[[Sequence[PolynomialEquation], Variable, Knowledge], list[Candidate]]:
    kind = "angle" if form.recipe.angle else "prismatic"

    def find(
        equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
    ) -> list[Candidate]:
        out: list[Candidate] = []
        for e in equations:
            if unknown.kind != kind or e.unknowns != (unknown,):
                continue
            values = _matched(knowledge.graph, slots, _parts(e, unknown))
            if values is not None:
                nodes = (values[symbol] for symbol in form.recipe.coefficients)
                out.append(Candidate(unknown, name, form(*nodes), e.sources))
        return out

    return find


def _parts(e: PolynomialEquation, unknown: Variable) -> Mapping[Key, Expr]:
    """Coefficients by power, or by harmonic; none for an equation with others."""
    found = harmonics(e, unknown) if unknown.kind == "angle" else powers(e, unknown)
    out: dict[Key, Expr] = {}
    for key, node in (found or {}).items():
        out[key] = node
    return out


def _matched(
    g: ExpressionGraph, slots: Slots, given: Mapping[Key, Expr]
) -> dict[sympy.Expr, Expr] | None:
    """Nodes for the coefficients; None where the equation is another."""
    highest = max(slots, key=str)
    if not set(given) <= set(slots) or highest not in given:
        return None
    scale = g.one
    for key, x in slots.items():
        if x.is_number:
            node = given.get(key)
            if node is None or not node.is_const:
                return None
            scale = g.const(float(x) / node.value)
    return {x: g.mul(scale, given.get(key, g.zero)) for key, x in slots.items() if x.is_Symbol}


def _refused(name: str, what: str, hint: str) -> PlugInError:
    return PlugInError(f"the leaf '{name}' {what}", hint=hint)
