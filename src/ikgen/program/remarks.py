"""Statements of a level under the comments that tell what they are for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ikgen.program.statements import Comment, Let, Require, Statement

__all__ = ["Remarked", "remarked", "with_remarks"]

Remarked = tuple[str, Let | Require]
"""A statement under a comment's text; that of none is empty."""


def remarked(body: Iterable[Statement]) -> Iterator[Remarked]:
    """Every statement with the comment that it stands under."""
    remark = ""
    for statement in body:
        if isinstance(statement, Comment):
            remark = statement.text
        else:
            yield remark, statement


def with_remarks(body: Iterable[Remarked]) -> tuple[Statement, ...]:
    """The statements, each comment above the first of those that stand under it."""
    out: list[Statement] = []
    last = ""
    for remark, statement in body:
        if remark not in ("", last):
            out.append(Comment(remark))
        last = remark
        out.append(statement)
    return tuple(out)
