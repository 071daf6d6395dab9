"""Arms whose files anybody has: of `urdf_fixtures/`, and of example-robot-data where it is installed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.command_line import FIXTURES
from ikgen.derivation.read import read
from ikgen.errors import IkgenError, MissingToolError
from ikgen.importers.named_robots import DATA, robot_names
from ikgen.kinematics.classify import classify
from ikgen.projects.new_config import ArmTable, robot_arms
from ikgen.records.request import Request

__all__ = ["public_arms"]


def public_arms() -> list[dict[str, Any]]:
    """Rows as those of a collection's `arms.json`; `file` is a path or a robot's name, the class is that
    of the geometry. Arms that mirror or repeat an earlier one of their robot, as legs do, are left out."""
    robots = {str(path): path.stem for path in sorted(FIXTURES.glob("*.urdf"))}
    with suppress(MissingToolError):
        robots |= {f"{DATA}:{name}": name for name in robot_names(DATA)}
    return [row for robot, name in robots.items() for row in _rows(robot, name)]


def _rows(robot: str, name: str) -> Iterator[dict[str, Any]]:
    """The arms of a robot; none of one that cannot be read, or has none."""
    try:
        arms = robot_arms(Request(Path(robot)))
    except IkgenError:
        return
    seen = set()
    for arm in arms:
        family, shape = _geometry(robot, arm)
        if shape in seen:
            continue
        seen.add(shape)
        yield {
            "name": f"{name} {arm.tip}" if len(arms) > 1 else name,
            "family": family,
            "base_link": arm.base,
            "tip_link": arm.tip,
            "file": robot,
        }


def _geometry(robot: str, arm: ArmTable) -> tuple[str, object]:
    """The class of an arm's geometry, by the number of joints alone where that is not six or seven; and
    what its mirror image has in common with it."""
    try:
        dh = read(Request(Path(robot), base=arm.base, tip=arm.tip)).dh
    except IkgenError:
        return "cannot be read", arm.tip
    geometry = classify(dh)
    turning = set(geometry.kinds) == {"R"} and not 6 <= arm.dof <= 7
    numbers = [x for row in dh.rows for x in (row.alpha.value, row.a.value, row.d.value)]
    shape = geometry.kinds, *np.abs(np.round(numbers, 6)).tolist()
    return (f"{arm.dof}R" if turning else geometry.name), shape
