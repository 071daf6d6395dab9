"""Tangent leaf: `K cos(u) = X` and `K sin(u) = Y` with a common factor K that holds other unknowns
(IKBT, rule-based solver 3). K may have either sign: two branches."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from ikgen.algebra.expression import Expr
from ikgen.algebra.polynomial import Polynomial
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.matching import (
    AngleSplit,
    determinant_vanishes,
    only_known,
    proportional,
    split_angle,
)
from ikgen.forms.tangent_form import Tangent
from ikgen.solver.candidate import Candidate

__all__ = ["find"]


@dataclass(frozen=True, slots=True)
class _Row:
    """`factor * (a cos + b sin) = value` with the unknown factor common to a family of rows."""

    a: Expr
    b: Expr
    value: Expr
    equation: PolynomialEquation


def find(
    equations: Sequence[PolynomialEquation], unknown: Variable, knowledge: Knowledge
) -> list[Candidate]:
    """Pairs of equations whose parts with the unknown share a factor in other unknowns."""
    if unknown.kind != "angle":
        return []
    families: list[tuple[Polynomial, list[_Row]]] = []
    for e in equations:
        if unknown in e.unknowns and len(e.unknowns) > 1:
            _collect(families, e, unknown, knowledge)
    out: list[Candidate] = []
    for _, rows in families:
        for one, two in itertools.combinations(rows, 2):
            candidate = _solve(one, two, unknown, knowledge)
            if candidate is not None:
                out.append(candidate)
    return out


def _collect(
    families: list[tuple[Polynomial, list[_Row]]],
    e: PolynomialEquation,
    unknown: Variable,
    knowledge: Knowledge,
) -> None:
    g = knowledge.graph
    split = split_angle(e, unknown)
    if split is None or not (split.cosine or split.sine):
        return
    known = only_known(split.rest) if split.rest else g.zero
    if known is None:
        return
    value = g.neg(known)
    for factor, rows in families:
        row = _row(split, factor, value, e, knowledge)
        if row is not None:
            rows.append(row)
            return
    factor = split.cosine or split.sine
    row = _row(split, factor, value, e, knowledge)
    if row is not None:
        families.append((factor, [row]))


def _row(
    split: AngleSplit,
    factor: Polynomial,
    value: Expr,
    e: PolynomialEquation,
    knowledge: Knowledge,
) -> _Row | None:
    """The equation over the family's factor, scaled so that one of its coefficients is one: no
    division, hence nothing that could vanish."""
    g = knowledge.graph
    parts: list[Expr] = []
    for side in (split.cosine, split.sine):
        found = proportional(side, factor) if side else (g.zero, g.zero)
        if found is None:
            return None
        parts.append(found[0])
    return _Row(parts[0], parts[1], value, e)


def _solve(one: _Row, two: _Row, unknown: Variable, knowledge: Knowledge) -> Candidate | None:
    """Solve the 2x2 system for factor*cos and factor*sin up to the (known) determinant's sign."""
    g = knowledge.graph
    if determinant_vanishes((one.a, one.b), (two.a, two.b)):
        return None
    x = g.sub(g.mul(one.value, two.b), g.mul(two.value, one.b))
    y = g.sub(g.mul(one.a, two.value), g.mul(two.a, one.value))
    if x.vanishes and y.vanishes:
        return None
    sources = (*one.equation.sources, *two.equation.sources)
    return Candidate(unknown, "tangent", Tangent(x, y), sources)
