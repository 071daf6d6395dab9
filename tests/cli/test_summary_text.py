"""What a finished generation says of the geometry that was solved."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, TORSO, Joint, serial_urdf
from tests.support.small_robots import write_robot
from tests.support.telescopes import RELATIONS, telescope_robot

from ikgen.cli.main import run

pytestmark = pytest.mark.usefixtures("solved_once")


def said(folder: Path, shift: str, capsys: pytest.CaptureFixture[str]) -> tuple[str, str]:
    """The class that was announced and the summary's line on the geometry, of an arm whose shoulder and
    wrist are `shift` (m) off."""
    joints = list(SHOULDER_ELBOW_WRIST)
    for i in (1, 5):
        name, kind, axis, _, limits = joints[i]
        joints[i] = (name, kind, axis, f"{shift} {shift} 0", limits)
    (folder / "arm.urdf").write_text(serial_urdf("arm", joints))
    assert run(["from-urdf", str(folder / "arm.urdf"), "-o", str(folder), "--no-verify"]) == 0
    told = capsys.readouterr()
    (announced,) = (line for line in told.err.splitlines() if line.startswith("deriving "))
    (geometry,) = (line for line in told.out.splitlines() if line.startswith("geometry:"))
    return announced.removeprefix("deriving "), geometry.removeprefix("geometry:").strip()


@pytest.mark.parametrize(
    ("shift", "words"),
    [
        ("0.0001", "; the file's, 7R one spherical triple, is up to 0."),
        ("0.0002", "; the file's is 7R one spherical triple"),  # by elimination, of the file's rows
    ],
)
def test_the_class_of_the_file_is_named_beside_that_which_was_solved(
    shift: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    announced, geometry = said(tmp_path, shift, capsys)
    assert announced == "7R one spherical triple"
    assert geometry.startswith("7R S-R-S: ") and words in geometry


def test_a_class_that_is_the_file_s_is_named_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    announced, geometry = said(tmp_path, "0", capsys)
    assert announced == "7R S-R-S" and geometry.count("7R") == 1


def test_what_default_values_answer_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "arm.urdf").write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST))
    command = ["from-urdf", str(tmp_path / "arm.urdf"), "-o", str(tmp_path), "--samples", "40"]
    assert run([*command, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    by_default = record["verification"]["python"]["by_default"]
    assert by_default["poses"] == 40 and 0 < by_default["answered"] <= 40
    assert run([*command, "--free", f"{record['free'][0]}=0.3"]) == 0
    (line,) = (x for x in capsys.readouterr().out.splitlines() if x.startswith("solutions:"))
    held = (
        rf"; by default \({record['free'][0]} = 0\.3\) (\d+) of 40 of these have any(; search .*)?$"
    )
    said = re.search(held, line)
    assert said and (said[2] == "; search tries other values") is (int(said[1]) < 20)


def solutions(
    folder: Path, capsys: pytest.CaptureFixture[str], joints: tuple[Joint, ...], *options: str
) -> str:
    """What a summary says of the solutions of an arm of these joints, with a few samples."""
    path = folder / "arm.urdf"
    path.write_text(serial_urdf("arm", joints))
    command = ["from-urdf", str(path), "-o", str(folder), "--samples", "40", *options]
    assert run(command) == 0
    (line,) = (x for x in capsys.readouterr().out.splitlines() if x.startswith("solutions:"))
    return line


def test_a_search_over_several_is_not_said_to_be_quick(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    held = ("--free", "torso=0.4", "--free", "shoulder_pitch=2")
    line = solutions(tmp_path, capsys, (TORSO, *SHOULDER_ELBOW_WRIST), *held)
    assert line.endswith("; search tries a grid of other values (seconds a pose in Python)")


def test_no_search_is_proposed_where_other_values_change_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """An elbow that is pinned is never held: no value of another joint reaches a pose that is drawn."""
    pinned = tuple(
        (*one[:4], (1.0, 1.0) if one[0] == "elbow" else one[4]) for one in SHOULDER_ELBOW_WRIST
    )
    line = solutions(tmp_path, capsys, pinned, "--free", "wrist_yaw")
    assert "by default" in line and "search" not in line


@pytest.mark.parametrize(
    ("relations", "words"),
    [
        (RELATIONS, "stage_2=stage_1*1+0.01; stage_3=stage_1*1+0.02; stage_4=stage_1*0.5+0.03"),
        (
            {"stage_3": "stage_1*0.5+0.02"},
            "stage_3=stage_1*0.5+0.02; stage_2=stage_1*1+0.01; stage_4=stage_1*1+0.03",
        ),
        ({}, "stage_2=stage_1*1+0.01; stage_3=stage_1*1+0.02; stage_4=stage_1*1+0.03"),
    ],
)
def test_joints_that_follow_others_are_named(
    relations: dict[str, str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["from-urdf", str(telescope_robot(tmp_path)), "--task", "position"]
    command += [f"--couple={joint}={text}" for joint, text in relations.items()]
    assert run([*command, "--no-verify", "-o", str(tmp_path)]) == 0
    (line,) = (x for x in capsys.readouterr().out.splitlines() if x.startswith("coupled:"))
    chosen = "" if relations == RELATIONS else " (equal stages of a telescope)"
    assert line.removeprefix("coupled:").strip() == words + chosen
    assert run([*command, "--no-verify", "-o", str(tmp_path), "--json"]) == 0
    assert "; ".join(json.loads(capsys.readouterr().out)["coupled"]) == words


def test_joints_that_the_file_lets_follow_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = write_robot(tmp_path / "elbow.urdf")
    text = robot.read_text()
    place = text.index("</joint>", text.index('<joint name="elbow"'))
    mimic = '<mimic joint="shoulder" multiplier="-1" offset="0.5"/>'
    robot.write_text(text[:place] + mimic + text[place:])
    command = ["from-urdf", str(robot), "-o", str(tmp_path), "--no-verify"]
    assert run(command) == 0
    said = capsys.readouterr().out
    (line,) = (x for x in said.splitlines() if x.startswith("follow:"))
    assert line.removeprefix("follow:").strip() == "elbow=shoulder*-1+0.5 (as in the file)"
    assert not any(line.startswith("coupled:") for line in said.splitlines())


def test_an_arm_whose_joints_follow_none_has_no_such_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "arm.urdf").write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST))
    assert run(["from-urdf", str(tmp_path / "arm.urdf"), "-o", str(tmp_path), "--no-verify"]) == 0
    said = capsys.readouterr().out
    assert "coupled:" not in said and "follow:" not in said


def test_what_a_manifest_lacks_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot = write_robot(tmp_path / "elbow.urdf")
    command = [
        "from-urdf",
        str(robot),
        "-o",
        str(tmp_path),
        "--no-verify",
        "--emit",
        "python,moveit",
    ]
    assert run(command) == 0
    told = capsys.readouterr().out
    manifest = tmp_path / "elbow_ik_moveit/package.xml"
    line = re.search(r"^fill in: +(.*)$", told, re.MULTILINE)
    assert line and line[1] == (f"maintainer and license of {manifest} (--maintainer, --license)")
    assert run([*command, "--maintainer", "Ada <ada@example.org>"]) == 0
    assert f"license of {manifest} (--license)" in capsys.readouterr().out
    assert run([*command, "--maintainer", "Ada <ada@example.org>", "--license", "MIT"]) == 0
    assert "fill in" not in capsys.readouterr().out
