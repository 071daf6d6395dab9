"""`ikgen from-urdf` and `ikgen from-dh`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import (
    chain_options,
    console_options,
    make_request,
    parse_emit,
    sampling_options,
)
from ikgen.errors import UnsolvedChainError, UsageError, VerificationError
from ikgen.generation.generation import Generation, Outputs, generate
from ikgen.generation.pipeline import Request
from ikgen.generation.publish import left_over

__all__ = ["from_dh", "from_urdf"]

_output = click.option(
    "-o",
    "--output",
    "out",
    metavar="DIR",
    type=click.Path(path_type=Path),
    default=Path(),
    help="Where the outputs go (default: here).",
)
_emit = click.option(
    "--emit", multiple=True, metavar="NAME,...", help="Outputs, for example python,cpp."
)
_depfile = click.option(
    "--depfile",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Also write which files the outputs depend on, as a Makefile rule.",
)
_depfile_target = click.option(
    "--depfile-target", metavar="FILE", help="The rule's target, verbatim (default: the outputs)."
)
_verify = click.option(
    "--no-verify", is_flag=True, help="Leave the verification out (and Pinocchio with it)."
)

_NOT_OF_TABLES = {
    "base": "--base",
    "tip": "--tip",
    "arguments": "--arg",
    "package_paths": "--package-path",
}
"""Parameters of `from_dh` that a table has no use for, and the options that set them."""


@click.command("from-urdf")
@click.argument("robot", type=click.Path(path_type=Path))
@chain_options
@_emit
@_output
@_depfile
@_depfile_target
@sampling_options
@_verify
@console_options
def from_urdf(robot: Path, **options: Any) -> int:
    """Generate inverse kinematics from the URDF or xacro file ROBOT, and verify it."""
    if robot.suffix.lower() == ".toml":
        raise UsageError(f"{robot} is a TOML file", hint=f"a DH table? ikgen from-dh {robot}")
    return _run(robot, **options)


@click.command("from-dh")
@click.argument("table", type=click.Path(path_type=Path))
@chain_options
@_emit
@_output
@_depfile
@_depfile_target
@sampling_options
@_verify
@console_options
def from_dh(table: Path, **options: Any) -> int:
    """Generate inverse kinematics from the DH table TABLE (TOML), and verify it."""
    if table.suffix.lower() != ".toml":
        raise UsageError(f"{table} is not a TOML file", hint=f"a robot? ikgen from-urdf {table}")
    for parameter, option in _NOT_OF_TABLES.items():
        if options[parameter]:
            raise UsageError(f"a DH table is one chain without arguments: leave {option} out")
    return _run(table, **options)


def _run(
    robot: Path,
    *,
    emit: tuple[str, ...],
    out: Path,
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
    request: Request = make_request(robot, **chain)
    outputs = Outputs(parse_emit(emit), out, samples, seed, not no_verify)
    try:
        with Console(quiet=quiet, verbose=verbose) as console:
            try:
                generation = generate(request, outputs, console)
            except UnsolvedChainError as error:
                from ikgen.generation.remedies import helped

                raise helped(error, console) from None
    except VerificationError as error:
        if verbose:
            from ikgen.cli.tables import verification_tables

            click.echo(verification_tables(error.reports), err=True)
        raise
    for warning in generation.derivation.reading.source.warnings:
        console.warn(warning)
    module, names = generation.derivation.module, [path.name for path in generation.files]
    for path in left_over(out, module.name, names):
        console.warn(f"{path} is of an earlier run: remove it, or name its output in --emit too")
    if depfile is not None:
        from ikgen.projects.depfile import write_depfile

        source = generation.derivation.reading.source
        targets = depfile_target or generation.files
        write_depfile(depfile, targets, source.dependencies or (source.path,))
    _report(generation, as_json=as_json, quiet=quiet, verbose=verbose)
    return 0


def _report(generation: Generation, *, as_json: bool, quiet: bool, verbose: bool) -> None:
    """The end of the job, in words or as JSON."""
    from ikgen.cli.summary import as_dict, summary, trace

    if verbose and not quiet:
        click.echo(trace(generation), err=True)
    if as_json:
        import json

        click.echo(json.dumps(as_dict(generation), indent=2, allow_nan=False))
    elif not quiet:
        click.echo(summary(generation))
