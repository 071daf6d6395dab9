"""Joints that hardly move: held first of all where a joint is spare, else named with what is left."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import pytest
from tests.support.redundant_arms import (
    LIFT_SCARA,
    NON_SPHERICAL_WRIST,
    SHOULDER_ELBOW_WRIST,
    TORSO,
    Joint,
    serial_urdf,
)

import ikgen
from ikgen.cli.main import run
from ikgen.derivation.announcements import announcements
from ikgen.derivation.derive import derive
from ikgen.derivation.held_joints import held_choices
from ikgen.derivation.inspection import inspect_robot
from ikgen.derivation.read import read
from ikgen.kinematics.idle_joints import idle_joints
from ikgen.library.argument_words import argument_words
from ikgen.model.joint_tree import Limits
from ikgen.records.request import Request
from ikgen.tasks import find_task

pytestmark = pytest.mark.usefixtures("solved_once")

POSE = find_task("pose")


def arm(folder: Path, joints: tuple[Joint, ...], **limits: tuple[float, float]) -> Request:
    path = folder / "arm.urdf"
    pinned = [(*joint[:4], limits.get(joint[0], joint[4])) for joint in joints]
    path.write_text(serial_urdf("arm", pinned))
    return Request(path)


@pytest.mark.parametrize("name", ["shoulder_pitch", "shoulder_roll", "wrist_pitch"])
@pytest.mark.parametrize("limits", [(0.5, 0.5001), (0.2, 0.209)])
def test_a_joint_that_hardly_moves_is_held_first(
    name: str, limits: tuple[float, float], tmp_path: Path
) -> None:
    first, second, *_ = held_choices(
        read(arm(tmp_path, SHOULDER_ELBOW_WRIST, **{name: limits})), POSE
    )
    assert first.held == first.idle == (name,) and not second.idle
    assert second.behind(first) == f"solves for {name}" and first.behind(second) == ""
    assert first.ranking.startswith(f"hardly moves: {name}; class: ")


def test_it_is_held_at_its_middle_and_the_line_says_why(tmp_path: Path) -> None:
    found = derive(arm(tmp_path, SHOULDER_ELBOW_WRIST, shoulder_roll=(-0.001, 0.003)))
    assert found.module.free_defaults == pytest.approx((0.001,), abs=1e-15)
    assert found.held is not None
    assert found.held.words.startswith("holding shoulder_roll (hardly moves): closed form by rules")
    assert "(solves for shoulder_roll)" in found.held.words
    assert not any("hardly" in one for one in announcements(found))


@pytest.mark.parametrize("limits", [(0.2, 0.211), (-1.0, 1.0)])
def test_what_moves_a_little_more_is_ranked_as_others_are(
    limits: tuple[float, float], tmp_path: Path
) -> None:
    request = arm(tmp_path, SHOULDER_ELBOW_WRIST, shoulder_roll=limits)
    first, *_ = held_choices(read(request), POSE)
    assert first.held != ("shoulder_roll",) and not first.idle


def test_slides_count_by_the_arm_s_length(tmp_path: Path) -> None:
    joints = (TORSO, *SHOULDER_ELBOW_WRIST)
    pinned = read(arm(tmp_path, joints, torso=(0.1, 0.1001)))
    assert idle_joints(pinned.dh) == ("torso",)
    assert all("torso" in one.held for one in held_choices(pinned, POSE)[:3])
    assert idle_joints(read(arm(tmp_path, joints, torso=(0.1, 0.11))).dh) == ()


def test_it_is_held_where_rules_would_solve_another_choice(tmp_path: Path) -> None:
    """With the quill held three parallel axes are left; with the lift a slide beside them."""
    found = derive(arm(tmp_path, LIFT_SCARA, lift=(0.3, 0.3001)))
    assert found.held is not None and found.held.joints == ("lift",)


def test_an_elimination_that_holds_it_comes_before_others(tmp_path: Path) -> None:
    found = derive(arm(tmp_path, NON_SPHERICAL_WRIST, base_yaw=(0.5, 0.5001)))
    assert found.held is not None and found.held.joints == ("base_yaw",)
    assert found.held.why == "the general 6R elimination"


def test_an_elbow_that_hardly_moves_is_named(tmp_path: Path) -> None:
    """It is never held, as the wrist's distance from the shoulder is its alone."""
    found = derive(arm(tmp_path, SHOULDER_ELBOW_WRIST, elbow=(1.0, 1.001)))
    assert found.held is not None and found.held.joints == ("shoulder_roll",)
    (said,) = (one for one in announcements(found) if "hardly" in one)
    assert said == (
        "'elbow' hardly moves, so only 5 joints move: hardly any pose of the task 'pose' has a solution "
        "inside the limits; --lock elbow=1 gives the task that 5 joints can do"
    )


