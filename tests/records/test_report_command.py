"""The command of a report that makes it again."""

from __future__ import annotations

import html
import re
import shlex
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import FIXTURES

from ikgen.cli.main import run
from ikgen.derivation.read import read
from ikgen.records.report_command import report_command
from ikgen.records.request import Request
from ikgen.tasks import find_task

ORIGINS = [("0 0 0.1", "0 0 0"), ("0 0 0.2", "0 0 0"), ("0 0 0.1", "0 0 0"), ("0.4 0 0", "0 0 0")]


def test_the_command_of_a_report_makes_the_same_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "robots"
    folder.mkdir()
    axes = ["0 0 1", "0 0 1", "0 1 0", "0 1 0", "0 1 0", "1 0 0"]
    origins = [*ORIGINS, ("0.3 0 0", "0 0 0"), ("0 0 0.1", "0 0 0")]
    robot = serial_urdf(
        folder / "my arm.urdf", origins, axes=axes, slides={0: "0 0 1"}, limit=2.0, tip=origins[3]
    )
    asked = ["--free", "j0=0.123456789", "--lock", "j5=0.987654321", "--couple", "j4=j3*-1+0.1"]
    where = ["--no-verify", "-o"]
    assert run(["report", str(robot), "--task", "position", *asked, *where, str(tmp_path)]) in (
        0,
        3,
    )
    (page,) = tmp_path.glob("*_report.html")
    first = page.read_text(encoding="utf-8")
    found = re.search(r"make it again, where the file lies.*?(ikgen report .*?)<", first, re.S)
    assert found is not None
    words = shlex.split(html.unescape(found[1]))
    monkeypatch.chdir(folder)
    assert run([*words[1:], *where, str(tmp_path / "again")]) == 0
    assert (tmp_path / "again" / page.name).read_text(encoding="utf-8") == first


def test_paths_are_those_of_the_descriptions_folder() -> None:
    lies = Request(FIXTURES / "ur5e.urdf", calibration=FIXTURES / "own.yaml")
    asked = replace(lies, package_paths=(FIXTURES.parent / "other packages",), trust=True)
    reading = read(Request(FIXTURES / "ur5e.urdf"))
    words = report_command(asked, reading, find_task("pose"))
    assert words.startswith("ikgen report ur5e.urdf --base base_link --tip tool0 ")
    assert "--calibration own.yaml --package-path '../other packages'" in words
    assert "--task" not in words and "--trust" not in words
    named = replace(asked, robot=Path("example-robot-data:ur5"))
    words = report_command(named, reading, find_task("position-yaw"))
    assert words.startswith("ikgen report example-robot-data:ur5 --base base_link ")
    assert f"--calibration {FIXTURES / 'own.yaml'}" in words and "--task position-yaw" in words


def test_paths_hold_where_the_description_is_reached_by_a_link(tmp_path: Path) -> None:
    (tmp_path / "far" / "away").mkdir(parents=True)
    (tmp_path / "packages").mkdir()
    (tmp_path / "here").symlink_to(tmp_path / "far" / "away", target_is_directory=True)
    shutil.copy(FIXTURES / "ur5e.urdf", tmp_path / "far" / "away")
    robot = tmp_path / "here" / "ur5e.urdf"
    asked = Request(robot, package_paths=(tmp_path / "packages",))
    words = shlex.split(report_command(asked, read(Request(robot)), find_task("pose")))
    named = words[words.index("--package-path") + 1]
    assert (robot.parent / named).samefile(tmp_path / "packages")
