"""What `ikgen verify` found, as a dictionary; `docs/reference/verify.schema.json` is its schema."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ikgen.cli.error_output import as_object

if TYPE_CHECKING:
    from ikgen.projects.check_findings import Finding, Recheck

__all__ = ["as_dict"]


def as_dict(results: Sequence[Recheck], code: int) -> dict[str, Any]:
    """For --json; `code` is the exit code."""
    found: dict[str, Any] = {
        "passed": all(result.passed for result in results),
        "outputs": [_output(result) for result in results],
    }
    if code:
        count = sum(not result.passed for result in results)
        hints = [f.remedy for result in results for f in result.findings if f.remedy]
        message = f"{count} of {len(results)} outputs are wrong or could not be checked"
        found["error"] = as_object(message, "\n".join(dict.fromkeys(hints)), code)
    return found


def _output(result: Recheck) -> dict[str, Any]:
    found = {
        "name": result.name,
        "record": result.path.as_posix(),
        "robot": result.record.request.robot.as_posix() if result.record else None,
        "passed": result.passed,
        "findings": [_finding(finding) for finding in result.findings],
        "notes": list(result.notes),
        "verification": {name: report.to_dict() for name, report in result.reports.items()},
    }
    return found if result.proof is None else {**found, "proof": result.proof.to_dict()}


def _finding(finding: Finding) -> dict[str, Any]:
    metres, radians = finding.deviation or (None, None)
    return {
        "file": finding.file.as_posix(),
        "message": finding.message,
        "command": finding.remedy,
        "deviation": None if metres is None else {"m": metres, "rad": radians},
    }
