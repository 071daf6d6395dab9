"""Abbreviations u_1, u_2, ... for sums that are long or come again."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from ikgen.formulas.normal_form import Factor, Named, Radical, Sum, Term, factor_of

__all__ = ["Abbreviations"]

_AGAIN = 4
"""Symbols from which on a sum that comes again gets a name."""

_LONG = 14
"""Symbols from which on a sum in parentheses gets a name even if it comes once."""


class Abbreviations:
    """Names for the sums inside the given formulas, numbered in the order of their use."""

    def __init__(self, formulas: Iterable[Sum]) -> None:
        self._count: Counter[Sum] = Counter()
        self._index: dict[Sum, int] = {}
        self._by_terms: dict[frozenset[Term], int] = {}
        self._told: set[int] = set()
        self._definition: dict[int, Sum] = {}
        tops = []
        for formula in dict.fromkeys(formulas):
            tops.append(formula)
            for inner in _inner(formula):
                self._count[inner] += 1
        for top in tops:
            for form in (top, -top):
                if form in self._count:
                    self._count[form] += 1

    def _wanted(self, s: Sum) -> bool:
        if s in self._index:
            return True
        return (self._count[s] > 1 and s.weight >= _AGAIN) or (
            s in self._count and s.weight >= _LONG
        )

    def short(self, s: Sum) -> Sum:
        """The formula with names in it."""
        named = self._named(s)
        if named is not None:
            return Sum((Term(named[1], ((named[0], 1),)),))
        for form, sign in ((s, 1.0), (-s, -1.0)):
            if len(s.terms) > 1 and self._wanted(form):
                return Sum((Term(sign, ((self._name(form), 1),)),))
        return self.inside(s)

    def force(self, s: Sum) -> Sum:
        """A name for a formula that will be used several times, unless it is short."""
        worth = len(s.terms) > 1 and s.weight >= _AGAIN + 2
        if worth and self._named(s) is None:
            factor = factor_of(s)
            self._name(factor if factor in self._count else s)
        return self.short(s)

    def unbroken(self, s: Sum) -> Sum:
        """A formula where no line can break: it and the sums in its products have names unless short."""
        for term in s.terms if len(s.terms) == 1 else ():
            for factor, _ in term.factors:
                if isinstance(factor, Sum):
                    self.force(factor)
        return self.force(s)

    def inside(self, s: Sum) -> Sum:
        """The formula with names inside its terms, but not for the whole."""
        return Sum(tuple(self._term(t) for t in s.terms))

    def _term(self, term: Term) -> Term:
        coefficient, factors = term.coefficient, []
        for factor, power in term.factors:
            short, sign = self._factor(factor)
            coefficient *= sign**power
            factors.append((short, power))
        return Term(coefficient, tuple(factors))

    def _factor(self, factor: Factor) -> tuple[Factor, float]:
        """The factor with names in it, and its sign."""
        if isinstance(factor, Radical):
            return Radical(self.short(factor.inside)), 1.0
        if not isinstance(factor, Sum):
            return factor, 1.0
        named = self._named(factor)
        if named is not None:
            return named
        return (self._name(factor) if self._wanted(factor) else self.inside(factor)), 1.0

    def _named(self, s: Sum) -> tuple[Named, float] | None:
        """The name that a sum or its negative has, whatever the order of the terms; its sign."""
        for sign in (1.0, -1.0):
            terms = frozenset(Term(sign * t.coefficient, t.factors) for t in s.terms)
            if terms in self._by_terms:
                return Named(self._by_terms[terms]), sign
        return None

    def _name(self, s: Sum) -> Named:
        if s not in self._index:
            definition = self.inside(s)
            self._index[s] = len(self._index) + 1
            self._by_terms[frozenset(s.terms)] = self._index[s]
            self._definition[self._index[s]] = definition
        return Named(self._index[s])

    def news(self) -> list[tuple[Named, Sum]]:
        """Names used since the last call, with what they stand for."""
        fresh = [i for i in self._definition if i not in self._told]
        self._told.update(fresh)
        return [(Named(i), self._definition[i]) for i in sorted(fresh)]


def _inner(s: Sum) -> Iterator[Sum]:
    for term in s.terms:
        for factor, _ in term.factors:
            inside = factor.inside if isinstance(factor, Radical) else factor
            if isinstance(inside, Sum):
                yield inside
                yield from _inner(inside)
