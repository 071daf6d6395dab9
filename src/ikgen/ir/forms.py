"""What each solution form computes: its values, guards and degenerate conditions as expressions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.equations.expression import Expr, ExpressionGraph
from ikgen.solver.candidate import Candidate

__all__ = ["SINGULAR_TOLERANCE", "Realized", "realize"]

SINGULAR_TOLERANCE = 1e-11
"""A divisor below this, relative to its natural size, makes its joint free."""

CLAMP_TOLERANCE = 1e-11
"""How far outside its domain a square root's argument may be, relative to its natural size: poses on
the boundary of the workspace are reachable."""


@dataclass(frozen=True, slots=True)
class Realized:
    """`values`: (cosine, sine) or (distance,), defined where `regular` (None: always) holds; `guard`:
    condition for a real solution (None: always); `branches`: how many signs of sigma differ."""

    values: tuple[Expr, ...]
    regular: Expr | None
    guard: Expr | None
    branches: int


def realize(g: ExpressionGraph, c: Candidate, sigma: Expr, clamp: float) -> Realized:
    """The candidate's form over the graph. `clamp` widens the domain of square roots."""
    return _FORMS[c.form](g, c, sigma, max(clamp, CLAMP_TOLERANCE))


def _size(e: Expr) -> float:
    """Natural size of an expression: its largest value at the probes."""
    finite = e.probe[np.isfinite(e.probe)]
    return float(np.max(np.abs(finite))) if finite.size else 1.0


def _safe_divisor(g: ExpressionGraph, divisor: Expr, power: int = 1) -> tuple[Expr, Expr | None]:
    """The divisor with 1 in its place where it vanishes, and the condition that it does not."""
    if divisor.is_fixed:
        return divisor, None
    limit = g.const(SINGULAR_TOLERANCE**power * _size(divisor))
    regular = g.binary("gt", g.unary("abs", divisor) if power == 1 else divisor, limit)
    return g.select(regular, divisor, g.one), regular


def _linear(g: ExpressionGraph, c: Candidate, sigma: Expr, clamp: float) -> Realized:
    a, b = c.coefficients
    divisor, regular = _safe_divisor(g, a)
    return Realized((g.div(g.neg(b), divisor),), regular, None, 1)


def _root(g: ExpressionGraph, c: Candidate, sigma: Expr, clamp: float) -> Realized:
    a, b, k = c.coefficients
    divisor, regular = _safe_divisor(g, a)
    half = g.mul(g.const(0.5), b)
    disc = g.sub(g.square(half), g.mul(a, k))
    guard = g.binary("gt", disc, g.const(-clamp * _size(disc)))
    w = g.mul(sigma, g.sqrt(disc))
    return Realized((g.div(g.sub(w, half), divisor),), regular, guard, 2)


def _pair(g: ExpressionGraph, c: Candidate, sigma: Expr, clamp: float) -> Realized:
    a1, b1, c1, a2, b2, c2 = c.coefficients
    det = g.sub(g.mul(a1, b2), g.mul(b1, a2))
    divisor, regular = _safe_divisor(g, det)
    x = g.sub(g.mul(c1, b2), g.mul(c2, b1))
    y = g.sub(g.mul(a1, c2), g.mul(a2, c1))
    if divisor.is_fixed:
        return Realized((g.div(x, divisor), g.div(y, divisor)), None, None, 1)
    inverse = g.div(g.one, divisor)
    return Realized((g.mul(x, inverse), g.mul(y, inverse)), regular, None, 1)


def _sincos(g: ExpressionGraph, c: Candidate, sigma: Expr, clamp: float) -> Realized:
    a, b, r = c.coefficients
    if a.is_fixed and b.is_fixed and (a.vanishes or b.vanishes):
        return _single(g, c, sigma, clamp)
    h = g.add(g.square(a), g.square(b))
    divisor, regular = _safe_divisor(g, h, 2)
    disc = g.sub(h, g.square(r))
    guard = g.binary("gt", disc, g.const(-clamp * _size(h)))
    w = g.mul(sigma, g.sqrt(disc))
    inverse = g.div(g.one, divisor)
    cosine = g.mul(g.sub(g.mul(a, r), g.mul(b, w)), inverse)
    sine = g.mul(g.add(g.mul(b, r), g.mul(a, w)), inverse)
    return Realized((cosine, sine), regular, guard, 2)


def _single(g: ExpressionGraph, c: Candidate, sigma: Expr, clamp: float) -> Realized:
    """`A cos = C` or `B sin = C` with a fixed coefficient; the other of the pair takes sigma."""
    a, b, r = c.coefficients
    ratio = g.div(r, b if a.vanishes else a)
    disc = g.sub(g.one, g.square(ratio))
    guard = g.binary("gt", disc, g.const(-clamp))
    bounded = g.binary("max", g.minus_one, g.binary("min", g.one, ratio))
    other = g.mul(sigma, g.sqrt(disc))
    return Realized((other, bounded) if a.vanishes else (bounded, other), None, guard, 2)


def _tangent(g: ExpressionGraph, c: Candidate, sigma: Expr, clamp: float) -> Realized:
    x, y = c.coefficients
    h = g.add(g.square(x), g.square(y))
    divisor, regular = _safe_divisor(g, h, 2)
    inverse = g.div(sigma, g.sqrt(divisor))
    return Realized((g.mul(x, inverse), g.mul(y, inverse)), regular, None, 2)


_FORMS = {
    "linear": _linear,
    "root": _root,
    "pair": _pair,
    "sincos": _sincos,
    "tangent": _tangent,
}
