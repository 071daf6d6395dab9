"""The closed set of operations of a Program, and what each means.

| op | meaning |
|---|---|
| add, sub, mul, div, neg, abs, max, min | IEEE double arithmetic, in the order written |
| sqrt | sqrt(max(x, 0)): never NaN for finite x |
| gt | 1 if a > b else 0 |
| and, or, not | on results of gt |
| cos, sin | of radians |
| atan2 | (y, x): the angle of the pair in (-pi, pi], which need not be normalized |
| select | (condition, then, otherwise): both sides are finite, neither traps |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["BOOLEAN", "Op", "Operand", "operand_names", "renamed"]

BOOLEAN = frozenset({"gt", "and", "or", "not"})


@dataclass(frozen=True, slots=True)
class Op:
    """An operation on operands: names, numbers or nested operations."""

    op: str
    args: tuple[Operand, ...]


Operand = str | float | Op


def operand_names(operand: Operand) -> set[str]:
    """The names that an operand reads."""
    if isinstance(operand, Op):
        return set().union(*(operand_names(a) for a in operand.args))
    return {operand} if isinstance(operand, str) else set()


def renamed(operand: Operand, names: Mapping[str, str]) -> Operand:
    """The operand with other names where `names` has them."""
    if isinstance(operand, Op):
        return Op(operand.op, tuple(renamed(a, names) for a in operand.args))
    return names.get(operand, operand) if isinstance(operand, str) else operand
