"""`ikgen from-urdf` and `ikgen from-dh`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import (
    chain_options,
    console_options,
    emit_option,
    package_options,
    sampling_options,
    table_options,
)
from ikgen.cli.parameter_types import GivenPath, RobotFile
from ikgen.cli.request_options import make_request, parse_emit
from ikgen.errors import IkgenError, UsageError
from ikgen.records.request import Outputs, is_table

if TYPE_CHECKING:
    from ikgen.generation.generate import Generation

__all__ = ["from_dh", "from_urdf"]

_output = click.option(
    "-o",
    "--output",
    "out",
    metavar="DIR",
    type=GivenPath(),
    default=Path(),
    help="Where the outputs go (default: here).",
)
_depfile = click.option(
    "--depfile",
    metavar="FILE",
    type=GivenPath(),
    help="Also write which files the outputs depend on, as a Makefile rule.",
)
_depfile_target = click.option(
    "--depfile-target", metavar="FILE", help="The rule's target, verbatim (default: the outputs)."
)
_verify = click.option(
    "--no-verify", is_flag=True, help="Leave the verification out (and Pinocchio with it)."
)
_only = click.option(
    "--only", is_flag=True, help="Make the outputs of --emit alone, not those made here before too."
)
_force = click.option(
    "--force",
    is_flag=True,
    help="Replace outputs of another robot, chain or task, and files that were edited.",
)


@click.command("from-urdf")
@click.argument("robot", type=RobotFile())
@chain_options
@emit_option
@package_options
@_only
@_output
@_force
@_depfile
@_depfile_target
@sampling_options
@_verify
@console_options
def from_urdf(robot: Path, **options: Any) -> int:
    """Generate inverse kinematics from the URDF or xacro file ROBOT, and verify it."""
    if is_table(robot):
        raise UsageError(f"{robot} is a TOML file", hint=f"a DH table? ikgen from-dh {robot}")
    return _run(robot, **options)


@click.command("from-dh")
@click.argument("table", type=GivenPath())
@table_options
@emit_option
@package_options
@_only
@_output
@_force
@_depfile
@_depfile_target
@sampling_options
@_verify
@console_options
def from_dh(table: Path, **options: Any) -> int:
    """Generate inverse kinematics from the DH table TABLE (TOML), and verify it."""
    if not is_table(table):
        raise UsageError(f"{table} is not a TOML file", hint=f"a robot? ikgen from-urdf {table}")
    return _run(table, **options)


def _run(
    robot: Path,
    *,
    emit: tuple[str, ...],
    only: bool,
    out: Path,
    force: bool,
    depfile: Path | None,
    depfile_target: str | None,
    samples: int,
    seed: int,
    no_verify: bool,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **chain: Any,
) -> int:
    """The job of both commands; the exit code."""
    from ikgen.derivation.remedies import advised
    from ikgen.generation.generate import generate

    if depfile_target and depfile is None:
        raise UsageError("--depfile-target is of a --depfile", hint="give --depfile FILE as well")
    request = make_request(robot, **chain)
    outputs = Outputs(parse_emit(emit), out, samples, seed, not no_verify, only, force)
    try:
        with Console(quiet=quiet, verbose=verbose) as console, advised(request, console):
            generation = generate(request, outputs, console)
    except IkgenError as error:
        for text in error.warnings:
            console.warn(text)
        raise
    held = generation.derivation.held
    if held is not None:
        console.note(held.words)
    for text in _warnings(generation):
        console.warn(text)
    if depfile is not None:
        from ikgen.projects.depfile import write_depfile

        source = generation.derivation.reading.source
        targets = depfile_target or generation.files
        write_depfile(depfile, targets, source.dependencies or (source.path,))
    _report(generation, as_json=as_json, quiet=quiet, verbose=verbose)
    return 0


def _warnings(generation: Generation) -> list[str]:
    """What has to be told of the derivation, and what became of outputs of earlier runs."""
    from ikgen.derivation.announcements import announcements

    return [
        *announcements(generation.derivation),
        *(f"removed {path}: an earlier run made it" for path in generation.removed),
        *(
            f"{path} is of an earlier run: remove it, or name its output in --emit too"
            for path in generation.left
        ),
    ]


def _report(generation: Generation, *, as_json: bool, quiet: bool, verbose: bool) -> None:
    """The end of the job, in words or as JSON."""
    from ikgen.cli.summary_text import summary
    from ikgen.cli.work_text import work_text
    from ikgen.generation.result import as_dict

    if verbose and not quiet:
        click.echo(work_text(generation), err=True)
    if as_json:
        click.echo(json.dumps(as_dict(generation), indent=2, allow_nan=False))
    elif not quiet:
        click.echo(summary(generation))
