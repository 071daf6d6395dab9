"""Polynomials over the rationals modulo `c^2 + s^2 = 1` for every angle, in normal form.

Every angle has a cosine and a sine as generators, sqrt(2) and sqrt(3) are generators with known squares,
lengths and prismatic variables are free. In normal form no sine, and neither root, has a power above
one; then a polynomial vanishes at all values of the angles and lengths exactly when it is zero.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from random import Random
from typing import Any

from sympy.polys.domains import QQ
from sympy.polys.rings import ring

from ikgen.model.angle_function import cosine_and_sine
from ikgen.symbolic.exact_numbers import ROOTS, exact_number

__all__ = ["ExactRing"]

Pair = tuple[Any, Any]
_POINTS = 3


class ExactRing:
    """The ring with an angle for every name in `angles` and a free generator for every one in `free`.
    `inexact` gathers constants that no exact number was recognised in."""

    def __init__(self, angles: Sequence[str], free: Sequence[str]) -> None:
        functions = {angle: cosine_and_sine(angle) for angle in angles}
        names = [f.name for pair in functions.values() for f in pair]
        names += [*free, "root2", "root3"]
        made, *generators = ring(names, QQ)
        self.ring: Any = made
        gen: dict[str, Any] = dict(zip(names, generators, strict=True))
        self._pairs = {angle: (gen[c.name], gen[s.name]) for angle, (c, s) in functions.items()}
        self._free = {name: gen[name] for name in free}
        self._roots: tuple[Any, ...] = gen["root2"], gen["root3"]
        last = len(names) - 1
        self._squares: list[tuple[int, Any]] = [
            (2 * i + 1, 1 - c**2) for i, (c, _) in enumerate(self._pairs.values())
        ]
        self._squares += [(last - 1, self.ring(2)), (last, self.ring(3))]
        self.inexact: set[float] = set()

    def pair(self, angle: str) -> Pair:
        """Cosine and sine of a named angle."""
        return self._pairs[angle]

    def free(self, name: str) -> Any:
        """A free generator."""
        return self._free[name]

    def number(self, value: float) -> Any:
        """A constant."""
        found = exact_number(value)
        if not found.exact:
            self.inexact.add(value)
        two, three = self._roots
        units = (self.ring.one, two, three, two * three)
        assert len(units) == len(ROOTS)
        terms = (u * _rational(p) for p, u in zip(found.parts, units, strict=True) if p)
        return sum(terms, self.ring.zero)

    def multiply(self, a: Any, b: Any) -> Any:
        """a * b in normal form."""
        return self.reduce(a * b)

    def turned(self, angle: Pair, by: Pair, times: int) -> Pair:
        """Cosine and sine of `angle + times * by`."""
        c, s = angle
        bc, bs = by if times >= 0 else (by[0], -by[1])
        for _ in range(abs(times)):
            c, s = self.reduce(c * bc - s * bs), self.reduce(s * bc + c * bs)
        return c, s

    def reduce(self, p: Any) -> Any:
        """The normal form."""
        for index, square in self._squares:
            if any(monomial[index] > 1 for monomial in p):
                p = self._lowered(p, index, square)
        return p

    def _lowered(self, p: Any, index: int, square: Any) -> Any:
        """The polynomial with the square of one generator replaced."""
        parts: dict[int, Any] = {}
        for monomial, coefficient in p.items():
            half, rest = divmod(monomial[index], 2)
            kept = (*monomial[:index], rest, *monomial[index + 1 :])
            part = parts.setdefault(half, self.ring.zero.copy())
            part[kept] = part.get(kept, QQ.zero) + coefficient
        total = self.ring.zero
        for half, part in parts.items():
            part.strip_zero()
            total += part * square**half
        return total

    def size(self, p: Any) -> float:
        """The largest size of a polynomial at some values of angles and free generators."""
        random = Random(1)
        return max(abs(self._value(p, random)) for _ in range(_POINTS))

    def _value(self, p: Any, random: Random) -> float:
        at: list[float] = []
        for _ in self._pairs:
            angle = random.uniform(-math.pi, math.pi)
            at += [math.cos(angle), math.sin(angle)]
        at += [random.uniform(0.5, 1.5) for _ in self._free]
        at += [math.sqrt(2.0), math.sqrt(3.0)]
        terms = (
            float(coefficient) * math.prod(x**e for x, e in zip(at, monomial, strict=True) if e)
            for monomial, coefficient in p.items()
        )
        return math.fsum(terms)


def _rational(value: Fraction) -> Any:
    return QQ(value.numerator, value.denominator)
