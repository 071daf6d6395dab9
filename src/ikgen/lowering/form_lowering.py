"""What each solution form computes: its values, guards and degenerate conditions as expressions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.solver.candidate import Candidate

__all__ = [
    "ROUNDED",
    "Divisor",
    "Realized",
    "Tolerances",
    "leading",
    "natural_size",
    "realize",
]


ROUNDED = 2e-9
"""Slack (m or rad) above which every row takes Newton steps."""


@dataclass(frozen=True, slots=True)
class Tolerances:
    """Relative to natural sizes: a divisor below `singular` makes its joint free, one below `flag` marks
    the solution as one of a continuum; a square root's argument may be `clamp` outside its domain, as
    poses on the boundary of the workspace are reachable, and where Newton steps follow it is kept
    above `fold`, so that two branches start apart. Where the condition `rough` holds, what a square
    root is taken of has lost digits: it may be `wide` outside.
    """

    singular: float = 1e-11
    flag: float = 1e-4
    clamp: float = 1e-11
    fold: float = 0.0
    rough: Expr | None = None
    wide: float = 1e-3

    @staticmethod
    def for_slack(slack: float) -> Tolerances:
        """Tolerances where the solved geometry is `slack` (m or rad) off the file's.

        Where no Newton steps follow, a divisor that is no larger than what the two differ by is as good
        as zero: the file's direction of it is lost.
        """
        clamp = max(1e-11, 25.0 * slack)
        fold = 0.05 * slack if slack > ROUNDED else 0.0
        singular = 1e-11 if slack > ROUNDED else max(1e-11, 4.0 * slack)
        flag = min(max(1e-4, 5.0 * slack), 1e-2)
        return Tolerances(singular, flag, clamp, fold)

    def guard(self, g: ExpressionGraph, value: Expr, size: float) -> Expr:
        """Condition that a square root of `value`, of natural size `size`, may be taken."""
        least = g.const(-self.clamp * size)
        if self.rough is not None:
            least = g.select(self.rough, g.const(-self.wide * size), least)
        return g.binary("gt", value, least)


@dataclass(frozen=True, slots=True)
class Divisor:
    """A divisor with 1 in its place where it vanishes; `regular`: it does not vanish; `clear`: it is
    well away from that. Both None where it is a nonzero constant."""

    value: Expr
    regular: Expr | None = None
    clear: Expr | None = None


@dataclass(frozen=True, slots=True)
class Realized:
    """`values`: (cosine, sine) or (distance,), defined where `regular` (None: always) holds, and well
    away from a continuum where `clear` does; `guard`: condition for a real solution (None: always);
    `branches`: how many signs of sigma differ."""

    values: tuple[Expr, ...]
    divisor: Divisor
    guard: Expr | None
    branches: int
    under: tuple[Expr, Expr] | None = None
    """What is under the square root, and its natural size."""

    @property
    def regular(self) -> Expr | None:
        """Condition that the divisor does not vanish."""
        return self.divisor.regular


def realize(g: ExpressionGraph, c: Candidate, sigma: Expr, tolerances: Tolerances) -> Realized:
    """The candidate's form over the graph."""
    return _FORMS[c.form](g, c, sigma, tolerances)


def natural_size(e: Expr) -> float:
    """Natural size of an expression: its largest value at the probes."""
    finite = e.probe[np.isfinite(e.probe)]
    return float(np.max(np.abs(finite))) if finite.size else 1.0


def _divisor(g: ExpressionGraph, value: Expr, tol: Tolerances, power: int = 1) -> Divisor:
    if value.is_fixed:
        return Divisor(value)
    size = natural_size(value)
    magnitude = g.unary("abs", value) if power == 1 else value
    regular = g.binary("gt", magnitude, g.const(tol.singular**power * size))
    clear = g.binary("gt", magnitude, g.const(tol.flag**power * size))
    return Divisor(g.select(regular, value, g.one), regular, clear)


def leading(g: ExpressionGraph, coefficients: tuple[Expr, ...], tolerances: Tolerances) -> Divisor:
    """The sum of the squares of coefficients, as a divisor: where it vanishes the unknown is free."""
    return _divisor(g, g.dot([*coefficients], [*coefficients]), tolerances, 2)


