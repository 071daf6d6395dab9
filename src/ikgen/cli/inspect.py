"""`ikgen inspect`: what a description holds and what can be done with it; writes nothing."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import chain_options, console_options, make_request
from ikgen.generation.pipeline import Reading, Request, read

if TYPE_CHECKING:
    from ikgen.cli.inspection import Findings

__all__ = ["inspect"]


@click.command()
@click.argument("robot", type=click.Path(path_type=Path), metavar="ROBOT|TABLE")
@chain_options
@click.option("--no-advice", is_flag=True, help="Try no derivation.")
@console_options
def inspect(
    robot: Path, *, no_advice: bool, as_json: bool, quiet: bool, verbose: bool, **chain: Any
) -> None:
    """Show the joint tree, the chains, the DH table, the geometry and advice; write nothing."""
    from ikgen.cli.inspection import as_dict, as_text

    request = make_request(robot, **chain)
    with Console(quiet=quiet, verbose=verbose) as console:
        findings = _find(request, console, advice=not no_advice)
    for warning in findings.warnings:
        console.warn(warning)
    if as_json:
        click.echo(json.dumps(as_dict(findings), indent=2, allow_nan=False))
    else:
        click.echo(as_text(findings))


def _find(request: Request, console: Console, *, advice: bool) -> Findings:
    """Read the file; the chain and what follows from it where it is clear which one."""
    from ikgen.cli.inspection import Findings
    from ikgen.generation.advice import attempts

    console("read", request.robot.name)
    if request.robot.suffix.lower() == ".toml":
        table = read(request)
        tried = attempts(table.dh, request.task, console) if advice else []
        return Findings(table, None, (), tried)
    from ikgen.chains.arms import candidate_chains
    from ikgen.importers import load_tree

    tree = load_tree(
        request.robot, arguments=request.arguments, package_paths=request.package_paths
    )
    candidates = candidate_chains(tree, request.base)
    reading: Reading | None = None
    if request.tip is not None or len(candidates) == 1:
        reading = read(request)
    tried = attempts(reading.dh, request.task, console) if advice and reading else []
    return Findings(reading, tree, candidates, tried)
