"""What of a Program its results depend on."""

from __future__ import annotations

from collections.abc import Iterator

from ikgen.program.ops import Operand, operand_names
from ikgen.program.statements import Let, Level, Program, Require

__all__ = ["live_names", "used_inputs"]


def _reads(level: Level) -> Iterator[Operand]:
    """Operands of a level that count whether or not anything else reads them."""
    if level.call is not None:
        yield from level.call.arguments
    yield from (s.condition for s in level.body if isinstance(s, Require))


def live_names(program: Program) -> set[str]:
    """Names that a result, a guard or a flag depends on."""
    value = {
        s.name: s.value for level in program.levels for s in level.body if isinstance(s, Let)
    } | {let.name: let.value for let in program.constants}
    roots: list[Operand] = [*program.singular, *program.residuals]
    for level in program.levels:
        roots += _reads(level)
    for output in program.outputs:
        roots += [output.cosine, output.sine]
    live: set[str] = set()
    stack = [name for root in roots for name in operand_names(root)]
    while stack:
        name = stack.pop()
        if name not in live:
            live.add(name)
            stack += operand_names(value[name]) if name in value else ()
    return live


def used_inputs(program: Program) -> list[str]:
    """Inputs that the Program reads, in its order."""
    live = live_names(program)
    return [name for name in program.inputs if name in live]
