"""Findings as annotations and a table, where a GitHub workflow runs the command."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ikgen.errors import BadDescriptionError, IkgenError

if TYPE_CHECKING:
    from ikgen.projects.check_findings import Finding, Recheck

__all__ = ["annotate", "annotate_error"]


def annotate(results: Sequence[Recheck]) -> None:
    """Annotations on stderr and the table of the step summary; nothing outside a workflow."""
    for result in results:
        for finding in result.findings:
            _annotate(_told(finding), finding.file, finding.line)
    _summarise(_table(results))


def annotate_error(error: IkgenError) -> None:
    """The error that ends the command, as an annotation and in the step summary."""
    text = f"{error.message}. {error.hint}".strip()
    if isinstance(error, BadDescriptionError) and error.file:
        _annotate(text, Path(error.file), error.line or 1)
    else:
        _annotate(text)
    _summarise(f"ikgen verify could not check anything: {error.message}\n\n")


def _annotate(text: str, file: Path | None = None, line: int = 1) -> None:
    if os.environ.get("GITHUB_ACTIONS") == "true":
        place = f" file={_property(_in_workspace(file))},line={line}" if file is not None else ""
        click.echo(f"::error{place}::{_escape(text)}", err=True)


def _told(finding: Finding) -> str:
    """A finding and the way out in one line."""
    if finding.command:
        return f"{finding.message}. Run: {finding.command}"
    return f"{finding.message}. {finding.hint}".strip()


def _in_workspace(file: Path) -> str:
    """A path as annotations want it: relative to the checkout, wherever the command runs."""
    workspace = Path(os.environ.get("GITHUB_WORKSPACE") or Path.cwd()).resolve()
    whole = file.resolve()
    inside = whole.is_relative_to(workspace)
    return (whole.relative_to(workspace) if inside else file).as_posix()


def _summarise(text: str) -> None:
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    if summary:
        with Path(summary).open("a", encoding="utf-8") as stream:
            stream.write(text)


def _table(results: Sequence[Recheck]) -> str:
    lines = ["| module | output | poses | worst closure | result |", "|---|---|---|---|---|"]
    for result in results:
        name = result.name
        for finding in result.findings:
            message = finding.message.replace("|", "\\|")
            verdict = "WRONG" if finding.exit_code == 1 else "could not check"
            lines.append(f"| {name} | {finding.file.name} | | | {verdict}: {message} |")
        for label, report in result.reports.items():
            metres, radians = report.worst_closure
            verdict = "right" if report.passed else "WRONG"
            closure = f"{metres:.1e} m, {radians:.1e} rad"
            lines.append(f"| {name} | {label} | {report.samples} | {closure} | {verdict} |")
    findings = [finding for result in results for finding in result.findings]
    commands = dict.fromkeys(f.command for f in findings if f.command)
    fixes = "".join(f"\nRun `{command}` and commit what it writes.\n" for command in commands)
    return "\n".join(lines) + f"\n{fixes}\n"


def _escape(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _escape(text).replace(":", "%3A").replace(",", "%2C")
