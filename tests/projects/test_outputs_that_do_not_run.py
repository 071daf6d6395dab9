"""Reports and formulas, which do not run, are verified by the code of the same solver, and grow old."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.support.small_robots import write_robot

from ikgen.cli.main import run

pytestmark = pytest.mark.usefixtures("solved_once")


@pytest.mark.parametrize("output", ["report", "sympy"])
def test_verified_all_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], output: str
) -> None:
    robot, out = write_robot(tmp_path / "arm.urdf"), tmp_path / "out"
    made = ["from-urdf", str(robot), "-o", str(out), "--emit", output, "--samples", "20"]
    assert run([*made, "--json", "-q"]) == 0
    assert json.loads(capsys.readouterr().out)["verification"].keys() == {"python"}
    assert not list(out.glob("*_ik.py"))
    (record,) = out.glob("*_ik.json")
    assert json.loads(record.read_text())["verified"]
    assert run(["verify", str(out)]) == 0


def test_without_verification_the_record_says_so(tmp_path: Path) -> None:
    robot, out = write_robot(tmp_path / "arm.urdf"), tmp_path / "out"
    made = ["from-urdf", str(robot), "-o", str(out), "--emit", "report", "--no-verify", "-q"]
    assert run(made) == 0
    (record,) = out.glob("*_ik.json")
    assert not json.loads(record.read_text())["verified"]


def test_of_an_earlier_description(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot, out = write_robot(tmp_path / "arm.urdf"), tmp_path / "out"
    made = ["from-urdf", str(robot), "-o", str(out), "--emit", "report", "--no-verify", "-q"]
    assert run(made) == 0
    robot.write_text(robot.read_text().replace("</robot>", "<!-- new --></robot>"))
    assert run(["verify", str(out)]) == 1
    told = capsys.readouterr().err
    assert "made from an earlier description" in told and "hint: ikgen from-urdf" in told
