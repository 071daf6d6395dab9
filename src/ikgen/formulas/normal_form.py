"""Sums of products as a reader would write them down: symbols, powers, parentheses and square roots."""

from __future__ import annotations

from dataclasses import dataclass, field

from ikgen.model.angle_function import AngleFunction

__all__ = [
    "Factor",
    "Named",
    "Radical",
    "Sum",
    "Symbol",
    "Term",
    "as_term",
    "constant",
    "factor_of",
    "positive_first",
    "weight_of",
]

_NOTHING = 1e-14


@dataclass(frozen=True, slots=True)
class Symbol:
    """A parameter ("param"), pose entry, cosine, sine or joint length; `key` as in `Atom`. `function`: what
    a parameter is of a constant angle; sums order symbols by the other two."""

    kind: str
    key: tuple[int, ...] | str
    function: AngleFunction | None = field(default=None, repr=False)


@dataclass(frozen=True, slots=True)
class Named:
    """An abbreviation u_1, u_2, ... that the report defines."""

    index: int


@dataclass(frozen=True, slots=True)
class Term:
    """`coefficient * product(factor ** power)`."""

    coefficient: float
    factors: tuple[tuple[Factor, int], ...]


@dataclass(frozen=True, slots=True)
class Sum:
    """Terms in the order that they are written; empty for zero."""

    terms: tuple[Term, ...]

    @property
    def is_zero(self) -> bool:
        """Whether nothing is left."""
        return not self.terms

    @property
    def value(self) -> float | None:
        """The number, where it is one."""
        if not self.terms:
            return 0.0
        if len(self.terms) == 1 and not self.terms[0].factors:
            return self.terms[0].coefficient
        return None

    @property
    def weight(self) -> int:
        """Number of symbols written."""
        return sum(max(1, sum(weight_of(f) for f, _ in t.factors)) for t in self.terms)

    def __neg__(self) -> Sum:
        return Sum(positive_first([Term(-t.coefficient, t.factors) for t in self.terms]))


@dataclass(frozen=True, slots=True)
class Radical:
    """A square root."""

    inside: Sum


Factor = Symbol | Named | Sum | Radical


def weight_of(factor: Factor) -> int:
    """Number of symbols in a factor."""
    if isinstance(factor, Sum):
        return factor.weight
    return 1 + factor.inside.weight if isinstance(factor, Radical) else 1


def constant(value: float) -> Sum:
    """A number."""
    return Sum((Term(value, ()),)) if abs(value) > _NOTHING else Sum(())


def positive_first(terms: list[Term]) -> tuple[Term, ...]:
    """The terms, the first positive one in front."""
    for i, term in enumerate(terms):
        if term.coefficient > 0:
            terms.insert(0, terms.pop(i))
            break
    return tuple(terms)


def as_term(s: Sum) -> Term:
    """A sum as one factor of a product, its sign pulled out, so that a - b and b - a are one."""
    if len(s.terms) == 1:
        return s.terms[0]
    decides = min(s.terms, key=lambda t: repr(t.factors))
    all_negative = all(t.coefficient < 0 for t in s.terms)
    mixed = any(t.coefficient < 0 for t in s.terms) and not all_negative
    sign = -1.0 if all_negative or (mixed and decides.coefficient < 0) else 1.0
    return Term(sign, ((s if sign > 0 else -s, 1),))


def factor_of(s: Sum) -> Sum:
    """The sum or its negative, whichever stands in products."""
    factor = as_term(s).factors[0][0]
    return factor if len(s.terms) > 1 and isinstance(factor, Sum) else s
