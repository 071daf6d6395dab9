"""Matching a polynomial equation against the shapes that leaves look for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.algebra.polynomial import ONE, AngleCombination, Monomial, Polynomial
from ikgen.equations.knowledge import PolynomialEquation, Variable

__all__ = [
    "AngleSplit",
    "constant_ratio",
    "contains",
    "determinant_vanishes",
    "harmonics",
    "in_harmonics",
    "only_known",
    "powers",
    "proportional",
    "split_angle",
]

Harmonics: TypeAlias = dict[tuple[int, str], Expr]


@dataclass(frozen=True, slots=True)
class AngleSplit:
    """`cosine * cos(u) + sine * sin(u) + rest = 0`, u in none of the three polynomials."""

    cosine: Polynomial
    sine: Polynomial
    rest: Polynomial


def split_angle(equation: PolynomialEquation, unknown: Variable) -> AngleSplit | None:
    """Take an equation apart by the cosine and sine of an unknown angle; None where a harmonic or
    another combination with the unknown occurs."""
    cosine: Polynomial = {}
    sine: Polynomial = {}
    rest: Polynomial = {}
    for (trigs, slides), value in equation.polynomial.items():
        hits = [t for t in trigs if _parallel(t[0], unknown.combination)]
        if not hits:
            rest[trigs, slides] = value
            continue
        combination, kind = hits[0]
        if combination != unknown.combination:
            return None
        others = tuple(t for t in trigs if t is not hits[0])
        (cosine if kind == "c" else sine)[others, slides] = value
    return AngleSplit(cosine, sine, rest)


def _parallel(combination: AngleCombination, unit: AngleCombination) -> bool:
    factor = max(map(abs, combination))
    unit_factor = max(map(abs, unit))
    return all(k * unit_factor == u * factor for k, u in zip(combination, unit, strict=True))


def contains(monomial: Monomial, unknown: Variable) -> bool:
    """Whether an unknown, or a multiple of its angle, occurs in a monomial."""
    trigs, slides = monomial
    if unknown.kind == "angle":
        return any(_parallel(combination, unknown.combination) for combination, _ in trigs)
    return any(joint == unknown.joint for joint, _ in slides)


def harmonics(equation: PolynomialEquation, unknown: Variable) -> Harmonics | None:
    """Coefficients by (harmonic, "c" or "s"), (0, "c") the constant; None where others occur."""
    out: Harmonics = {}
    for (trigs, slides), value in equation.polynomial.items():
        if slides or len(trigs) > 1:
            return None
        if not trigs:
            out[0, "c"] = value
            continue
        combination, kind = trigs[0]
        if not _parallel(combination, unknown.combination):
            return None
        out[max(map(abs, combination)) // max(map(abs, unknown.combination)), kind] = value
    return out


def in_harmonics(
    equations: Iterable[PolynomialEquation], unknown: Variable
) -> Iterator[tuple[PolynomialEquation, Harmonics, int]]:
    """The equations in an unknown angle alone, each with its `harmonics` and the highest of them."""
    if unknown.kind != "angle":
        return
    for equation in equations:
        found = harmonics(equation, unknown) if equation.unknowns == (unknown,) else None
        if found is not None:
            yield equation, found, max(k for k, _ in found)


def powers(equation: PolynomialEquation, unknown: Variable) -> dict[int, Expr] | None:
    """Coefficients by power of a prismatic unknown; None where other unknowns occur."""
    joint = unknown.joint
    out: dict[int, Expr] = {}
    for (trigs, slides), value in equation.polynomial.items():
        if trigs or len(slides) > 1 or (slides and slides[0][0] != joint):
            return None
        out[slides[0][1] if slides else 0] = value
    return out


def proportional(a: Polynomial, b: Polynomial) -> tuple[Expr, Expr] | None:
    """Known x and y with `y * a = x * b`, y a coefficient of b chosen by b alone; None if there are
    none. Tried on the probes."""
    if set(a) != set(b) or not a:
        return None
    first: Monomial = max(b, key=lambda m: (abs(b[m].probe).min(), m))
    for mono in a:
        cross = a[mono].probe * b[first].probe - a[first].probe * b[mono].probe
        size = a[mono].scale * b[first].scale + a[first].scale * b[mono].scale
        if not abs(cross).max() <= 1e-9 * size:
            return None
    return a[first], b[first]


def constant_ratio(graph: ExpressionGraph, a: Polynomial, b: Polynomial) -> Expr | None:
    """The factor f with `a = f * b`, f of parameters and numbers only; None if there is none."""
    found = proportional(a, b)
    if found is None:
        return None
    ratio = graph.div(*found)
    return ratio if ratio.is_fixed else None


def only_known(polynomial: Polynomial) -> Expr | None:
    """The coefficient of a polynomial that is one known number; None otherwise."""
    if not polynomial:
        return None
    if set(polynomial) == {ONE}:
        return polynomial[ONE]
    return None


def determinant_vanishes(one: tuple[Expr, Expr], two: tuple[Expr, Expr]) -> bool:
    """Whether two rows of two coefficients are proportional, at all probes."""
    (a, b), (c, d) = one, two
    size = a.scale * d.scale + b.scale * c.scale
    return bool(np.max(np.abs(a.probe * d.probe - b.probe * c.probe)) <= 1e-9 * size)
