"""The roots of a polynomial of degree four in radicals, and the proof that they are."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TypeAlias

import sympy

__all__ = ["quartic_roots", "roots_are_proved"]

Expression: TypeAlias = sympy.Expr


def quartic_roots(coefficients: Sequence[Expression]) -> tuple[Expression, ...]:
    """The four complex roots of `p4 z^4 + p3 z^3 + p2 z^2 + p1 z + p0`, highest power first; they hold
    where nothing that they divide by vanishes."""
    b, c, d, e = (x / coefficients[0] for x in coefficients[1:])
    p = c - 3 * b**2 / 8
    q = d - b * c / 2 + b**3 / 8
    r = e - b * d / 4 + b**2 * c / 16 - 3 * b**4 / 256
    root = sympy.sqrt(2 * _resolvent_root(p, q, r))
    out = []
    for sign in (1, -1):
        half = sympy.sqrt(-(root**2 + 2 * p + sign * 2 * q / root))
        out += [(sign * root + half) / 2 - b / 4, (sign * root - half) / 2 - b / 4]
    return tuple(out)


def _resolvent_root(p: Expression, q: Expression, r: Expression) -> Expression:
    """A root m of `m^3 + p m^2 + (p^2 / 4 - r) m - q^2 / 8`, by Cardano's formula."""
    linear, constant = -(p**2) / 12 - r, -(p**3) / 108 + p * r / 3 - q**2 / 8
    inside = sympy.sqrt(constant**2 / 4 + linear**3 / 27)
    cube = (-constant / 2 + inside) ** sympy.Rational(1, 3)
    return cube - linear / (3 * cube) - p / 3


@cache
def roots_are_proved() -> bool:
    """Whether the formulas give roots, by reduction modulo what each radical's power is."""
    b, c, d, e, z, y = sympy.symbols("b c d e z y")
    p = c - 3 * b**2 / 8
    q = d - b * c / 2 + b**3 / 8
    r = e - b * d / 4 + b**2 * c / 16 - 3 * b**4 / 256
    moved = (z**4 + b * z**3 + c * z**2 + d * z + e).subs(z, y - b / 4)
    depressed = sympy.expand(moved - (y**4 + p * y**2 + q * y + r)) == 0
    return bool(depressed) and _resolvent_proved() and _cubic_proved()


def _resolvent_proved() -> bool:
    """`y = (s M + N) / 2` with `M^2 = 2 m`, m a root of the resolvent, and N as above."""
    p, q, r, s, M, N, y = sympy.symbols("p q r s M N y")
    m = M**2 / 2
    relations = [
        s**2 - 1,
        m**3 + p * m**2 + (p**2 / 4 - r) * m - q**2 / 8,
        M * (N**2 + M**2 + 2 * p) + 2 * s * q,
        y - (s * M + N) / 2,
    ]
    basis = sympy.groebner(relations, y, N, r, M, p, q, s, order="grevlex")
    return bool(basis.contains(M**2 * (y**4 + p * y**2 + q * y + r)))


def _cubic_proved() -> bool:
    """`m = C - P / (3 C) - p / 3` with `C^3 = -Q / 2 + R` and `R^2 = Q^2 / 4 + P^3 / 27`."""
    p, q, r, C, R, m = sympy.symbols("p q r C R m")
    linear, constant = -(p**2) / 12 - r, -(p**3) / 108 + p * r / 3 - q**2 / 8
    resolvent = m**3 + p * m**2 + (p**2 / 4 - r) * m - q**2 / 8
    above = sympy.numer(sympy.together(resolvent.subs(m, C - linear / (3 * C) - p / 3)))
    over = sympy.rem(sympy.expand(above), C**6 + constant * C**3 - linear**3 / 27, C)
    root = sympy.expand((-constant / 2 + R) ** 2 + constant * (-constant / 2 + R) - linear**3 / 27)
    left = sympy.rem(root, R**2 - constant**2 / 4 - linear**3 / 27, R)
    return bool(sympy.expand(over) == 0 and sympy.expand(left) == 0)
