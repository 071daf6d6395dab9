"""C++ text by its brackets: where statements end, without comments and literals in the way."""

from __future__ import annotations

import re

__all__ = ["masked", "past_brackets", "past_declaration", "past_statement"]

_NO_CODE = re.compile(r"""//[^\n]*|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""")
_BRACKET = re.compile(r"[{}()\[\];]")
_OPENING = "{(["


def masked(text: str) -> str:
    """The text with blanks in place of comments and literals."""
    return _NO_CODE.sub(lambda found: " " * len(found[0]), text)


def past_brackets(code: str, at: int) -> int:
    """Behind the bracket that closes the one at a place of masked text."""
    depth = 0
    for found in _BRACKET.finditer(code, at):
        if found[0] != ";":
            depth += 1 if found[0] in _OPENING else -1
        if depth == 0:
            return found.end()
    raise ValueError("a bracket is not closed")


def past_statement(code: str, at: int) -> int:
    """Behind the statement that begins at a place of masked text, after blanks."""
    head = re.compile(r"\s*(?:(if)(?: constexpr)? |(?:for|while) )?").match(code, at)
    begin = head.end() if head is not None else at
    if head is not None and head[0].strip():
        end = past_statement(code, past_brackets(code, begin))
        more = re.compile(r"\s*else\b").match(code, end) if head[1] else None
        return end if more is None else past_statement(code, more.end())
    if code[begin] == "{":
        return past_brackets(code, begin)
    while (found := _BRACKET.search(code, begin)) is not None:
        if found[0] == ";":
            return found.end()
        begin = past_brackets(code, found.start())
    raise ValueError("a statement does not end")


def past_declaration(code: str, at: int) -> int:
    """Behind the line on which the declaration ends that begins at a place of masked text."""
    while (found := _BRACKET.search(code, at)) is not None:
        at = found.end() if found[0] == ";" else past_brackets(code, found.start())
        closed = found[0] == ";" or (found[0] == "{" and not code[at : at + 1].strip())
        if closed:
            return code.find("\n", at) + 1 or len(code)
    raise ValueError("a declaration does not end")
