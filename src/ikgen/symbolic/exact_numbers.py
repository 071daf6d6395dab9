"""Floating-point constants as the exact numbers that they are rounded values of.

Cosines and sines of multiples of pi/12 lie in the field of sqrt(2) and sqrt(3); lengths and other
numbers are read as the short fraction or decimal that a file has. What is neither is taken as its
shortest decimal, and `exact` says no.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import sympy

__all__ = ["ROOTS", "ExactNumber", "exact_number"]

ROOTS = (1, 2, 3, 6)
"""An exact number is a sum of rational multiples of the square roots of these."""

_SIMPLE = 10**6, 8e-16
_SIMPLE_SURD = 10**2, 4e-15
"""The largest denominator, and what round-off leaves of the number, relative to it."""

_SURDS: tuple[tuple[int, int, int, int], ...] = (
    (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1), (0, 1, 0, 1), (0, -1, 0, 1), (1, 0, 1, 0), (-1, 0, 1, 0),
)  # fmt: skip
"""What cosines and sines of multiples of pi/12, and products of two of them, are rational multiples
of."""


@dataclass(frozen=True, slots=True)
class ExactNumber:
    """`sum(parts[i] * sqrt(ROOTS[i]))`; `exact`: the floating-point number was recognised."""

    parts: tuple[Fraction, Fraction, Fraction, Fraction]
    exact: bool = True

    @property
    def sympy(self) -> sympy.Expr:
        """The number in SymPy."""
        terms = (
            sympy.Rational(p.numerator, p.denominator) * sympy.sqrt(n)
            for p, n in zip(self.parts, ROOTS, strict=True)
        )
        return sympy.Add(*terms)


def exact_number(value: float) -> ExactNumber:
    """The number that `value` is the rounded value of."""
    plain = _short(value, *_SIMPLE)
    if plain is not None:
        return _rational(plain)
    for surd in _SURDS:
        size = sum(k * math.sqrt(n) for k, n in zip(surd, ROOTS, strict=True))
        factor = _short(value / size, *_SIMPLE_SURD)
        if factor is not None:
            a, b, c, d = (factor * k for k in surd)
            return ExactNumber((a, b, c, d))
    decimal = Fraction(repr(float(value)))
    return ExactNumber((decimal, *_NO_ROOTS), _is_decimal(decimal))


_NO_ROOTS = (Fraction(0), Fraction(0), Fraction(0))
_DIGITS = 10**12


def _rational(value: Fraction) -> ExactNumber:
    return ExactNumber((value, *_NO_ROOTS))


def _is_decimal(value: Fraction) -> bool:
    """Whether somebody may have written the number: twelve decimals at most."""
    return (value * _DIGITS).denominator == 1


def _short(value: float, most: int, round_off: float) -> Fraction | None:
    """The fraction with a denominator up to `most` that `value` is the rounded value of, if there is
    one."""
    found = Fraction(value).limit_denominator(most)
    return found if abs(float(found) - value) <= round_off * abs(value) else None
