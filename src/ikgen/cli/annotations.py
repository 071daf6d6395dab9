"""Findings as annotations and a table, where a GitHub workflow runs the command."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from ikgen.build.recheck import Recheck

__all__ = ["write"]


def write(results: Sequence[Recheck]) -> None:
    """Annotations on stderr and the table of the step summary; nothing outside a workflow."""
    if os.environ.get("GITHUB_ACTIONS") == "true":
        for result in results:
            for finding in result.findings:
                text = _escape(f"{finding.message}. Run: {finding.command}")
                click.echo(f"::error file={_property(finding.file.as_posix())}::{text}", err=True)
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    if summary:
        with Path(summary).open("a", encoding="utf-8") as stream:
            stream.write(_table(results))


def _table(results: Sequence[Recheck]) -> str:
    lines = ["| module | output | poses | worst closure | result |", "|---|---|---|---|---|"]
    for result in results:
        name = result.record.name
        for finding in result.findings:
            message = finding.message.replace("|", "\\|")
            lines.append(f"| {name} | {finding.file.name} | | | WRONG: {message} |")
        for label, report in result.reports.items():
            metres, radians = report.worst_closure
            verdict = "right" if report.passed else "WRONG"
            closure = f"{metres:.1e} m, {radians:.1e} rad"
            lines.append(f"| {name} | {label} | {report.samples} | {closure} | {verdict} |")
    return "\n".join(lines) + "\n\n"


def _escape(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _escape(text).replace(":", "%3A").replace(",", "%2C")
