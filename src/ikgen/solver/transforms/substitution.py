"""Substitution transform: where one equation contains a multiple of another's part in an unknown, take
it away (IKBT, transformation 2)."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from ikgen.algebra import polynomial as poly
from ikgen.algebra.polynomial import Polynomial
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import constant_ratio

__all__ = ["apply"]


def _part(equation: PolynomialEquation, unknown: Variable) -> Polynomial:
    out: Polynomial = {}
    for (trigs, slides), value in equation.polynomial.items():
        if unknown.kind == "angle":
            inside = any(_multiple(combination, unknown.combination) for combination, _ in trigs)
        else:
            inside = any(joint == unknown.joint for joint, _ in slides)
        if inside:
            out[trigs, slides] = value
    return out


def _multiple(combination: tuple[int, ...], unit: tuple[int, ...]) -> bool:
    k, u = max(map(abs, combination)), max(map(abs, unit))
    return all(a * u == b * k for a, b in zip(combination, unit, strict=True))


def apply(
    equations: Sequence[PolynomialEquation], knowledge: Knowledge
) -> list[PolynomialEquation]:
    """Differences of pairs of equations from which an unknown has dropped out."""
    g = knowledge.graph
    out: list[PolynomialEquation] = []
    unknowns = sorted({v for e in equations for v in e.unknowns})
    for unknown in unknowns:
        groups: dict[frozenset[object], list[tuple[PolynomialEquation, Polynomial]]] = {}
        for e in equations:
            if unknown in e.unknowns:
                part = _part(e, unknown)
                groups.setdefault(frozenset(part), []).append((e, part))
        for members in groups.values():
            for (e1, p1), (e2, p2) in itertools.combinations(members, 2):
                ratio = constant_ratio(g, p1, p2)
                if ratio is None:
                    continue
                difference = poly.subtract(g, e1.polynomial, poly.scale(g, e2.polynomial, ratio))
                left, rank = knowledge.unknowns_of(difference)
                if left and rank < min(e1.rank, e2.rank):
                    out.append(
                        PolynomialEquation(difference, left, (*e1.sources, *e2.sources), rank)
                    )
    return out
