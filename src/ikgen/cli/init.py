"""`ikgen init`."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ikgen.cli.console import Console
from ikgen.cli.options import (
    console_options,
    link_options,
    listed_emit_option,
    reading_options,
)
from ikgen.cli.parameter_types import GivenPath, RobotFile
from ikgen.cli.request_options import make_request, parse_emit
from ikgen.model.counted import counted, listed

if TYPE_CHECKING:
    from ikgen.projects.new_config import ArmTable

__all__ = ["init"]


@click.command()
@click.argument("robot", type=RobotFile(), metavar="ROBOT|TABLE")
@link_options
@reading_options
@listed_emit_option
@click.option(
    "-o",
    "--output",
    "out",
    metavar="FILE",
    type=GivenPath(),
    default=Path("ikgen.toml"),
    help="The config to write (default: ikgen.toml here).",
)
@click.option("--add", is_flag=True, help="Add the arms to a config that is there.")
@click.option("--force", is_flag=True, help="Replace a config that is there.")
@console_options
def init(
    robot: Path,
    *,
    emit: tuple[str, ...],
    out: Path,
    add: bool,
    force: bool,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **chain: Any,
) -> None:
    """Write a config that lists every arm of ROBOT, for ikgen build.

    With --base alone those that begin there, with --tip the one chain to that link.
    """
    from ikgen.derivation.read import read_tree
    from ikgen.projects.new_config import (
        add_to_config,
        config_path,
        ends_left_out,
        robot_arms,
        write_config,
    )

    request = make_request(robot, **chain)
    path, outputs = config_path(out), parse_emit(emit)
    with Console(quiet=quiet, verbose=verbose) as console:
        console("read", robot.name)
        tree = None if request.table else read_tree(request)
        arms = robot_arms(request, tree)
        others = ends_left_out(request, tree) if tree is not None else ()
    if add and path.exists():
        arms = add_to_config(path, request, arms, outputs)
    else:
        write_config(path, request, arms, outputs, force=force)
    command = ["ikgen", "build", *([] if path == Path("ikgen.toml") else [str(path)])]
    command += ["--trust"] if request.trust else []
    if as_json:
        rows = [{"name": a.name, "base": a.base, "tip": a.tip, "dof": a.dof} for a in arms]
        result = {"files": [str(path)], "arms": rows, "next": shlex.join(command)}
        result["other_ends"] = list(others)
        click.echo(json.dumps(result, indent=2))
    elif not quiet:
        for arm in arms:
            click.echo(_line(arm))
        if others:
            taken = f"taken for fingers or side branches: {listed(others)}"
            console.note(f"{taken}; --tip LINK --add adds one")
        click.echo(f"wrote: {path}\nnext: {shlex.join(command)}")


def _line(arm: ArmTable) -> str:
    """What is told of an arm."""
    ends = "" if arm.base is None else f"{arm.base} -> {arm.tip}, "
    return f"{arm.name}: {ends}{counted(arm.dof, 'joint')}{_task(arm.dof)}"


def _task(dof: int) -> str:
    """Where the task is to be seen that an arm gets which cannot take every pose."""
    return "" if dof >= 6 else "; the task that fits them: ikgen inspect"
