"""Every arm of example-robot-data: files that this project did not write, generated and verified."""

from __future__ import annotations

from pathlib import Path

import pytest

import ikgen
from ikgen.errors import MissingToolError, UsageError
from ikgen.importers.named_robots import DATA, robot_names
from ikgen.projects.new_config import robot_arms
from ikgen.records.request import Request

try:
    NAMES = robot_names(DATA)
except MissingToolError:
    NAMES = ()

ARMLESS = {"hector", "iris"}  # flying bodies


@pytest.mark.long
@pytest.mark.skipif(not NAMES, reason="needs example-robot-data")
@pytest.mark.parametrize("name", NAMES)
def test_all_arms_are_generated_and_verified(name: str) -> None:
    robot = f"{DATA}:{name}"
    if name in ARMLESS:
        with pytest.raises(UsageError, match="no arm found"):
            robot_arms(Request(Path(robot)))
        return
    for table in robot_arms(Request(Path(robot))):
        arm = ikgen.load(robot, base=table.base, tip=table.tip, samples=100, cache=False)
        assert arm.verification is not None and arm.verification.passed
        assert arm.dof == table.dof