def _linear(g: ExpressionGraph, c: Candidate, sigma: Expr, tol: Tolerances) -> Realized:
    a, b = c.coefficients
    divisor = _divisor(g, a, tol)
    return Realized((g.div(g.neg(b), divisor.value),), divisor, None, 1)


def _root(g: ExpressionGraph, c: Candidate, sigma: Expr, tol: Tolerances) -> Realized:
    a, b, k = c.coefficients
    divisor = _divisor(g, a, tol)
    half = g.mul(g.const(0.5), b)
    disc = g.sub(g.square(half), g.mul(a, k))
    guard = tol.guard(g, disc, natural_size(disc))
    w = g.mul(sigma, g.sqrt(disc))
    return Realized((g.div(g.sub(w, half), divisor.value),), divisor, guard, 2)


def _pair(g: ExpressionGraph, c: Candidate, sigma: Expr, tol: Tolerances) -> Realized:
    a1, b1, c1, a2, b2, c2 = c.coefficients
    det = g.sub(g.mul(a1, b2), g.mul(b1, a2))
    divisor = _divisor(g, det, tol)
    x = g.sub(g.mul(c1, b2), g.mul(c2, b1))
    y = g.sub(g.mul(a1, c2), g.mul(a2, c1))
    if det.is_fixed:
        return Realized((g.div(x, det), g.div(y, det)), divisor, None, 1)
    inverse = g.div(g.one, divisor.value)
    return Realized((g.mul(x, inverse), g.mul(y, inverse)), divisor, None, 1)


def _above(g: ExpressionGraph, value: Expr, least: Expr) -> Expr:
    return value if least is g.zero else g.binary("max", value, least)


def _sincos(g: ExpressionGraph, c: Candidate, sigma: Expr, tol: Tolerances) -> Realized:
    a, b, r = c.coefficients
    if a.is_fixed and b.is_fixed and (a.vanishes or b.vanishes):
        return _single(g, c, sigma, tol)
    h = g.add(g.square(a), g.square(b))
    divisor = _divisor(g, h, tol, 2)
    disc = g.sub(h, g.square(r))
    guard = tol.guard(g, disc, natural_size(h))
    w = g.mul(sigma, g.sqrt(_above(g, disc, g.mul(g.const(tol.fold), h))))
    inverse = g.div(g.one, divisor.value)
    cosine = g.mul(g.sub(g.mul(a, r), g.mul(b, w)), inverse)
    sine = g.mul(g.add(g.mul(b, r), g.mul(a, w)), inverse)
    return Realized((cosine, sine), divisor, guard, 2, (disc, h))


def _single(g: ExpressionGraph, c: Candidate, sigma: Expr, tol: Tolerances) -> Realized:
    """`A cos = C` or `B sin = C` with a fixed coefficient; the other of the pair takes sigma."""
    a, b, r = c.coefficients
    ratio = g.div(r, b if a.vanishes else a)
    disc = g.sub(g.one, g.square(ratio))
    guard = tol.guard(g, disc, 1.0)
    bounded = g.binary("max", g.minus_one, g.binary("min", g.one, ratio))
    other = g.mul(sigma, g.sqrt(_above(g, disc, g.const(tol.fold))))
    return Realized(
        (other, bounded) if a.vanishes else (bounded, other),
        Divisor(g.one),
        guard,
        2,
        (disc, g.one),
    )


def _tangent(g: ExpressionGraph, c: Candidate, sigma: Expr, tol: Tolerances) -> Realized:
    x, y = c.coefficients
    h = g.add(g.square(x), g.square(y))
    divisor = _divisor(g, h, tol, 2)
    inverse = g.div(sigma, g.sqrt(divisor.value))
    return Realized((g.mul(x, inverse), g.mul(y, inverse)), divisor, None, 2)


_FORMS = {
    "linear": _linear,
    "root": _root,
    "pair": _pair,
    "sincos": _sincos,
    "tangent": _tangent,
}
