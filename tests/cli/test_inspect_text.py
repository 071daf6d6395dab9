"""What `ikgen inspect` shows of a chain."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.small_robots import write_robot
from tests.support.solving import FIXTURES

from ikgen.cli.inspect_text import as_text
from ikgen.cli.main import run
from ikgen.cli.tree_text import transform_text
from ikgen.derivation.inspection import inspect_robot
from ikgen.kinematics.forward import file_forward
from ikgen.records.request import Request
from ikgen.solver.solution_graph import SolutionGraph

pytestmark = pytest.mark.usefixtures("solved_once")

ELBOW = FIXTURES.parent / "examples/setuptools_robot/urdf/elbow.urdf"


def rotation(roll: float, pitch: float, yaw: float) -> np.ndarray:
    """URDF's rotation (3, 3): fixed axes x, y, z."""
    (cr, sr), (cp, sp), (cy, sy) = ((np.cos(x), np.sin(x)) for x in (roll, pitch, yaw))
    Rx = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    Ry = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    return np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]]) @ Ry @ Rx


def test_a_chain_without_a_closed_form_is_shown_with_the_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # two links of a finger, the outer one geared to the inner one
    joints = "".join(
        f'<link name="link{i}"/><joint name="j{i}" type="revolute"><parent link="link{i - 1}"/>'
        f'<child link="link{i}"/><origin xyz="0.04 0 0"/><axis xyz="0 0 1"/><limit lower="-1" upper="1"/>'
        f"{mimic}</joint>"
        for i, mimic in ((1, ""), (2, '<mimic joint="j1" multiplier="1.350000001"/>'))
    )
    robot = tmp_path / "finger.urdf"
    robot.write_text(f'<robot name="finger"><link name="link0"/>{joints}</robot>')
    assert run(["inspect", str(robot), "--tip", "link2"]) == 0
    shown = capsys.readouterr().out
    assert "j2: revolute" in shown
    assert "modified DH rows" in shown
    assert "'j1' and 'j2' turn in the ratio 1 : 1.35, and closed forms need a ratio of" in shown
    assert "give --couple j2=j1*k with fewer digits" in shown
    assert "--lock" not in shown  # nothing else moves
    assert run(["inspect", str(robot), "--tip", "link2", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["attempts"] == []
    assert "1 : 1.35" in found["hindrance"]["message"]


@pytest.mark.parametrize(
    "rpy",
    [
        (0.3, -0.4, 2.0),
        (0.0, 0.0, 0.0),
        (1.0, np.pi / 2, 0.4),
        (-2.0, -np.pi / 2, 0.7),
        (3.1, 2.0, 1),
    ],
)
def test_transforms_as_urdf_writes_them(rpy: tuple[float, float, float]) -> None:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation(*rpy), (0.1, -0.2, 0.0)
    xyz, text = transform_text(T)
    assert xyz == "xyz 0.1 -0.2 0"
    again = rotation(*(float(x) for x in text.removeprefix("rpy ").split()))
    assert np.abs(again - T[:3, :3]).max() < 1e-8


def test_base_and_tool_are_shown(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot = write_robot(tmp_path / "elbow.urdf")
    assert run(["inspect", str(robot), "--no-advice"]) == 0
    said = capsys.readouterr().out
    assert "  base:  xyz " in said and "  tool:  xyz " in said
    assert run(["inspect", str(robot), "--no-advice", "--json"]) == 0
    chain = json.loads(capsys.readouterr().out)["chain"]
    dh = inspect_robot(Request(robot), advice=False).reading
    assert dh is not None
    assert np.allclose(chain["base_transform"], dh.dh.X_base)
    T = np.array(chain["base_transform"])
    for row in chain["dh"]:
        a, alpha = row["a"]["value"], row["alpha"]["value"]
        theta, d = row["offset"], row["d"]["value"]
        step = np.eye(4)
        step[:3, :3], step[0, 3] = rotation(alpha, 0, 0), a
        turn = np.eye(4)
        turn[:3, :3], turn[2, 3] = rotation(0, 0, theta), d
        T = T @ step @ turn
    T = T @ np.array(chain["tool_transform"])
    assert np.allclose(T, file_forward(dh.dh, np.zeros((1, 3)))[0])


def test_what_is_weak_is_not_called_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    request = Request(ELBOW, task="position")
    assert "as it is" not in as_text(inspect_robot(request))  # --task position
    assert "closed form, at most 4" in as_text(inspect_robot(request))
    monkeypatch.setattr(SolutionGraph, "sound", property(lambda graph: False))
    said = as_text(inspect_robot(request))
    assert "closed form with a weak step, at most 4" in said and "weak: a step fails" in said


def test_arm_angle_is_offered_to_arms_that_have_one(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST))
    with_one = inspect_robot(Request(path))
    assert with_one.arm_angle and "--free arm-angle: closed form" in as_text(with_one)
    without = inspect_robot(Request(FIXTURES / "franka_fr3.urdf"))
    assert not without.arm_angle and "arm-angle" not in as_text(without)


def test_links_that_are_fixed_to_the_tip_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tips = [f"frame{i}" for i in range(15)]
    fixed = "".join(
        f'<link name="{tip}"/><joint name="{tip}" type="fixed"><parent link="tool0"/>'
        f'<child link="{tip}"/></joint>'
        for tip in tips
    )
    robot = tmp_path / "arm.urdf"
    robot.write_text(
        serial_urdf("arm", SHOULDER_ELBOW_WRIST).replace("</robot>", f"{fixed}</robot>")
    )
    assert run(["inspect", str(robot), "--no-advice"]) == 0
    shown = capsys.readouterr().out
    (line,) = (line.strip() for line in shown.splitlines() if "other tips" in line)
    assert line.startswith("other tips, fixed to it: wrist_roll_link, frame0, ")
    assert line.endswith("frame8 and 6 more")
    assert run(["inspect", str(robot), "--no-advice", "--json"]) == 0
    (chain,) = json.loads(capsys.readouterr().out)["candidates"]
    assert chain["tip"] == "tool0" and chain["other_tips"] == ["wrist_roll_link", *tips]
    assert run(["inspect", str(FIXTURES / "doosan_m1013.urdf"), "--no-advice"]) == 0
    assert "other tips" not in capsys.readouterr().out
