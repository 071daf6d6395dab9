"""Errors on stderr in words; with --json on stdout as an object."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import click

from ikgen.cli.work_text import work_text
from ikgen.errors import (
    INTERNAL_ERROR,
    BadDescriptionError,
    IkgenError,
    UnsolvedChainError,
    VerificationError,
)

__all__ = ["ResultError", "as_object", "say", "say_object", "say_work"]


class ResultError(Exception):
    """An error that ends a command which has a result all the same: `result` is what --json prints of
    it."""

    def __init__(self, error: IkgenError, result: Mapping[str, Any]) -> None:
        super().__init__(error.message)
        self.error = error
        self.result = result


def say(message: str, hint: str = "") -> None:
    """An error on stderr: what, and what to do; further lines of a hint stand below its first."""
    click.echo(f"error: {message}", err=True)
    if hint:
        click.echo("hint: " + hint.replace("\n", "\n      "), err=True)


def say_work(error: BaseException, exit_code: int) -> None:
    """On stderr how far the work came before an error, or where in ikgen it broke."""
    if exit_code == INTERNAL_ERROR:
        import traceback

        text = "".join(traceback.format_exception(error))
    else:
        text = work_text(error) if isinstance(error, IkgenError) else ""
    if text:
        click.echo(text, err=True)


def say_object(error: Mapping[str, Any], result: Mapping[str, Any] | None = None) -> None:
    """The error object on stdout, beside what there is of a result."""
    click.echo(json.dumps({**(result or {}), "error": error}, indent=2, allow_nan=False))


def as_object(
    message: str, hint: str, exit_code: int, error: BaseException | None = None
) -> dict[str, Any]:
    """What `error` holds: message, hint and exit code, and what is known beyond."""
    found: dict[str, Any] = {"message": message, "hint": hint or None, "exit_code": exit_code}
    if isinstance(error, BadDescriptionError) and error.file:
        found |= {"file": error.file, "line": error.line}
    if isinstance(error, UnsolvedChainError) and error.unsolved is not None:
        graph, dh = error.unsolved.graph, error.unsolved.reading.dh
        found |= {
            "task": error.unsolved.task.name,
            "solved": list(graph.order),
            "left": [dh.joints[j].name for j in graph.open_joints],
        }
    if isinstance(error, VerificationError):
        found["verification"] = {name: r.to_dict() for name, r in error.reports.items()}
    return found
