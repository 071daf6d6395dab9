"""`ikgen reach`: a map of what an arm reaches."""

from __future__ import annotations

import json
import shlex
import time
from functools import partial
from pathlib import Path
from typing import Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import (
    chain_options,
    console_options,
    executor_options,
    force_option,
)
from ikgen.cli.parameter_types import GivenPath, RobotFile
from ikgen.cli.request_options import make_request

__all__ = ["reach"]


@click.command()
@click.argument("robot", type=RobotFile(), metavar="ROBOT|TABLE")
@chain_options
@click.option(
    "--cells",
    metavar="N",
    type=click.IntRange(min=1),
    default=40,
    show_default=True,
    help="Positions along the longest side of the box that the tip reaches.",
)
@click.option(
    "--directions",
    metavar="N",
    type=click.IntRange(min=1),
    default=24,
    show_default=True,
    help="Directions of the tool's z axis at each position.",
)
@click.option(
    "--rolls",
    metavar="N",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="Turns about the tool's z axis in each direction.",
)
@click.option(
    "-o",
    "--output",
    "out",
    metavar="DIR|FILE",
    type=GivenPath(),
    default=Path(),
    help="Where the map goes (default: here); a file ends in .npz or .zarr.",
)
@force_option
@executor_options
@click.option(
    "--portable", is_flag=True, help="Compile for any processor of this kind, not this one alone."
)
@console_options
def reach(
    robot: Path,
    *,
    cells: int,
    directions: int,
    rolls: int,
    out: Path,
    force: bool,
    executor: str,
    scheduler: str | None,
    workers: int | None,
    portable: bool,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **chain: Any,
) -> None:
    """Map how many solutions each pose of a grid has inside the limits, and how good the best one is.

    Writes NAME_reach.npz, the arrays with their coordinates, and NAME_reach.html, slices of them; with
    -o FILE.zarr a zarr group in place of the .npz.
    """
    from ikgen.processes.executors import Workers
    from ikgen.reach.map_files import MapOrder, write_map

    started = time.perf_counter()
    request = make_request(robot, **chain)
    fineness = ("--cells", cells, "--directions", directions, "--rolls", rolls)
    again = ["ikgen", "reach", robot.name, *request.options, *map(str, fineness)]
    order = MapOrder(
        cells, directions, rolls, Workers(executor, workers, scheduler),
        portable=portable or scheduler is not None, command=shlex.join(again), force=force,
    )  # fmt: skip
    with Console(quiet=quiet, verbose=verbose) as console:
        done = partial(console.share, "map")
        found, files = write_map(request, order, out, console, console.warn, done)
    seconds = time.perf_counter() - started
    if as_json:
        names = [str(path) for path in files]
        record = {"files": names, "poses": found.grid.poses, "solved": found.solved}
        click.echo(json.dumps(record | {"seconds": round(seconds, 3)}, indent=2))
    elif not quiet:
        share = f"{100 * found.solved:.1f} % with a solution inside the limits"
        click.echo(f"{found.grid.poses:,} poses in {seconds:.1f} s, {share}")
        for path in files:
            click.echo(f"wrote: {path}")
