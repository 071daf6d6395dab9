"""C++ as a table from operation to text, and its literals."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable

from ikgen.emit.printer import Language

__all__ = ["CONSTANT", "CPP", "LINE", "comment", "declared", "literal", "number"]

LINE = 110
"""Longest line of the emitted text."""

_PLAIN = frozenset(range(0x20, 0x7F)) - set(b'"\\?')


def literal(text: str) -> str:
    """A C++ string literal of the text in UTF-8, whatever characters it has."""
    return '"' + "".join(chr(b) if b in _PLAIN else f"\\{b:03o}" for b in text.encode()) + '"'


def comment(text: str) -> str:
    """The text as part of a comment of one line, which neither ends it nor carries it on."""
    return "".join(ch if ch.isprintable() and ch != "\\" else "?" for ch in text)


def number(value: float) -> str:
    """A C++ literal that reads back to the same double."""
    if value != value:
        return "std::numeric_limits<double>::quiet_NaN()"
    if value in (float("inf"), float("-inf")):
        return f"{'-' if value < 0 else ''}std::numeric_limits<double>::infinity()"
    return repr(float(value))


def declared(kind: str, values: Iterable[tuple[str, str]]) -> list[str]:
    """Lines that declare variables of one kind, each with its value."""
    text = ", ".join(f"{name} = {value}" for name, value in values)
    return (
        textwrap.wrap(
            f"{kind} {text};",
            LINE,
            subsequent_indent="    ",
            break_long_words=False,
            break_on_hyphens=False,
        )
        if text
        else []
    )


def _flag(text: str) -> str:
    return text if text.isidentifier() or text.startswith("(") else f"({text})"


CPP = Language(
    infix={
        "gt": (">", 1),
        "and": ("&", 2),
        "add": ("+", 5),
        "sub": ("-", 5),
        "mul": ("*", 6),
        "div": ("/", 6),
    },
    prefix={"neg": ("-", 7), "not": ("!", 7)},
    calls={
        "or": lambda a, b: f"({_flag(a)} | {_flag(b)})",
        "sqrt": lambda x: f"sqrt({x})",
        "abs": lambda x: f"abs({x})",
        "max": lambda a, b: f"max({a}, {b})",
        "min": lambda a, b: f"min({a}, {b})",
        "select": lambda c, a, b: f"select({c}, {a}, {b})",
        "atan2": lambda y, x: f"angle({y}, {x})",
        "spread": lambda x: f"spread<1>({x})",
    },
    number=number,
)

CONSTANT = Language(
    infix={**CPP.infix, "and": ("&&", 2)},
    prefix=CPP.prefix,
    calls={
        "or": lambda a, b: f"({a} || {b})",
        "sqrt": lambda x: f"std::sqrt(std::max({x}, 0.0))",
        "cos": lambda x: f"std::cos({x})",
        "sin": lambda x: f"std::sin({x})",
        "abs": lambda x: f"std::abs({x})",
        "max": lambda a, b: f"std::max<double>({a}, {b})",
        "min": lambda a, b: f"std::min<double>({a}, {b})",
        "select": lambda c, a, b: f"({c} ? {a} : {b})",
    },
    number=number,
)
"""Plain numbers in place of packs: values that depend on constants to be filled in alone."""
