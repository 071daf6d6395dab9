"""Arms whose files anybody has: of `urdf_fixtures/`, and of example-robot-data where it is installed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.command_line import FIXTURES
from ikgen.errors import IkgenError, MissingToolError
from ikgen.generation.request import Request
from ikgen.importers.named_robots import DATA, robot_names
from ikgen.projects.new_config import robot_arms

__all__ = ["public_arms"]


def public_arms() -> list[dict[str, Any]]:
    """Rows as those of a collection's `arms.json`; `file` is a path or a robot's name, the class is where
    it comes from."""
    rows = [row for path in sorted(FIXTURES.glob("*.urdf")) for row in _rows(str(path), path.name)]
    try:
        names = robot_names(DATA)
    except MissingToolError:
        return rows
    return rows + [row for name in names for row in _rows(f"{DATA}:{name}", DATA)]


def _rows(robot: str, family: str) -> Iterator[dict[str, Any]]:
    """The arms of a robot; none of one that cannot be read, or has none."""
    try:
        arms = robot_arms(Request(Path(robot)))
    except IkgenError:
        return
    kind = DATA if family == DATA else "urdf_fixtures"
    name = robot.partition(":")[2] if family == DATA else Path(robot).stem
    for arm in arms:
        own = f"{name} {arm.tip}" if len(arms) > 1 else name
        yield {
            "name": own,
            "family": f"{kind}, {arm.dof} joints",
            "base_link": arm.base,
            "tip_link": arm.tip,
            "file": robot,
        }
