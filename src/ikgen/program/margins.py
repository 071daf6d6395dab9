"""Conditions as numbers: positive where they hold, and zero where they cease to."""

from __future__ import annotations

from math import sqrt

from ikgen.program.ops import Op, Operand
from ikgen.program.statements import Program, Require

__all__ = ["fold_margins", "margin"]

_PARTS = {"and": "min", "or": "max", "not": "neg"}


def margin(condition: Operand) -> Operand:
    """A number that is positive where a condition holds; a comparison's is the difference of its sides, of
    their roots where a square has to be below a number: it is not to be small beside what is not
    squared. That of a condition by name is 1 or -1."""
    if not isinstance(condition, Op):
        return Op("select", (condition, 1.0, -1.0))
    if condition.op == "gt":
        bound, value = condition.args
        if isinstance(bound, float) and bound > 0.0 and _has_square(value):
            return Op("sub", (sqrt(bound), Op("sqrt", (value,))))
        return Op("sub", condition.args)
    return Op(_PARTS[condition.op], tuple(margin(part) for part in condition.args))


def _has_square(value: Operand) -> bool:
    """Whether it is a product with the square of something."""
    if not isinstance(value, Op) or value.op != "mul":
        return False
    left, right = value.args
    return left == right or _has_square(left) or _has_square(right)


def fold_margins(program: Program) -> int:
    """How many guards of a Program say where two solutions meet."""
    return sum(isinstance(s, Require) and s.fold for lv in program.levels for s in lv.body)
