"""Interpreter of a Program: the reference that every emitted language is compared to."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from ikgen.program.ops import Op, Operand
from ikgen.program.statements import Let, Level, Program, Require

__all__ = ["Row", "evaluate", "run"]

Routine = Callable[..., list[tuple[float, ...]]]

_BINARY: dict[str, Callable[[float, float], float]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "max": max,
    "min": min,
    "atan2": math.atan2,
    "gt": lambda a, b: float(a > b),
    "and": lambda a, b: float(bool(a) and bool(b)),
    "or": lambda a, b: float(bool(a) or bool(b)),
}
_UNARY: dict[str, Callable[[float], float]] = {
    "neg": lambda a: -a,
    "abs": abs,
    "sqrt": lambda a: math.sqrt(max(a, 0.0)),
    "cos": math.cos,
    "sin": math.sin,
    "not": lambda a: float(not a),
}


@dataclass(frozen=True, slots=True)
class Row:
    """One solution: the joint values (rad or m), and whether it is one of a continuum."""

    q: tuple[float, ...]
    singular: bool


def evaluate(operand: Operand, names: Mapping[str, float]) -> float:
    """The operand's number (conditions: 1 or 0) where `names` gives the names that it reads."""
    if isinstance(operand, str):
        return names[operand]
    if isinstance(operand, Op):
        args = [evaluate(a, names) for a in operand.args]
        if operand.op == "select":
            return args[1] if args[0] else args[2]
        if operand.op in _UNARY:
            return _UNARY[operand.op](args[0])
        return _BINARY[operand.op](args[0], args[1])
    return operand


def _body(level: Level, names: dict[str, float]) -> bool:
    for statement in level.body:
        if isinstance(statement, Let):
            names[statement.name] = evaluate(statement.value, names)
        elif isinstance(statement, Require) and not evaluate(statement.condition, names):
            return False
    return True


def _branches(
    level: Level, names: dict[str, float], routines: Mapping[str, Routine]
) -> Iterator[dict[str, float]]:
    if level.call is not None:
        arguments = [evaluate(a, names) for a in level.call.arguments]
        for root in routines[level.call.routine.name](*arguments):
            yield {**names, **dict(zip(level.call.names, root, strict=True))}
    elif level.sigma is not None:
        yield {**names, level.sigma: 1.0}
        yield {**names, level.sigma: -1.0}
    else:
        yield names


def run(
    program: Program,
    inputs: Mapping[str, float],
    routines: Mapping[str, Routine] | None = None,
) -> list[Row]:
    """All rows of a program at given inputs, in the order of its branches."""
    names = dict(inputs) | {one.name: one.value for one in program.parameters}
    for let in (*program.constants, *program.prelude):
        names[let.name] = evaluate(let.value, names)
    rows: list[Row] = []

    def descend(index: int, names: dict[str, float]) -> None:
        if index == len(program.levels):
            q = tuple(evaluate(o.value, names) for o in program.outputs)
            rows.append(Row(q, any(names[s] for s in program.singular)))
            return
        for branch in _branches(program.levels[index], names, routines or {}):
            if _body(program.levels[index], branch):
                descend(index + 1, branch)

    descend(0, names)
    return rows
