"""Robots that packages hold, by name, with the arms that they have."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.errors import IkgenError
from ikgen.importers.named_robots import DATA, robot_names
from ikgen.records.request import Request

if TYPE_CHECKING:
    from ikgen.projects.new_config import ArmTable

__all__ = ["ListedRobot", "listed_robots"]


@dataclass(frozen=True, slots=True)
class ListedRobot:
    """One robot: what to type for it, its arms, and where it has none why ("": it was not read)."""

    robot: str
    arms: tuple[ArmTable, ...] = ()
    problem: str = ""


def listed_robots(source: str, *, read: bool | None = None) -> Iterator[ListedRobot]:
    """The robots of a package, read one after the other unless `read` is false. Those of
    robot_descriptions are not read by default: that fetches them. Raises `MissingToolError` without the
    package."""
    for name in robot_names(source):
        robot = f"{source}:{name}"
        yield _read(robot) if read or (read is None and source == DATA) else ListedRobot(robot)


def _read(robot: str) -> ListedRobot:
    from ikgen.projects.new_config import robot_arms

    try:
        return ListedRobot(robot, robot_arms(Request(Path(robot))))
    except IkgenError as error:
        return ListedRobot(robot, (), error.message)
