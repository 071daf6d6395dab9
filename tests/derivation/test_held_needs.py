"""Joints that are held by request, and that the arm would need for the task it is left with."""

from __future__ import annotations

import json
import re
import time
from pathlib import Path

import numpy as np
import pytest
from benchmarks.command_line import load_module
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.small_robots import write_robot
from tests.support.solving import FIXTURES

from ikgen.cli.main import run
from ikgen.derivation.closed_forms import closed_form
from ikgen.derivation.derive import derive
from ikgen.derivation.held_needs import needs_held, rounding_decides
from ikgen.derivation.inspection import inspect_robot
from ikgen.derivation.progress import silent
from ikgen.derivation.read import read
from ikgen.derivation.remedies import remedies
from ikgen.derivation.task_forms import Demand
from ikgen.emit.derivation import Unsolved
from ikgen.errors import UnsolvedChainError, UsageError
from ikgen.kinematics.classify import classify
from ikgen.records.request import Request
from ikgen.tasks import find_task
from ikgen.tasks.fitting import freedoms_barely_moved, freedoms_fixed

pytestmark = pytest.mark.usefixtures("solved_once")

TABLES = Path(__file__).resolve().parents[1] / "robots/tables"


def test_pose_that_nobody_asked_for_is_refused_where_a_held_joint_is_needed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot, out = write_robot(tmp_path / "elbow.urdf"), tmp_path / "out"
    command = ["from-urdf", str(robot), "--free", "waist", "-o", str(out), "--no-verify"]
    assert run(command) == 3
    said = capsys.readouterr().err
    assert "a task that 2 joints can do, with 'waist' held" in said
    assert f"hold none of them: ikgen from-urdf {robot}\n" in said
    assert f"ikgen from-urdf {robot} --task position --free waist" in said
    assert not out.exists()
    attempts = inspect_robot(Request(robot, free={"waist": None})).closed
    assert not any(attempt.default for attempt in attempts)
    asked = ["--free waist --task pose", "--free waist --task position"]
    assert [attempt.options for attempt in attempts] == asked
    assert run([*command, "--task", "pose"]) == 0
    said = capsys.readouterr()
    assert "warning: OVER-CONSTRAINED" in said.err and "without --free waist" in said.err
    assert "OVER-CONSTRAINED" in said.out


def test_held_joint_that_leaves_a_task_to_do_is_no_matter(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = write_robot(tmp_path / "elbow.urdf")
    more = ["--free", "elbow", "-o", str(tmp_path), "--no-verify"]
    assert run(["from-urdf", str(robot), *more]) == 0
    assert "what fits 2 joints" in capsys.readouterr().out


def test_spare_joint_is_not_needed(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST))
    pose = find_task("pose")
    assert not needs_held(read(Request(path)).dh, pose)
    assert not needs_held(read(Request(path, free={"shoulder_roll": None})).dh, pose)
    two = {"shoulder_roll": None, "wrist_roll": None}
    assert needs_held(read(Request(path, free=two)).dh, pose)


def rounded_scara(path: Path, turn: str) -> Path:
    """A SCARA whose last two axes point down by half a turn that is written with few digits."""
    text = (FIXTURES.parent / "examples/hatch_robot/urdf/scara.urdf").read_text()
    for joint in ("lift", "spin"):
        start = text.index(f'<joint name="{joint}"')
        head, tail = text[:start], text[start:]
        tail = re.sub(
            r'<origin xyz="([^"]*)"[^>]*>', rf'<origin xyz="\1" rpy="{turn} 0 0"/>', tail, count=1
        )
        text = head + tail
    path.write_text(text)
    return path


