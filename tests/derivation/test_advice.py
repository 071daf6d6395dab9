"""What `ikgen inspect` says of a closed form is what is generated."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.support.redundant_arms import (
    LIFT_SCARA,
    OFFSET_ELBOW,
    serial_urdf,
)
from tests.support.sampled import sampled
from tests.support.solving import FIXTURES

from ikgen.derivation.advice import Attempt
from ikgen.derivation.derive import derive
from ikgen.derivation.inspection import inspect_robot
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

OFTEN = ("doosan_m1013", "franka_fr3")


@pytest.mark.parametrize("robot", sampled([*OFTEN, "ur5e", "igus_robolink_rl_dp_5"], OFTEN))
def test_rows_steps_and_solutions_are_those_of_the_derivation(robot: str) -> None:
    request = Request(FIXTURES / f"{robot}.urdf")
    found, made = inspect_robot(request), derive(request)
    taken = found.taken
    assert taken is not None and found.dh is not None
    assert found.dh.rows == made.reading.dh.rows
    assert found.dh.deviation == made.reading.dh.deviation
    assert found.geometry == made.geometry
    assert taken.task == made.task.name
    assert taken.order == made.module.order
    assert taken.max_solutions == made.module.max_solutions


def test_before_any_derivation_the_rows_are_exact() -> None:
    request = Request(FIXTURES / "doosan_m1013.urdf")
    found = inspect_robot(request, advice=False)
    assert found.taken is None and found.reading is not None
    assert found.dh is found.reading.dh
    assert max(found.dh.deviation) > 1e-5


@pytest.mark.parametrize(
    ("task", "axis", "asked"),
    [
        ("position", "x", ()),
        ("position-pitch", "x", ("--tool-axis", "x")),
        ("direction:y", "x", ()),
    ],
)
def test_an_attempt_asks_for_an_axis_where_its_task_reads_one(
    task: str, axis: str, asked: tuple[str, ...]
) -> None:
    request = Request(FIXTURES / "ur5e.urdf", task="position-yaw", tool_axis=axis)
    options = Attempt(task, (), True, 4, (), ()).asked(request).options
    assert options == ["--task", task, *asked]


def test_steps_of_more_than_two_branches_come_later_whatever_their_leaf_is_called() -> None:
    step = ("theta_1 (four points)",)
    several = Attempt("pose", (), True, 4, step, (), two_branch=False)
    few = Attempt("pose", (), True, 8, ("theta_1 (no quartic)",), ())
    assert few.rank < several.rank


@pytest.fixture(params=["fr3", "elbow", "lift"])
def redundant(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """The file of an arm with a joint to hold; the second choice of one has a quartic, its third none."""
    if request.param == "fr3":
        return FIXTURES / "franka_fr3.urdf"
    path = tmp_path / "arm.urdf"
    path.write_text(serial_urdf("arm", OFFSET_ELBOW if request.param == "elbow" else LIFT_SCARA))
    return path


def test_joints_to_hold_come_in_the_order_of_the_derivation(redundant: Path) -> None:
    held = derive(Request(redundant)).held
    assert held is not None
    shown = [one.held for one in inspect_robot(Request(redundant)).attempts]
    assert shown == [held.joints, *held.others][: len(shown)]
