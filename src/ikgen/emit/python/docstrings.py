"""What docstrings of the runtime say first: all that emitted modules have of private ones."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

__all__ = ["Docstring", "docstrings", "summary"]

_WIDTH = 108
_STOP = re.compile(r"(?<![.])[.](?=\s|$)")
_PAUSE = re.compile(r"(?<![.])[.](?=\s|$)|;(?=\s)|:(?=\s[^(])")


@dataclass(frozen=True, slots=True)
class Docstring:
    """The lines (first, last, from 0) of a docstring, and those of one with its summary."""

    first: int
    last: int
    summary: tuple[str, ...]


def summary(text: str, *, short: bool = True) -> str:
    """What a docstring says before its first full stop, or where it is to be `short` semicolon or colon
    (but before a shape), outside of code and brackets; a full stop ends it."""
    line = " ".join(text.split("\n\n")[0].split())
    for end in (_PAUSE if short else _STOP).finditer(line):
        part = line[: end.start()]
        if part.count("`") % 2 == 0 and part.count("(") == part.count(")"):
            return f"{part}."
    return line


def docstrings(parts: Iterable[ast.AST], start: int) -> Iterator[Docstring]:
    """Those of functions and classes among the parts of a definition whose first line is `start` (from 1),
    in order, where they say more than their summary. Those of classes, which tell what their members
    are, are whole sentences."""
    blocks = [part for part in parts if isinstance(part, ast.FunctionDef | ast.ClassDef)]
    for part in sorted(blocks, key=lambda block: block.lineno):
        text, node = ast.get_docstring(part), part.body[0]
        if text is not None:
            first = summary(text, short=isinstance(part, ast.FunctionDef))
            if first != " ".join(text.split()):
                lines = tuple(_lines(first, " " * node.col_offset))
                yield Docstring(node.lineno - start, (node.end_lineno or 0) - start, lines)


def _lines(text: str, indent: str) -> list[str]:
    return textwrap.wrap(
        f'"""{text}"""',
        _WIDTH,
        initial_indent=indent,
        subsequent_indent=indent,
        break_long_words=False,
        break_on_hyphens=False,
    )