SIX = tuple(one for one in SHOULDER_ELBOW_WRIST if one[0] != "shoulder_roll")


def test_six_joints_of_which_one_hardly_moves_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    request = arm(tmp_path, SIX, shoulder_pitch=(0.4, 0.4002))
    command = ["from-urdf", str(request.robot), "-o", str(tmp_path), "--samples", "20"]
    assert run([*command, "--json"]) == 0
    (said,) = json.loads(capsys.readouterr().out)["warnings"]
    assert said.startswith("'shoulder_pitch' hardly moves, so only 5 joints move: ")
    assert run(command) == 0
    (line,) = (x for x in capsys.readouterr().out.splitlines() if x.startswith("task:"))
    assert line.endswith(
        "; shoulder_pitch hardly moves: answers only poses with its value (--lock shoulder_pitch=0.4)"
    )
    assert said in inspect_robot(request).warnings
    (told,) = ikgen.load(request.robot, verify=False, cache=False).warnings
    assert told == argument_words(said) and 'lock={"shoulder_pitch": 0.4}' in told


@pytest.mark.parametrize("joints", [SIX, SHOULDER_ELBOW_WRIST])
def test_a_joint_that_cannot_move_is_a_constant(
    joints: tuple[Joint, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    request = arm(tmp_path, joints, shoulder_pitch=(0.5, 0.5))
    command = ["from-urdf", str(request.robot), "-o", str(tmp_path), "--samples", "20", "--json"]
    assert run(command) == 0
    made = json.loads(capsys.readouterr().out)
    assert made["locked"] == {"shoulder_pitch": 0.5} and "shoulder_pitch" not in made["joints"]
    assert len(made["joints"]) == len(joints) - 1 and not made["free"]
    said = "'shoulder_pitch': lower = upper = 0.5: it cannot move, so it is locked there"
    assert sum(said in one for one in made["warnings"]) == 1
    assert run(["verify", str(tmp_path), "--samples", "20", "-q"]) == 0
    same = dataclasses.replace(request, lock={"shoulder_pitch": 0.5})
    assert read(same).dh.rows == read(request).dh.rows and not read(same).source.warnings


def test_it_is_a_joint_where_it_is_held_or_coupled(tmp_path: Path) -> None:
    request = arm(tmp_path, SHOULDER_ELBOW_WRIST, shoulder_roll=(0.5, 0.5))
    held = read(dataclasses.replace(request, free={"shoulder_roll": None}))
    assert held.dh.free == ("shoulder_roll",) and not held.dh.locked
    own = read(dataclasses.replace(request, couple={"elbow": "elbow*1+shoulder_roll*0.5"}))
    assert not own.dh.locked


def test_one_of_a_table_is_a_constant_too(tmp_path: Path) -> None:
    path = tmp_path / "arm.toml"
    row = '[[joints]]\nname = "q{}"\ntype = "revolute"\nalpha = {}\na = {}\nd = 0\ntheta = 0\n'
    rows = [row.format(1, 0, 0), row.format(2, '"pi/2"', 0.3), row.format(3, 0, 0.4)]
    rows[1] += "limits = [0.2, 0.2]\n"
    path.write_text(f'name = "arm"\nconvention = "modified"\n{"".join(rows)}')
    found = read(Request(path))
    assert found.dh.locked == (("q2", 0.2),) and found.dh.dof == 2
    assert any("limits 0.2 to 0.2: it cannot move" in one for one in found.source.warnings)
    assert read(Request(path, free={"q2": None})).dh.dof == 3


@pytest.mark.parametrize(
    ("lower", "upper", "text"),
    [(0.5, 0.5, "0.5"), (0.0, 1e-3, "0.0005"), (1 / 3, 1 / 3, repr(1 / 3)), (1.2, 1.3, "1.25")],
)
def test_the_middle_is_named_in_digits_that_lie_inside(
    lower: float, upper: float, text: str
) -> None:
    assert Limits(lower, upper).middle_text == text
