"""Rigid transforms of expressions: rotation columns and position, products and inverses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.variables import JointVariables

__all__ = ["Rigid", "constant", "identity", "inverse", "link", "multiply", "run", "run_inverse"]


@dataclass(frozen=True, slots=True)
class Rigid:
    """`R[row][column]` and `p[row]`."""

    R: tuple[tuple[Expr, ...], ...]
    p: tuple[Expr, ...]

    def column(self, j: int) -> list[Expr]:
        """Column j of the rotation."""
        return [self.R[i][j] for i in range(3)]


def identity(g: ExpressionGraph) -> Rigid:
    """No motion."""
    rows = tuple(tuple(g.one if i == j else g.zero for j in range(3)) for i in range(3))
    return Rigid(rows, (g.zero,) * 3)


def constant(g: ExpressionGraph, T: NDArray[np.float64]) -> Rigid:
    """A transform of numbers; entries within round-off of 0 and ±1 become exact."""

    def clean(x: float) -> Expr:
        nearest = float(round(x))
        return g.const(nearest if abs(x - nearest) < 1e-15 else float(x))

    rows = tuple(tuple(clean(T[i, j]) for j in range(3)) for i in range(3))
    return Rigid(rows, tuple(g.const(T[i, 3]) for i in range(3)))


def multiply(g: ExpressionGraph, a: Rigid, b: Rigid) -> Rigid:
    """a * b"""
    rows = tuple(tuple(g.dot(list(a.R[i]), b.column(j)) for j in range(3)) for i in range(3))
    p = tuple(g.add(g.dot(list(a.R[i]), list(b.p)), a.p[i]) for i in range(3))
    return Rigid(rows, p)


def inverse(g: ExpressionGraph, a: Rigid) -> Rigid:
    """a^-1 by transposition."""
    rows = tuple(tuple(a.R[j][i] for j in range(3)) for i in range(3))
    p = tuple(g.neg(g.dot(list(rows[i]), list(a.p))) for i in range(3))
    return Rigid(rows, p)


def _rotation_z(g: ExpressionGraph, c: Expr, s: Expr) -> tuple[tuple[Expr, ...], ...]:
    return ((c, g.neg(s), g.zero), (s, c, g.zero), (g.zero, g.zero, g.one))


def link(v: JointVariables, i: int) -> Rigid:
    """`Rx(alpha_{i-1}) Tx(a_{i-1})` of row i (0-based)."""
    g = v.graph
    row = v.dh.rows[i]
    c, s = v.angle(row.alpha)
    rows = ((g.one, g.zero, g.zero), (g.zero, c, g.neg(s)), (g.zero, s, c))
    return Rigid(rows, (v.length(row.a), g.zero, g.zero))


def run(v: JointVariables, first: int, last: int) -> Rigid:
    """`Rz Tz` of row first, then rows up to last, all about parallel axes (first's link left out).

    Linear in the cosines and sines of the cumulative angles.
    """
    g, rows = v.graph, range(first, last + 1)
    (c, s), p = _cumulative(v, rows, rows[1:], g.add)
    return Rigid(_rotation_z(g, c, s), p)


def run_inverse(v: JointVariables, first: int, last: int) -> Rigid:
    """The inverse of `run`, in the trailing cumulative angles."""
    g, rows = v.graph, range(last, first - 1, -1)
    (c, s), (x, y, z) = _cumulative(v, rows, rows, g.sub)
    return Rigid(_rotation_z(g, c, g.neg(s)), (g.neg(x), g.neg(y), g.neg(z)))


def _cumulative(
    v: JointVariables, rows: range, links: range, aside: Callable[[Expr, Expr], Expr]
) -> tuple[tuple[Expr, Expr], tuple[Expr, ...]]:
    """Cosine and sine of the sum of the rows' angles, and where the links between them lead, each turned by
    the sum before it; what they lead along y is put `aside`."""
    g = v.graph
    combination, shift = v.row_angle(rows[0])
    x, y, z = g.zero, g.zero, v.row_distance(rows[0])
    for i, between in zip(rows[1:], links, strict=False):
        c, s = v.rotated(combination, shift)
        a = v.length(v.dh.rows[between].a)
        x, y = g.add(x, g.mul(a, c)), aside(y, g.mul(a, s))
        z = g.add(z, v.row_distance(i))
        step, more = v.row_angle(i)
        combination = tuple(p + q for p, q in zip(combination, step, strict=True))
        shift += more
    return v.rotated(combination, shift), (x, y, z)
