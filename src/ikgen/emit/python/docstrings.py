"""What docstrings of the runtime say first: all that emitted modules have of private ones."""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

__all__ = ["Docstring", "comment_lines", "docstrings", "summary"]

_WRAPPED: dict[str, Any] = {"width": 108, "break_long_words": False, "break_on_hyphens": False}
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
    """Docstrings of functions and classes among the parts of a definition whose first line is `start`
    (from 1), in order, where they say more than their summary. Those of classes, which tell what their
    members are, are whole sentences; of methods that implement what a protocol tells there are none."""
    blocks = [part for part in parts if isinstance(part, ast.FunctionDef | ast.ClassDef)]
    for part in sorted(blocks, key=lambda block: block.lineno):
        text, node = ast.get_docstring(part), part.body[0]
        if text is not None:
            first = summary(text, short=isinstance(part, ast.FunctionDef))
            if text.startswith("Implements `"):
                yield Docstring(node.lineno - start, (node.end_lineno or 0) - start, ())
            elif first != " ".join(text.split()):
                lines = tuple(_lines(first, " " * node.col_offset))
                yield Docstring(node.lineno - start, (node.end_lineno or 0) - start, lines)


def comment_lines(text: str) -> list[str]:
    """The text as lines of a comment."""
    return textwrap.wrap(f"# {text}", subsequent_indent="# ", **_WRAPPED)


def _lines(text: str, indent: str) -> list[str]:
    quoted = f'"""{text}"""'
    return textwrap.wrap(quoted, initial_indent=indent, subsequent_indent=indent, **_WRAPPED)
