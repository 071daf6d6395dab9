"""Trigonometric polynomials in the unknowns, with coefficients in the known.

A monomial is a product of at most one cosine or sine per group of parallel axes, of an integer
combination ("combination") of the group's angles, and of powers of prismatic variables. Products inside a
group are turned into sums (product-to-sum formulas), so `c^2 + s^2 = 1` and every sum-of-angles
identity hold by construction and two polynomials are equal exactly when their terms are.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph

__all__ = [
    "AngleCombination",
    "Monomial",
    "Polynomial",
    "add",
    "canonical",
    "multiply",
    "scale",
    "subtract",
]

AngleCombination = tuple[int, ...]
Trig = tuple[AngleCombination, str]
Monomial = tuple[tuple[Trig, ...], tuple[tuple[int, int], ...]]
Polynomial = dict[Monomial, Expr]
GroupOf = Callable[[AngleCombination], int]

ONE: Monomial = ((), ())


def canonical(combination: AngleCombination) -> tuple[AngleCombination, int]:
    """The combination with its first nonzero entry positive, and the sign taken out (0 for all zeros)."""
    for k in combination:
        if k > 0:
            return combination, 1
        if k < 0:
            return tuple(-x for x in combination), -1
    return combination, 0


def _accumulate(graph: ExpressionGraph, into: Polynomial, mono: Monomial, value: Expr) -> None:
    total = graph.add(into[mono], value) if mono in into else value
    if total is graph.zero or total.vanishes:
        into.pop(mono, None)
    else:
        into[mono] = total


def add(graph: ExpressionGraph, a: Polynomial, b: Polynomial) -> Polynomial:
    """a + b"""
    out = dict(a)
    for mono, value in b.items():
        _accumulate(graph, out, mono, value)
    return out


def subtract(graph: ExpressionGraph, a: Polynomial, b: Polynomial) -> Polynomial:
    """a - b"""
    out = dict(a)
    for mono, value in b.items():
        _accumulate(graph, out, mono, graph.neg(value))
    return out


def scale(graph: ExpressionGraph, a: Polynomial, factor: Expr) -> Polynomial:
    """factor * a"""
    return {mono: graph.mul(factor, value) for mono, value in a.items()}


@cache
def _combine(a: Trig, b: Trig) -> tuple[tuple[float, Trig | None], ...]:
    """Product to sum: the factors of two trigonometric functions of one group as a sum of single ones."""
    total = tuple(x + y for x, y in zip(a[0], b[0], strict=True))
    difference = tuple(x - y for x, y in zip(a[0], b[0], strict=True))
    kinds = a[1] + b[1]
    if kinds == "cc":
        parts = [(0.5, total, "c"), (0.5, difference, "c")]
    elif kinds == "ss":
        parts = [(-0.5, total, "c"), (0.5, difference, "c")]
    elif kinds == "sc":
        parts = [(0.5, total, "s"), (0.5, difference, "s")]
    else:
        parts = [(0.5, total, "s"), (-0.5, difference, "s")]
    out: list[tuple[float, Trig | None]] = []
    for factor, combination, kind in parts:
        combination, sign = canonical(combination)
        if sign == 0:
            if kind == "c":
                out.append((factor, None))
        else:
            out.append((factor * (sign if kind == "s" else 1), (combination, kind)))
    return tuple(out)


def _multiply_monomials(
    group_of: GroupOf, a: Monomial, b: Monomial
) -> list[tuple[float, Monomial]]:
    if a == ONE or b == ONE:
        return [(1.0, b if a == ONE else a)]
    powers = dict(a[1])
    for joint, power in b[1]:
        powers[joint] = powers.get(joint, 0) + power
    slides = tuple(sorted(powers.items()))
    by_group: dict[int, list[Trig]] = {}
    for trig in (*a[0], *b[0]):
        by_group.setdefault(group_of(trig[0]), []).append(trig)
    terms: list[tuple[float, tuple[Trig, ...]]] = [(1.0, ())]
    for group in sorted(by_group):
        factors = by_group[group]
        pieces = ((1.0, factors[0]),) if len(factors) == 1 else _combine(factors[0], factors[1])
        terms = [
            (c * k, (*trigs, trig) if trig is not None else trigs)
            for c, trigs in terms
            for k, trig in pieces
        ]
    return [(c, (trigs, slides)) for c, trigs in terms]


def multiply(graph: ExpressionGraph, group_of: GroupOf, a: Polynomial, b: Polynomial) -> Polynomial:
    """a * b in normal form."""
    out: Polynomial = {}
    for mono_a, value_a in a.items():
        for mono_b, value_b in b.items():
            product = graph.mul(value_a, value_b)
            if product is graph.zero:
                continue
            for factor, mono in _multiply_monomials(group_of, mono_a, mono_b):
                scaled = product if factor == 1.0 else graph.mul(graph.const(factor), product)
                _accumulate(graph, out, mono, scaled)
    return out
