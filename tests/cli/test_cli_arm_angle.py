"""`--free arm-angle` from the command line, the library and CMake: its default, and what is no angle."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.tools import environment, needs_cmake

from ikgen.cli.main import run
from ikgen.projects.cmake import cmake_directory
from ikgen.verify.runners.python_module import PythonModule

pytestmark = pytest.mark.usefixtures("solved_once")

_PROJECT = """
cmake_minimum_required(VERSION 3.16)
project(redundant NONE)
find_package(ikgen REQUIRED)
ikgen_generate(arm ROBOT arm.urdf FREE arm-angle=-0.5 EMIT python SAMPLES 20)
add_custom_target(all_arms ALL)
add_dependencies(all_arms arm_generate)
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """An arm with a spherical shoulder and a spherical wrist."""
    path = tmp_path / "arm.urdf"
    path.write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST))
    return path


def holds_the_angle(path: Path, default: float) -> None:
    """A module whose rows have the default angle where none is given."""
    arm = PythonModule(path).module
    assert arm.FREE_JOINTS == ("arm_angle",)
    q = np.array([0.3, 0.8, -0.4, 1.1, 0.5, -0.9, 0.2])
    rows = arm.solve(arm.forward(q), limits=False).q
    assert len(rows) == 8
    np.testing.assert_allclose(arm.arm_angle(rows), default, atol=1e-9)
    np.testing.assert_allclose(arm.forward(rows), np.tile(arm.forward(q), (8, 1, 1)), atol=1e-9)


def test_a_default_is_an_angle(
    robot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = ["from-urdf", str(robot), "-o", str(tmp_path), "--no-verify", "-q"]
    assert run([*made, "--free", "arm-angle=20deg", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["free"] == ["arm_angle"]
    holds_the_angle(tmp_path / "arm_ik.py", np.deg2rad(20.0))
    assert run(["verify", str(tmp_path), "--samples", "20"]) == 0


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("20mm", "--free arm-angle=20mm: 'mm' is no unit of a joint that turns"),
        ("200deg", "--free arm-angle=200deg: outside its limits, -3.14159265 to 3.14159265 rad"),
    ],
)
@pytest.mark.parametrize("command", ["from-urdf", "view", "reach", "report"])
def test_what_is_no_arm_angle_is_refused(
    command: str, value: str, said: str, robot: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if command == "view":
        pytest.importorskip("viser")
    assert run([command, str(robot), "--free", f"arm-angle={value}"]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.long
@needs_cmake
def test_cmake_holds_it(robot: Path) -> None:
    (robot.parent / "CMakeLists.txt").write_text(_PROJECT)
    for command in (
        ["cmake", "-S", ".", "-B", "b", f"-Dikgen_DIR={cmake_directory()}"],
        ["cmake", "--build", "b"],
    ):
        done = subprocess.run(
            command,
            cwd=robot.parent,
            env=environment(),
            text=True,
            capture_output=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
    (made,) = robot.parent.glob("b/**/arm_ik.py")
    holds_the_angle(made, -0.5)


def test_the_arm_angle_in_another_spelling_is_told(
    robot: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for written in ("arm_angle", "armangle"):
        assert run(["from-urdf", str(robot), "--free", written]) == 2
        assert "the arm angle is --free arm-angle" in capsys.readouterr().err
