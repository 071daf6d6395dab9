"""Operands of a Program as infix text: a language is a table from operation to text."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ikgen.program.ops import Op, Operand

__all__ = ["Language", "Style", "expression"]

Style = Callable[..., str]


@dataclass(frozen=True, slots=True)
class Language:
    """`infix`: operation -> (symbol, precedence); `prefix`: operation -> (symbol, precedence);
    `calls`: operation -> writer of the finished text from its arguments' texts."""

    infix: Mapping[str, tuple[str, int]]
    prefix: Mapping[str, tuple[str, int]]
    calls: Mapping[str, Style]
    number: Callable[[float], str]


def expression(language: Language, operand: Operand, around: int = 0) -> str:
    """The operand's text, in parentheses where the surrounding precedence needs them.

    The tree's own grouping is kept: floating-point sums are not reassociated.
    """
    if isinstance(operand, str):
        return operand
    if not isinstance(operand, Op):
        text = language.number(operand)
        return f"({text})" if text.startswith("-") and around > 0 else text
    if operand.op in language.calls:
        return language.calls[operand.op](*(expression(language, a) for a in operand.args))
    if operand.op in language.prefix:
        symbol, own = language.prefix[operand.op]
        inner = expression(language, operand.args[0], own)
        text = symbol + (
            f"({inner})" if inner.startswith(symbol) else inner
        )  # C has an operator --
    else:
        symbol, own = language.infix[operand.op]
        left = expression(language, operand.args[0], own)
        right = expression(language, operand.args[1], own + 1)
        text = f"{left} {symbol} {right}"
    return f"({text})" if own < around else text
