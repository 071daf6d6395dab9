"""Expressions as sums of products, like terms collected: what a reader would write down.

Only what the leaves' coefficients are made of is covered: + - * / and square roots.
"""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.algebra.expression import Expr

__all__ = [
    "Factor",
    "Named",
    "Normalizer",
    "Radical",
    "Sum",
    "Symbol",
    "Term",
    "constant",
    "factor_of",
]

_NOTHING = 1e-14


@dataclass(frozen=True, slots=True)
class Symbol:
    """A parameter ("param"), pose entry, cosine, sine or joint length; `key` as in `Atom`."""

    kind: str
    key: tuple[int, ...] | str


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
        return Sum(_positive_first([Term(-t.coefficient, t.factors) for t in self.terms]))


@dataclass(frozen=True, slots=True)
class Radical:
    """A square root."""

    inside: Sum


Factor = Symbol | Named | Sum | Radical

_KINDS = {"param": 0, "pose": 1, "prismatic": 2, "cos": 3, "sin": 3, "sigma": 4}


def weight_of(factor: Factor) -> int:
    """Number of symbols in a factor."""
    if isinstance(factor, Sum):
        return factor.weight
    return 1 + factor.inside.weight if isinstance(factor, Radical) else 1


def constant(value: float) -> Sum:
    """A number."""
    return Sum((Term(value, ()),)) if abs(value) > _NOTHING else Sum(())


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


class Normalizer:
    """Turns nodes into sums, each node once."""

    def __init__(self) -> None:
        self._done: dict[int, Sum] = {}

    def __call__(self, node: Expr) -> Sum:
        """The node as a sum."""
        found = self._done.get(node.id)
        if found is None:
            found = self._done[node.id] = self._make(node)
        return found

    def _make(self, node: Expr) -> Sum:
        if node.op == "const":
            return constant(node.value)
        if node.op == "param":
            return _single(Symbol("param", node.name))
        if node.atom is not None:
            return _single(Symbol(node.atom.kind, node.atom.key))
        parts = [self(a) for a in node.args]
        if node.op == "add":
            return _add(parts[0], parts[1])
        if node.op == "sub":
            return _add(parts[0], -parts[1])
        if node.op == "neg":
            return -parts[0]
        if node.op == "mul":
            return _multiply(parts[0], parts[1])
        if node.op == "div":
            return _multiply(parts[0], _inverse(parts[1]))
        if node.op == "sqrt":
            return _single(Radical(parts[0]))
        return _single(Symbol("other", f"{node.op}{node.id}"))


def _single(factor: Factor) -> Sum:
    return Sum((Term(1.0, ((factor, 1),)),))


def _add(a: Sum, b: Sum) -> Sum:
    """The sum, like terms collected; it starts with a positive term where there is one."""
    total: dict[tuple[tuple[Factor, int], ...], float] = {}
    for term in (*a.terms, *b.terms):
        total[term.factors] = total.get(term.factors, 0.0) + term.coefficient
    return Sum(_positive_first([Term(c, f) for f, c in total.items() if abs(c) > _NOTHING]))


def _positive_first(terms: list[Term]) -> tuple[Term, ...]:
    """The terms, the first positive one in front."""
    for i, term in enumerate(terms):
        if term.coefficient > 0:
            terms.insert(0, terms.pop(i))
            break
    return tuple(terms)


def _as_term(s: Sum) -> Term:
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
    factor = _as_term(s).factors[0][0]
    return factor if len(s.terms) > 1 and isinstance(factor, Sum) else s


def _multiply(a: Sum, b: Sum) -> Sum:
    if a.is_zero or b.is_zero:
        return Sum(())
    one, two = _as_term(a), _as_term(b)
    powers: dict[Factor, int] = {}
    for factor, power in (*one.factors, *two.factors):
        powers[factor] = powers.get(factor, 0) + power
    factors = tuple(sorted(((f, p) for f, p in powers.items() if p), key=lambda x: _order(x[0])))
    return Sum((Term(one.coefficient * two.coefficient, factors),))


def _inverse(s: Sum) -> Sum:
    term = _as_term(s)
    return Sum((Term(1.0 / term.coefficient, tuple((f, -p) for f, p in term.factors)),))
