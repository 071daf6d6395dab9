"""`--couple`, its entry in a config and its argument: one relation, and what was made is checked by it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.telescopes import RELATIONS, telescope_robot

import ikgen
from ikgen.cli.main import run
from ikgen.errors import ArgumentError
from ikgen.verify.runners.python_module import PythonModule

pytestmark = pytest.mark.usefixtures("solved_once")

QUICK = ["--samples", "40", "-q"]


def couple(relations: dict[str, str]) -> list[str]:
    return [x for joint, text in relations.items() for x in ("--couple", f"{joint}={text}")]


def test_a_coupled_arm_is_generated_and_checked_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    robot = telescope_robot(tmp_path)
    made = run(["from-urdf", str(robot), "--task", "position", *couple(RELATIONS), *QUICK])
    assert made == 0
    module = PythonModule(tmp_path / "telescope_ik.py").module
    assert module.JOINT_NAMES == ("lift", "stage_1", "yaw", "pitch")
    record = json.loads((tmp_path / "telescope_ik.json").read_text())
    assert RELATIONS.items() <= json.loads(json.dumps(record))["couple"].items()
    assert run(["verify", ".", "--samples", "20"]) == 0


def test_a_telescope_takes_equal_shares_unasked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = telescope_robot(tmp_path)
    out = ["-o", str(tmp_path), "--task", "position"]
    assert run(["from-urdf", str(robot), *out, "--samples", "40"]) == 0
    assert "take equal shares: --couple stage_2=stage_1*1+0.01" in capsys.readouterr().err
    module = PythonModule(tmp_path / "telescope_ik.py").module
    assert module.JOINT_NAMES == ("lift", "stage_1", "yaw", "pitch")
    np.testing.assert_allclose(module.UPPER[:2], [1.1, 0.13])


def test_a_parallelogram_keeps_the_forearm_s_direction(tmp_path: Path) -> None:
    side = ("back", "revolute", "0 1 0", "0 0 0.5", (-2.5, 2.5))
    yaw, pitch, *_, roll, bend, turn = SHOULDER_ELBOW_WRIST
    elbow = ("elbow", "revolute", "0 1 0", "0 0 0", (-2.1, 2.1))
    robot = tmp_path / "parallelogram.urdf"
    robot.write_text(serial_urdf("parallelogram", (yaw, pitch, side, elbow, roll, bend, turn)))
    out = ["-o", str(tmp_path), *QUICK]
    assert run(["from-urdf", str(robot), "--couple", "back=shoulder_pitch*-1", *out]) == 0
    arm = PythonModule(tmp_path / "parallelogram_ik.py").module
    assert tuple(j[0] for j in (yaw, pitch, elbow, roll, bend, turn)) == arm.JOINT_NAMES
    q = np.array([0.3, 0.7, -0.8, 0.4, 0.9, -0.2])
    turned = arm.forward(q)[:3, :3]
    np.testing.assert_allclose(arm.forward(q + np.eye(6)[1] * 0.4)[:3, :3], turned, atol=1e-12)
    rows = arm.solve(arm.forward(q)).q
    assert len(rows) > 1 and np.abs(rows - q).max(axis=1).min() < 1e-9


@pytest.mark.parametrize("command", ["from-urdf", "report"])
def test_a_ratio_that_leaves_no_closed_form_is_told_by_every_command(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot, out = tmp_path / "arm.urdf", tmp_path / "out"
    robot.write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST))
    name = SHOULDER_ELBOW_WRIST[1][0]
    asked = [command, str(robot), "--couple", f"{SHOULDER_ELBOW_WRIST[2][0]}={name}*0.500000001"]
    assert run([*asked, "-o", str(out), "-q"]) == 3
    said = capsys.readouterr().err
    assert f"no closed form for the mimic joints of '{name}'" in said and f"--lock {name}" in said
    assert not list(out.glob("*"))


@pytest.mark.parametrize(
    "text", ["stage_2", "=stage_1", "stage_2=", "stage_2=stage_1*", "stage_2=stage_1*0"]
)
def test_what_is_no_relation_is_refused(
    text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = telescope_robot(tmp_path)
    assert run(["from-urdf", str(robot), "--couple", text, "-o", str(tmp_path)]) == 2
    assert f"--couple {text}" in capsys.readouterr().err


def test_a_config_and_the_library_take_the_same_relations(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    telescope_robot(tmp_path)
    table = ", ".join(f'{joint} = "{text}"' for joint, text in RELATIONS.items())
    head = '[[arm]]\nname = "tele"\nrobot = "telescope.urdf"\ntask = "position"\nsamples = 40\n'
    config = f"{head}couple = {{ {table} }}\n"
    (tmp_path / "ikgen.toml").write_text(config)
    assert run(["build", "-q"]) == 0
    assert run(["build", "--check"]) == 0
    module = PythonModule(tmp_path / "tele_ik.py").module
    arm = ikgen.load("telescope.urdf", task="position", couple=RELATIONS, samples=40, cache=False)
    assert tuple(arm.joint_names) == module.JOINT_NAMES
    q = np.array([0.4, 0.05, 0.3, -0.4])
    np.testing.assert_allclose(arm.forward(q), module.forward(q), atol=1e-15)
    with pytest.raises(ArgumentError, match="stage_2"):
        ikgen.load("telescope.urdf", couple={"stage_2": "stage_1*"})
    (tmp_path / "ikgen.toml").write_text(config.replace("*0.5+0.03", "*"))
    assert run(["build", "--check"]) == 2
