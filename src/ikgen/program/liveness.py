"""What of a Program its results depend on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ikgen.program.ops import Operand, operand_names
from ikgen.program.remarks import remarked, with_remarks
from ikgen.program.statements import Let, Level, Program, Require, Statement

__all__ = ["live_names", "trimmed"]


def _reads(level: Level) -> Iterator[Operand]:
    """Operands of a level that count whether or not anything else reads them."""
    if level.call is not None:
        yield from level.call.arguments
    yield from level.solved
    yield from (s.condition for s in level.body if isinstance(s, Require))


def live_names(program: Program) -> set[str]:
    """Names that a result, a guard or a flag depends on."""
    lets = [s for level in program.levels for s in level.body if isinstance(s, Let)]
    value = {let.name: let.value for let in (*program.constants, *program.prelude, *lets)}
    roots: list[Operand] = [*program.singular, *program.doubts, *program.residuals]
    for level in program.levels:
        roots += _reads(level)
    roots += [output.value for output in program.outputs]
    live: set[str] = set()
    stack = [name for root in roots for name in operand_names(root)]
    while stack:
        name = stack.pop()
        if name not in live:
            live.add(name)
            stack += operand_names(value[name]) if name in value else ()
    return live


def trimmed(program: Program) -> Program:
    """The Program without inputs, values of joints and values of levels that nothing reads."""
    live = live_names(program)

    def kept(body: tuple[Statement, ...]) -> tuple[Statement, ...]:
        stay = (s for s in remarked(body) if isinstance(s[1], Require) or s[1].name in live)
        return with_remarks(stay)

    return replace(
        program,
        levels=tuple(replace(level, body=kept(level.body)) for level in program.levels),
        inputs=tuple(one for one in program.inputs if one.name in live),
        prelude=tuple(let for let in program.prelude if let.name in live),
    )
