"""`ikgen verify`: the check of outputs against their robot, for people and for CI."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ikgen.cli.annotations import annotate, annotate_error
from ikgen.cli.console import Console
from ikgen.cli.options import console_options, sampling_options
from ikgen.errors import IkgenError, UsageError

if TYPE_CHECKING:
    from ikgen.projects.check_findings import Finding, Recheck

__all__ = ["verify"]


@click.command()
@click.argument("target", type=click.Path(path_type=Path), metavar="[CONFIG|DIR]", required=False)
@click.option(
    "--robot",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Check against this description instead of the recorded one.",
)
@click.option(
    "--junit-xml",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Also write the results as JUnit XML.",
)
@sampling_options
@console_options
def verify(
    target: Path | None,
    *,
    robot: Path | None,
    junit_xml: Path | None,
    samples: int,
    seed: int,
    as_json: bool,
    quiet: bool,
    verbose: bool,
) -> int:
    """Check emitted modules against their robot's description as it is now.

    CONFIG is an ikgen.toml or pyproject.toml, DIR a folder with outputs (default: the config here,
    else this folder). Exit code 0: all right; 1: wrong, edited or made from another geometry; 2:
    something could not be checked.
    """
    with Console(quiet=quiet, verbose=verbose) as console:
        try:
            results = _recheck_all(target, robot, (samples, seed), console)
        except IkgenError as error:
            annotate_error(error)
            raise
    if junit_xml is not None:
        _write_junit(junit_xml, results)
    _print(results, as_json=as_json, quiet=quiet, verbose=verbose)
    return max((result.exit_code for result in results), default=0)


def _recheck_all(
    target: Path | None, robot: Path | None, sampling: tuple[int, int], console: Console
) -> list[Recheck]:
    """Check everything that is meant, in order."""
    return [
        _recheck(path, robot, command, sampling, console)
        for path, command in _records(target, robot)
    ]


def _recheck(
    path: Path,
    robot: Path | None,
    command: str | None,
    sampling: tuple[int, int],
    console: Console,
) -> Recheck:
    """Check one record; an error becomes its finding, so that the others are checked too."""
    from ikgen.generation.record import read_record
    from ikgen.projects.check_findings import unchecked
    from ikgen.projects.recheck import recheck

    samples, seed = sampling
    record = None
    try:
        record = read_record(path)
        return recheck(
            record, robot=robot, command=command, samples=samples, seed=seed, progress=console
        )
    except IkgenError as error:
        return unchecked(path, record, error)


def _records(target: Path | None, robot: Path | None) -> list[tuple[Path, str | None]]:
    """The records meant, each with the command that makes its outputs again, if not its own."""
    from ikgen.generation.record import find_records
    from ikgen.projects.config import default_config, load_config

    target = target or default_config(Path()) or Path()
    if target.is_dir():
        return [(path, None) for path in find_records(target)]
    if target.suffix == ".json":
        return [(target, None)]
    if not target.is_file():
        raise UsageError(f"{target}: no such file or directory")
    command = f"ikgen build {target}" if robot is None else None
    return [(arm.record_path, command) for arm in load_config(target)]


def _print(results: Sequence[Recheck], *, as_json: bool, quiet: bool, verbose: bool) -> None:
    from ikgen.cli.tables import verification_tables

    annotate(results)
    if as_json:
        click.echo(
            json.dumps(
                {
                    "passed": all(r.passed for r in results),
                    "outputs": [_as_dict(r) for r in results],
                },
                indent=2,
                allow_nan=False,
            )
        )
    for result in results:
        if verbose and result.reports:
            click.echo(verification_tables(result.reports), err=True)
        for finding in result.findings:
            click.echo(f"error: {_placed(finding)}", err=True)
        for command in dict.fromkeys(f.command for f in result.findings if f.command):
            click.echo(f"hint: {command}", err=True)
        if not quiet and not as_json:
            click.echo(_line(result))


def _placed(finding: Finding) -> str:
    """The message with its file; those of descriptions begin with file and line themselves."""
    file = f"{finding.file}:"
    return finding.message if finding.message.startswith(file) else f"{file} {finding.message}"


def _line(result: Recheck) -> str:
    """One line about one record."""
    notes = "".join(f"; {note}" for note in result.notes)
    if not result.passed:
        verdict = "WRONG" if result.exit_code == 1 else "NOT CHECKED"
        return f"{result.name}: {verdict}{notes}"
    if not result.reports:
        return f"{result.name}: as recorded (nothing to run){notes}"
    parts = []
    for name, report in result.reports.items():
        metres, radians = report.worst_closure
        parts.append(f"{name} {report.samples} poses, closure {metres:.1e} m {radians:.1e} rad")
    return f"{result.name}: right ({'; '.join(parts)}){notes}"


def _as_dict(result: Recheck) -> dict[str, Any]:
    return {
        "name": result.name,
        "record": result.path.as_posix(),
        "robot": result.record.robot.as_posix() if result.record else None,
        "passed": result.passed,
        "findings": [_finding(finding) for finding in result.findings],
        "notes": list(result.notes),
        "verification": {name: report.to_dict() for name, report in result.reports.items()},
    }


def _finding(finding: Finding) -> dict[str, Any]:
    metres, radians = finding.deviation or (None, None)
    return {
        "file": finding.file.as_posix(),
        "message": finding.message,
        "command": finding.command,
        "deviation": None if metres is None else {"m": metres, "rad": radians},
    }


def _write_junit(path: Path, results: Sequence[Recheck]) -> None:
    """One suite an output; findings that no verification holds become a suite of their own."""
    from ikgen.verify.junit import write_junit_xml
    from ikgen.verify.verification_report import CheckResult, VerificationReport

    suites = []
    for result in results:
        record = result.record
        checks = tuple(
            CheckResult("up to date", False, 1, 1, detail=f.message, worst_case=f.command)
            for f in result.findings
        ) or (CheckResult("up to date", True, len(record.files) if record else 0),)
        chain = (record.base, record.tip, record.task) if record else ("", "", "")
        own = VerificationReport("outputs", *chain, 0, 0, checks)
        suites += [(result.name, report) for report in (own, *result.reports.values())]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_junit_xml(path, suites)
