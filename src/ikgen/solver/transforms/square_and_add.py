"""Square-and-add transform (IKBT's x^2 y^2, solver 6, for any pair of equations).

Two equations linear in the cosine and sine of one unknown are solved for them, squared and added: what
remains has the other unknown only.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from ikgen.algebra import polynomial as poly
from ikgen.algebra.polynomial import Polynomial
from ikgen.equations.knowledge import Knowledge, PolynomialEquation
from ikgen.equations.matching import AngleSplit, constant_ratio, only_known, split_angle

__all__ = ["apply"]

MOST_PAIRS = 60
"""Pairs tried for one unknown, the shortest equations first."""


def apply(
    equations: Sequence[PolynomialEquation], knowledge: Knowledge
) -> list[PolynomialEquation]:
    """Equations in one unknown out of pairs in two."""
    out: list[PolynomialEquation] = []
    unknowns = sorted({v for e in equations for v in e.unknowns if v.kind == "angle"})
    for unknown in unknowns:
        rows: list[tuple[PolynomialEquation, AngleSplit]] = []
        for e in sorted(equations, key=lambda e: len(e.polynomial)):
            if unknown in e.unknowns and len(e.unknowns) == 2:
                split = split_angle(e, unknown)
                if split is not None:
                    rows.append((e, split))
        tried = 0
        for (e1, s1), (e2, s2) in itertools.combinations(rows, 2):
            if e1.unknowns != e2.unknowns or tried >= MOST_PAIRS:
                continue
            combined = _known_coefficients(s1, s2, knowledge) or _rotated(s1, s2, knowledge)
            if not combined:
                continue
            tried += 1
            combined = knowledge.reduce(combined)
            left, rank = knowledge.unknowns_of(combined)
            if rank == 1 and unknown not in left:
                sources = (*e1.sources, *e2.sources)
                out.append(PolynomialEquation(combined, left, sources, rank))
    return out


def _square(p: Polynomial, knowledge: Knowledge) -> Polynomial:
    return poly.multiply(knowledge.graph, knowledge.variables.group_of, p, p)


def _known_coefficients(s1: AngleSplit, s2: AngleSplit, knowledge: Knowledge) -> Polynomial | None:
    """`|M^-1 (X, Y)|^2 = 1` for known 2x2 coefficients M, times det(M)^2."""
    g = knowledge.graph
    entries = []
    for part in (s1.cosine, s1.sine, s2.cosine, s2.sine):
        value = only_known(part) if part else g.zero
        if value is None:
            return None
        entries.append(value)
    a1, b1, a2, b2 = entries
    det = g.sub(g.mul(a1, b2), g.mul(b1, a2))
    if np.abs(det.probe).max() <= 1e-9 * max(det.scale, 1e-300):
        return None
    c = poly.subtract(g, poly.scale(g, s2.rest, b1), poly.scale(g, s1.rest, b2))
    s = poly.subtract(g, poly.scale(g, s1.rest, a2), poly.scale(g, s2.rest, a1))
    total = poly.add(g, _square(c, knowledge), _square(s, knowledge))
    return poly.subtract(g, total, {poly.ONE: g.square(det)})


def _rotated(s1: AngleSplit, s2: AngleSplit, knowledge: Knowledge) -> Polynomial | None:
    """For coefficient rows (K1, K2) and f (-K2, K1): `K1^2 + K2^2 = P1^2 + P2^2 / f^2`."""
    g = knowledge.graph
    if s1.cosine and s1.sine and s2.cosine and s2.sine:
        f = constant_ratio(g, s2.sine, s1.cosine)
        h = constant_ratio(g, s2.cosine, s1.sine)
        if f is None or h is None or not g.add(f, h).vanishes:
            return None
    elif s1.cosine and s2.sine and not s1.sine and not s2.cosine:
        f = constant_ratio(g, s2.sine, s1.cosine)
    elif s1.sine and s2.cosine and not s1.cosine and not s2.sine:
        f = constant_ratio(g, s2.cosine, s1.sine)
    else:
        return None
    if f is None:
        return None
    norm = poly.add(g, _square(s1.cosine, knowledge), _square(s1.sine, knowledge))
    inverse = g.div(g.one, g.square(f))
    rest = poly.add(
        g, _square(s1.rest, knowledge), poly.scale(g, _square(s2.rest, knowledge), inverse)
    )
    return poly.subtract(g, norm, rest)
