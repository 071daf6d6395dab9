"""Sums, products and quotients of sums, written the shorter way: factored, or multiplied out."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product

from ikgen.formulas.normal_form import (
    Factor,
    Named,
    Radical,
    Sum,
    Symbol,
    Term,
    as_term,
    positive_first,
)

__all__ = ["add", "inverse", "length_of", "multiply", "single"]

_NOTHING = 1e-14
_KINDS = {"param": 0, "pose": 1, "prismatic": 2, "cos": 3, "sin": 3, "sigma": 4}
_MOST_TERMS = 40
"""Longer than this nothing is multiplied out."""

Factors = tuple[tuple[Factor, int], ...]


def single(factor: Factor) -> Sum:
    """One factor as a sum."""
    return Sum((Term(1.0, ((factor, 1),)),))


def add(a: Sum, b: Sum) -> Sum:
    """The sum, like terms collected; it starts with a positive term where there is one."""
    return _shortest(_collected((*a.terms, *b.terms)))


def multiply(a: Sum, b: Sum) -> Sum:
    """The product."""
    if a.is_zero or b.is_zero:
        return Sum(())
    return _shortest(Sum((_times(as_term(a), as_term(b)),)))


def inverse(s: Sum) -> Sum:
    """One over a sum."""
    term = as_term(s)
    return Sum((Term(1.0 / term.coefficient, tuple((f, -p) for f, p in term.factors)),))


def length_of(s: Sum) -> int:
    """How long a sum is on paper: symbols, numbers and pairs of parentheses."""
    numbers = sum(abs(abs(t.coefficient) - 1.0) > _NOTHING or not t.factors for t in s.terms)
    return numbers + sum(_length_of(f) for t in s.terms for f, _ in t.factors)


def _length_of(factor: Factor) -> int:
    if isinstance(factor, Sum):
        return 1 + length_of(factor)
    return 1 + length_of(factor.inside) if isinstance(factor, Radical) else 1


def _shortest(s: Sum) -> Sum:
    """The sum as it stands, or with parentheses multiplied out if that is shorter: numbers into them, and
    them by one another where terms cancel, for else they may have a name."""
    distributed = _collected(t for term in s.terms for t in _distributed(term))
    ways = [s, distributed]
    if any(isinstance(f, Sum) for term in s.terms for f, _ in term.factors):
        expanded = _expanded(s)
        if expanded is not None and len(expanded.terms) <= len(s.terms):
            ways.append(expanded)
    return min(ways, key=length_of)


def _distributed(term: Term) -> Iterable[Term]:
    """A number times a sum as the sum of its terms."""
    inside = term.factors[0] if len(term.factors) == 1 else None
    if inside is None or not isinstance(inside[0], Sum) or inside[1] != 1:
        return (term,)
    return (Term(term.coefficient * t.coefficient, t.factors) for t in inside[0].terms)


def _expanded(s: Sum) -> Sum | None:
    """All parentheses multiplied out; None for too many terms."""
    out: list[Term] = []
    for term in s.terms:
        sums = [f for f, p in term.factors if isinstance(f, Sum) and p > 0 for _ in range(p)]
        rest = tuple((f, p) for f, p in term.factors if not isinstance(f, Sum) or p < 0)
        count = 1
        for one in sums:
            count *= len(one.terms)
        if len(out) + count > _MOST_TERMS:
            return None
        for chosen in product(*(one.terms for one in sums)):
            made = Term(term.coefficient, rest)
            for each in chosen:
                made = _times(made, each)
            out.append(made)
    return _collected(out)


def _collected(terms: Iterable[Term]) -> Sum:
    """Like terms together."""
    total: dict[Factors, float] = {}
    for term in terms:
        total[term.factors] = total.get(term.factors, 0.0) + term.coefficient
    return Sum(positive_first([Term(c, f) for f, c in total.items() if abs(c) > _NOTHING]))


def _times(one: Term, two: Term) -> Term:
    powers: dict[Factor, int] = {}
    for factor, power in (*one.factors, *two.factors):
        powers[factor] = powers.get(factor, 0) + power
    factors = tuple(sorted(((f, p) for f, p in powers.items() if p), key=lambda x: _order(x[0])))
    return Term(one.coefficient * two.coefficient, factors)


def _order(factor: Factor) -> tuple[object, ...]:
    """Numbers, then lengths, pose entries, sines and cosines by joint, parentheses last."""
    if isinstance(factor, Symbol):
        first = factor.key if isinstance(factor.key, str) else ""
        places = (
            tuple(j for j, k in enumerate(factor.key) if k)
            if not isinstance(factor.key, str)
            else ()
        )
        return (_KINDS.get(factor.kind, 5), first, places, factor.kind, str(factor.key))
    if isinstance(factor, Named):
        return (6, "", (factor.index,), "", "")
    return (7, "", (), "", repr(factor))