@pytest.mark.parametrize("turn", ["3.14159", "3.1415926"])
def test_a_task_that_rounding_alone_moves_is_refused_at_once(
    turn: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = rounded_scara(tmp_path / "scara.urdf", turn)
    command = ["from-urdf", str(robot), "-o", str(tmp_path / "out"), "--task"]
    started = time.process_time()
    assert run([*command, "rotation"]) == 3
    assert time.process_time() - started < 2.0
    said = capsys.readouterr().err
    assert "the joints move 1 of the 3 freedoms that the task fixes, and the others by no" in said
    assert f"hint: ikgen from-urdf {robot} --task position-yaw\n" in said
    hindrance = inspect_robot(Request(robot, task="rotation")).hindrance
    assert hindrance is not None and "the joints move 1 of the 3" in hindrance.message
    for able in ("position-yaw", "position-direction", "pose"):
        assert run([*command, able, "--no-verify", "--force"]) == 0


def test_half_turns_of_two_digits_leave_the_tool_its_heading(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = rounded_scara(tmp_path / "scara.urdf", "3.14")
    assert freedoms_fixed(read(Request(robot)).dh, find_task("position-yaw")) == 4
    assert run(["from-urdf", str(robot), "-o", str(tmp_path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["task"] == "position-yaw"
    (path,) = tmp_path.glob("*_ik.py")
    module = load_module(path)
    q = np.array([0.4, -0.7, 0.1, 0.3])
    found = module.solve(module.forward(q), limits=False).q
    assert len(found) == 2 and np.abs(found - q).max(axis=1).min() < 1e-9


def test_exact_axes_leave_nothing_barely_moved(tmp_path: Path) -> None:
    robot = rounded_scara(tmp_path / "scara.urdf", "3.141592653589793")
    dh = read(Request(robot)).dh
    assert freedoms_barely_moved(dh, find_task("rotation")) == 0
    assert (
        run(["from-urdf", str(robot), "--task", "rotation", "-o", str(tmp_path), "--no-verify"])
        == 0
    )


def rounded_planar_arm(path: Path) -> Path:
    """Four parallel axes in a plane, two of them tilted by what few digits leave."""
    joints = [(f"j{i}", "revolute", "0 1 0", "0.4 0 0", (-2.8, 2.8)) for i in range(4)]
    text = serial_urdf(path.stem, joints)
    for joint, turn in (("j1", "2e-6 0 -2e-6"), ("j3", "0 0 1e-6")):
        head, tail = text.split(f'<joint name="{joint}"')
        tail = re.sub(
            r'<origin xyz="([^"]*)"[^>]*>', rf'<origin xyz="\1" rpy="{turn}"/>', tail, count=1
        )
        text = f'{head}<joint name="{joint}"{tail}'
    path.write_text(text)
    return path


def test_a_whole_pose_that_nobody_asked_for_is_refused_at_once_where_rounding_decides_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = rounded_planar_arm(tmp_path / "arm.urdf")
    command = ["from-urdf", str(robot), "-o", str(tmp_path / "out")]
    assert run(command) == 3
    said = capsys.readouterr().err
    assert "the joints move 3 of the 6 freedoms that the task fixes, and the others by no" in said
    assert "verifying" not in said and "trying" not in said
    advice = re.search(r"hint: ikgen from-urdf \S+ --lock (\S+)=(\S+)\n", said)
    assert advice is not None
    found = inspect_robot(Request(robot))
    assert not found.attempts
    assert found.hindrance is not None and f"--lock {advice[1]}" in found.hindrance.hint
    assert run([*command, "--lock", f"{advice[1]}={advice[2]}"]) == 0


def test_a_joint_to_hold_becomes_one_to_lock_where_rounding_decides(tmp_path: Path) -> None:
    robot = rounded_planar_arm(tmp_path / "arm.urdf")
    for task in (None, "pose"):
        with pytest.raises(UnsolvedChainError) as caught:
            derive(Request(robot, task=task, free={"j1": 0.5}))
        assert caught.value.hint.endswith("--lock j1=0.5") and "--free" not in caught.value.hint


def test_no_task_is_proposed_that_is_refused_when_asked_for(tmp_path: Path) -> None:
    robot = rounded_planar_arm(tmp_path / "arm.urdf")
    reading, task = read(Request(robot)), find_task("pose")
    form = closed_form(reading, Demand("pose", (), silent))
    geometry = classify(reading.dh)
    left = Unsolved(reading, geometry, task, form.graph, "arm", robot.name, ())
    proposed = {attempt.task for attempt in remedies(left, silent)}
    assert not any(rounding_decides(reading.dh, find_task(name)) for name in proposed)
    assert rounding_decides(reading.dh, find_task("position-direction"))


def test_a_tool_axis_is_refused_at_once_where_the_whole_pose_is_left(tmp_path: Path) -> None:
    redundant = tmp_path / "arm.urdf"
    redundant.write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST))
    told: list[str] = []
    for robot in (FIXTURES / "doosan_m1013.urdf", redundant):
        with pytest.raises(UsageError, match="no single axis of the tool") as caught:
            derive(Request(robot, tool_axis="x"), lambda stage, _: told.append(stage))
        assert "--task" in caught.value.hint
    assert told == 2 * ["read", "derive"]


def test_a_tool_axis_is_taken_where_a_joint_is_spare_and_five_are_left() -> None:
    table = TABLES / "Chair6DOF.toml"
    assert derive(Request(table, tool_axis="y")).task.name == "position-direction:y"
