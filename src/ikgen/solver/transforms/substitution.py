"""Substitution transform (IKBT, transformation 2): where one equation contains a multiple of another's part
in an unknown, take it away, which leaves fewer unknowns."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from ikgen.algebra import polynomial as poly
from ikgen.algebra.polynomial import Polynomial
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import constant_ratio, contains

__all__ = ["apply"]

MOST_PAIRS = 60
"""Pairs tried for one unknown, the shortest equations first."""


def apply(
    equations: Sequence[PolynomialEquation], knowledge: Knowledge
) -> list[PolynomialEquation]:
    """Differences of pairs of equations from which an unknown has dropped out, and the equations: what is
    left may need one of them beside it."""
    made: list[PolynomialEquation] = []
    for unknown in sorted({v for e in equations for v in e.unknowns}):
        groups: dict[frozenset[object], list[tuple[PolynomialEquation, Polynomial]]] = {}
        for e in sorted(equations, key=lambda e: len(e.polynomial)):
            if unknown in e.unknowns:
                part = {m: value for m, value in e.polynomial.items() if contains(m, unknown)}
                groups.setdefault(frozenset(part), []).append((e, part))
        pairs = itertools.chain.from_iterable(
            itertools.combinations(members, 2) for members in groups.values()
        )
        for (e1, p1), (e2, p2) in itertools.islice(pairs, MOST_PAIRS):
            made.extend(_difference((e1, p1), (e2, p2), unknown, knowledge))
    return [*equations, *made] if made else []


def _difference(
    one: tuple[PolynomialEquation, Polynomial],
    other: tuple[PolynomialEquation, Polynomial],
    unknown: Variable,
    knowledge: Knowledge,
) -> list[PolynomialEquation]:
    """The one equation less the multiple of the other that takes the unknown out, if it does."""
    g, (e1, p1), (e2, p2) = knowledge.graph, one, other
    ratio = constant_ratio(g, p1, p2)
    if ratio is None:
        return []
    left = poly.subtract(g, e1.polynomial, poly.scale(g, e2.polynomial, ratio))
    unknowns, rank = knowledge.unknowns_of(left)
    if not unknowns or unknown in unknowns or rank >= max(e1.rank, e2.rank):
        return []
    return [PolynomialEquation(left, unknowns, (*e1.sources, *e2.sources), rank)]
