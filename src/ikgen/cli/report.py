"""`ikgen report`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from ikgen.cli.console import Console
from ikgen.cli.error_output import ResultError
from ikgen.cli.options import chain_options, console_options, force_option, sampling_options
from ikgen.cli.parameter_types import GivenPath, RobotFile
from ikgen.cli.request_options import make_request
from ikgen.generation.emitters import EMITTERS
from ikgen.records.request import Outputs

__all__ = ["report"]


@click.command()
@click.argument("robot", type=RobotFile(), metavar="ROBOT|TABLE")
@chain_options
@click.option(
    "-o",
    "--output",
    "out",
    metavar="DIR",
    type=GivenPath(),
    default=Path(),
    help="Where the report goes (default: here).",
)
@click.option(
    "--emit",
    multiple=True,
    type=click.Choice([row.name for row in EMITTERS if row.with_report]),
    help="Also write the solutions and equations as a module of SymPy expressions.",
)
@force_option
@sampling_options
@click.option("--no-verify", is_flag=True, help="Leave the table of verification out.")
@console_options
def report(
    robot: Path,
    *,
    out: Path,
    emit: tuple[str, ...],
    force: bool,
    samples: int,
    seed: int,
    no_verify: bool,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **chain: Any,
) -> None:
    """Write how the inverse kinematics of ROBOT was derived: LaTeX, HTML, graph and trace.

    Without a closed form the report says how far the solver came, and the exit code is 3; with a
    failed verification it has the failed checks, and the exit code is 1.
    """
    from ikgen.generation.report_files import write_report

    outputs = Outputs(
        emit=emit, out=out, samples=samples, seed=seed, verify=not no_verify, force=force
    )
    with Console(quiet=quiet, verbose=verbose) as console:
        made = write_report(make_request(robot, **chain), outputs, console)
        for text in made.warnings:
            console.warn(text)
    result = {"files": [str(path) for path in made.files]}
    if not quiet and not as_json:
        for path in made.files:
            click.echo(f"wrote: {path}")
    if made.wrong is not None:
        raise ResultError(made.wrong, result)
    if as_json:
        click.echo(json.dumps(result, indent=2))
