"""`ikgen verify`: the check of outputs against their robot, for people and for CI."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ikgen.cli.annotations import annotate, annotate_error
from ikgen.cli.console import Console
from ikgen.cli.options import console_options, executor_options, sampling_options, trust_option
from ikgen.cli.parameter_types import GivenPath
from ikgen.cli.recheck_json import as_dict
from ikgen.errors import IkgenError

if TYPE_CHECKING:
    from ikgen.projects.check_findings import Finding, Recheck

__all__ = ["verify"]


@click.command()
@click.argument("target", type=GivenPath(), metavar="[CONFIG|DIR]", required=False)
@click.option(
    "--robot",
    metavar="FILE",
    type=GivenPath(),
    help="Check against this description instead of the recorded one.",
)
@click.option(
    "--junit-xml",
    metavar="FILE",
    type=GivenPath(),
    help="Also write the results as JUnit XML.",
)
@sampling_options
@executor_options
@click.option(
    "--prove",
    is_flag=True,
    help="Also prove the derivations, for every pose, in exact arithmetic (SymPy).",
)
@trust_option
@console_options
def verify(
    target: Path | None,
    *,
    robot: Path | None,
    junit_xml: Path | None,
    samples: int,
    seed: int,
    executor: str,
    scheduler: str | None,
    workers: int | None,
    prove: bool,
    trust: bool,
    as_json: bool,
    quiet: bool,
    verbose: bool,
) -> int:
    """Check emitted modules against their robot's description as it is now.

    CONFIG is an ikgen.toml or pyproject.toml, DIR a folder with outputs (default: the config here,
    else this folder). Exit code 0: all right; 1: wrong, edited or made from another geometry; 2:
    something could not be checked.
    """
    from ikgen.processes.executors import Workers
    from ikgen.projects.recheck_all import recheck_all, write_junit

    with Console(quiet=quiet, verbose=verbose) as console:
        try:
            results = recheck_all(
                target,
                robot=robot,
                samples=samples,
                seed=seed,
                trust=trust,
                prove=prove,
                workers=Workers(executor, workers, scheduler),
                progress=console,
                done=partial(console.share, "verify"),
            )
        except IkgenError as error:
            annotate_error(error)
            raise
    _print(results, as_json=as_json, quiet=quiet, verbose=verbose)
    # after the findings, which are told even if this file cannot be written; before the object of --json,
    # in place of which the error's is printed then
    if junit_xml is not None:
        write_junit(junit_xml, results)
    code = max((result.exit_code for result in results), default=0)
    if as_json:
        click.echo(json.dumps(as_dict(results, code), indent=2, allow_nan=False))
    return code


def _print(results: Sequence[Recheck], *, as_json: bool, quiet: bool, verbose: bool) -> None:
    from ikgen.cli.tables import verification_tables

    annotate(results)
    for result in results:
        if verbose and result.reports:
            click.echo(verification_tables(result.reports), err=True)
        for finding in result.findings:
            click.echo(f"error: {_placed(finding)}", err=True)
        for remedy in dict.fromkeys(f.remedy for f in result.findings if f.remedy):
            click.echo(f"hint: {remedy}", err=True)
        if not quiet and not as_json:
            click.echo(_line(result))
            for remark in result.proof.remarks if result.proof else ():
                click.echo(f"  {remark}")


def _placed(finding: Finding) -> str:
    """The message with its file; those of descriptions begin with file and line themselves."""
    file = f"{finding.file}:"
    return finding.message if finding.message.startswith(file) else f"{file} {finding.message}"


def _line(result: Recheck) -> str:
    """One line about one record."""
    proof = (result.proof.words,) if result.proof else ()
    notes = "".join(f"; {note}" for note in (*proof, *result.notes))
    if not result.passed:
        verdict = "WRONG" if result.exit_code == 1 else "NOT CHECKED"
        return f"{result.name}: {verdict}{notes}"
    if not result.reports:
        return f"{result.name}: as recorded (nothing to run){notes}"
    parts = []
    for name, report in result.reports.items():
        metres, radians = report.worst_closure
        closure = f"closure {metres:.1e} m {radians:.1e} rad"
        parts.append(f"{name} {report.samples} poses, {closure}, {report.missed_words}")
    return f"{result.name}: right ({'; '.join(parts)}){notes}"
