"""A solution form made of SymPy expressions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, make_dataclass
from functools import cached_property
from typing import Any, ClassVar, TypeAlias

import numpy as np
import sympy

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.errors import PlugInError
from ikgen.forms.form import Form, scales
from ikgen.forms.lowered_form import (
    LoweredForm,
    Tolerances,
    divisor_of,
    natural_size,
)
from ikgen.model.arrays import Array
from ikgen.symbolic.graph_expression import graph_expression

__all__ = ["Recipe", "SympyForm", "form_class"]

_HALF = sympy.Rational(1, 2)

Fraction: TypeAlias = tuple[sympy.Expr, sympy.Expr]


@dataclass(frozen=True)
class Recipe:
    """What a form is made of: `equation` vanishes, over `coefficients` and the `unknown` (its cosines
    and sines for an angle); `solutions` are one or two values of it."""

    unknown: sympy.Symbol
    equation: sympy.Expr
    coefficients: tuple[sympy.Symbol, ...]
    solutions: tuple[sympy.Expr, ...]

    @cached_property
    def angle(self) -> bool:
        """Whether the unknown is an angle."""
        return bool(self.equation.has(sympy.cos, sympy.sin))

    @cached_property
    def fractions(self) -> tuple[tuple[Fraction, ...], ...]:
        """Per branch (cosine, sine) or (length,), numerators and denominators apart."""
        parts = [
            (sympy.cos(v), sympy.sin(v)) if self.angle else (v,)
            for v in map(sympy.sympify, self.solutions)
        ]
        return tuple(tuple(_fraction(x) for x in one) for one in parts)

    @cached_property
    def values(self) -> tuple[tuple[sympy.Expr, ...], ...]:
        """The branches' values as quotients."""
        return tuple(tuple(above / below for above, below in one) for one in self.fractions)

    @cached_property
    def divisor(self) -> sympy.Expr:
        """The least common denominator."""
        return sympy.lcm_list([below for one in self.fractions for _, below in one])

    @cached_property
    def radicand(self) -> sympy.Expr | None:
        """What is under the square root; None without one. Raises `PlugInError` for several."""
        roots = {
            p
            for one in self.fractions
            for x, _ in one
            for p in x.atoms(sympy.Pow)
            if p.exp == _HALF
        }
        found = {p.base for p in roots if p.base.free_symbols}
        if len(found) > 1:
            raise PlugInError(
                f"solutions with several square roots: {', '.join(sorted(map(str, found)))}",
                hint="a form in SymPy has one, and two branches",
            )
        return next(iter(found), None)

    def mean_and_half(self, index: int) -> tuple[sympy.Expr, sympy.Expr]:
        """The part of a component (0: cosine or length, 1: sine), over the divisor, that the branches
        share, and the one that changes sign."""
        above = []
        for one in self.fractions:
            top, below = one[index]
            above.append(sympy.expand(top * sympy.cancel(self.divisor / below)))
        if len(above) == 1:
            return above[0], sympy.S.Zero
        total, difference = above[0] + above[1], above[0] - above[1]
        return sympy.factor_terms(total / 2), sympy.factor_terms(difference / 2)

    def number(self, e: sympy.Expr) -> Callable[..., Any]:
        """A function of the coefficients' arrays; square roots are cut at zero."""
        cut = {"sqrt": lambda x: np.sqrt(np.maximum(x, 0.0))}
        made: Callable[..., Any] = sympy.lambdify(self.coefficients, e, [cut, "numpy"])
        return made


class SympyForm(Form):
    """A form by a recipe; its classes are made by `form_class`."""

    recipe: ClassVar[Recipe]

    @property
    def divisor_parts(self) -> tuple[Expr, ...]:
        """The coefficients in the divisor."""
        used = self.recipe.divisor.free_symbols
        pairs = zip(self.recipe.coefficients, self.coefficients, strict=True)
        return tuple(node for symbol, node in pairs if symbol in used)

    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """The least common denominator of the solutions."""
        return self._sized(self.recipe.divisor, c, z)[None]

    def discriminant(self) -> Array | None:
        """What is under the square root."""
        radicand = self.recipe.radicand
        if radicand is None:
            return None
        return self._sized(radicand, self.probe, scales(self.coefficients))

    def _sized(self, e: sympy.Expr, c: Sequence[Array], z: Sequence[float]) -> Array:
        """A polynomial at coefficients, relative to its terms' natural size."""
        terms = sympy.Add.make_args(sympy.expand(e))
        size = max(abs(float(self.recipe.number(term)(*z))) for term in terms)
        value = self.recipe.number(e)(*c)
        return np.broadcast_to(np.asarray(value / max(size, 1e-300), dtype=float), c[0].shape)

    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """The solutions at coefficients."""
        return [
            tuple(np.broadcast_to(self.recipe.number(x)(*c), c[0].shape) for x in one)
            for one in self.recipe.values
        ]

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """The equation."""
        e, names = self.recipe.equation, [self.recipe.unknown]
        if self.recipe.angle:
            u = self.recipe.unknown
            names = [sympy.Dummy("cosine"), sympy.Dummy("sine")]
            e = sympy.expand_trig(e).subs({sympy.cos(u): names[0], sympy.sin(u): names[1]})
        given = {**self._nodes(), **dict(zip(names, unknown, strict=True))}
        return (graph_expression(g, sympy.expand(e), given),)

    def lower(self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances) -> LoweredForm:
        """Numerators over the common divisor; sigma chooses the branch."""
        nodes = self._nodes()
        recipe = self.recipe
        divisor = divisor_of(g, graph_expression(g, recipe.divisor, nodes), tolerances)
        guard, under = None, None
        if recipe.radicand is not None:
            under = graph_expression(g, recipe.radicand, nodes)
            guard = tolerances.guard(g, under, natural_size(under))
        values = []
        for index in range(len(recipe.values[0])):
            mean, half = (graph_expression(g, e, nodes) for e in recipe.mean_and_half(index))
            values.append(g.div(g.add(mean, g.mul(sigma, half)), divisor.value))
        size = None if under is None else (under, g.const(natural_size(under)))
        return LoweredForm(tuple(values), divisor, guard, self.branches, size)

    def _nodes(self) -> dict[sympy.Symbol, Expr]:
        return dict(zip(self.recipe.coefficients, self.coefficients, strict=True))


def _fraction(e: sympy.Expr) -> Fraction:
    """Numerator and denominator, without roots below the line."""
    above, below = sympy.fraction(sympy.together(sympy.expand_trig(e)))
    for factor in sympy.Mul.make_args(below):
        if factor.is_Pow and factor.exp == _HALF and factor.free_symbols:
            above, below = above * factor, below * factor
    return above, below


def form_class(name: str, recipe: Recipe) -> type[SympyForm]:
    """A class of forms, its fields the recipe's coefficients."""
    made = make_dataclass(
        "".join(word.capitalize() for word in name.split()),
        [(symbol.name, Expr) for symbol in recipe.coefficients],
        bases=(SympyForm,),
        namespace={"name": name, "branches": len(recipe.solutions), "recipe": recipe},
        frozen=True,
    )
    assert issubclass(made, SympyForm)
    return made
