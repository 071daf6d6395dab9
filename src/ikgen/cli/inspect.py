"""`ikgen inspect`: what a description holds and what can be done with it; writes nothing."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import chain_options, console_options
from ikgen.cli.parameter_types import RobotFile
from ikgen.cli.request_options import make_request

__all__ = ["inspect"]


@click.command()
@click.argument("robot", type=RobotFile(), metavar="ROBOT|TABLE")
@chain_options
@click.option("--no-advice", is_flag=True, help="Try no derivation.")
@console_options
def inspect(
    robot: Path, *, no_advice: bool, as_json: bool, quiet: bool, verbose: bool, **chain: Any
) -> None:
    """Show the joint tree, the chains, the DH table, the geometry and advice; write nothing."""
    from ikgen.cli.inspect_json import as_dict
    from ikgen.cli.inspect_text import as_text
    from ikgen.derivation.inspection import inspect_robot

    request = make_request(robot, **chain)
    with Console(quiet=quiet, verbose=verbose) as console:
        found = inspect_robot(request, console, advice=not no_advice)
    for warning in found.warnings:
        console.warn(warning)
    click.echo(json.dumps(as_dict(found), indent=2, allow_nan=False) if as_json else as_text(found))
