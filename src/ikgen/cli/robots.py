"""`ikgen robots`: robots that are known by name, with their arms."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import click

from ikgen.cli.tables import table
from ikgen.errors import MissingToolError, UnknownNameError
from ikgen.importers.named_robots import SOURCES
from ikgen.model.counted import counted

if TYPE_CHECKING:
    from ikgen.projects.robot_list import ListedRobot

__all__ = ["robots"]


@click.command()
@click.argument("source", required=False)
@click.option("--names", is_flag=True, help="Names alone: read no file.")
@click.option("--json", "as_json", is_flag=True, help="Machine-readable result on stdout.")
def robots(source: str | None, *, names: bool, as_json: bool) -> None:
    """List the robots of SOURCE (example-robot-data or robot_descriptions; default: those that are
    installed) with their arms, each as what to type for ROBOT."""
    from ikgen.projects.robot_list import listed_robots

    if source is not None and source not in SOURCES:
        raise UnknownNameError("source of robots", source, SOURCES)
    found: list[ListedRobot] = []
    missing: list[MissingToolError] = []
    for one in SOURCES if source is None else (source,):
        try:
            found += listed_robots(one, read=False if names else None)
        except MissingToolError as error:
            missing.append(error)
    if not found:
        raise MissingToolError(
            "; ".join(error.message for error in missing), hint=" or ".join(e.hint for e in missing)
        )
    if as_json:
        click.echo(json.dumps({"robots": [_record(robot) for robot in found]}, indent=2))
    else:
        click.echo(table([row for robot in found for row in _rows(robot)], indent=""))


def _record(robot: ListedRobot) -> dict[str, Any]:
    arms = [{"name": a.name, "base": a.base, "tip": a.tip, "dof": a.dof} for a in robot.arms]
    return {"robot": robot.robot, "arms": arms, "problem": robot.problem or None}


def _rows(robot: ListedRobot) -> list[tuple[str, str]]:
    """A line for each arm; the robot's name stands in the first."""
    words = [f"{arm.base} -> {arm.tip}, {counted(arm.dof, 'joint')}" for arm in robot.arms]
    heads = [robot.robot, *[""] * (len(words) - 1)]
    return list(zip(heads, words or [robot.problem], strict=True))
