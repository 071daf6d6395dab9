"""Outputs are not replaced by those of another arm, and never left stale."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.support.small_robots import write_robot

from ikgen.cli.main import run

pytestmark = pytest.mark.usefixtures("solved_once")

QUICK = ("--no-verify", "-q", "--task", "position", "-o", "out")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a two-armed and a one-armed robot, as the current directory."""
    monkeypatch.chdir(tmp_path)
    write_robot(tmp_path / "pair.urdf", sides=("left_", "right_"))
    write_robot(tmp_path / "elbow.urdf")
    return tmp_path


def made(folder: Path) -> set[str]:
    return {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()}


def test_chains_of_one_robot_have_names_of_their_own(here: Path) -> None:
    for side in ("left", "right"):
        assert run(["from-urdf", "pair.urdf", "--tip", f"{side}_tool0", *QUICK]) == 0
    assert made(here / "out") == {
        f"pair_{side}_tool0_ik{suffix}" for side in ("left", "right") for suffix in (".py", ".json")
    }
    assert run(["from-urdf", "elbow.urdf", *QUICK]) == 0
    assert "elbow_ik.py" in made(here / "out")


def test_another_chain_is_not_replaced_without_a_word(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    named = ("--name", "arm", *QUICK)
    assert run(["from-urdf", "pair.urdf", "--tip", "left_tool0", *named]) == 0
    before = (here / "out/arm_ik.py").read_bytes()
    assert run(["from-urdf", "pair.urdf", "--tip", "right_tool0", *named]) == 2
    said = capsys.readouterr().err
    assert "out/arm_ik.json has outputs of another chain, base_link -> left_tool0" in said
    assert "--name arm_right_tool0" in said and "--force" in said
    assert (here / "out/arm_ik.py").read_bytes() == before
    assert run(["from-urdf", "pair.urdf", "--tip", "right_tool0", *named, "--force"]) == 0
    assert (here / "out/arm_ik.py").read_bytes() != before


def test_another_robot_or_task_is_not_replaced(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    named = ("--name", "arm", "--no-verify", "-q", "-o", "out")
    write_robot(here / "longer.urdf", reach=0.4)
    assert run(["from-urdf", "elbow.urdf", "--task", "position", *named]) == 0
    assert run(["from-urdf", "longer.urdf", "--task", "position", *named]) == 2
    assert "another robot, elbow.urdf" in capsys.readouterr().err
    assert run(["from-urdf", "elbow.urdf", "--task", "direction", *named]) == 2
    assert "another task, position" in capsys.readouterr().err
    write_robot(here / "elbow.urdf", reach=0.5)  # the same robot, changed
    assert run(["from-urdf", "elbow.urdf", "--task", "position", *named]) == 0


def test_joints_that_move_otherwise_make_another_arm(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plain = ["from-urdf", "elbow.urdf", "--no-verify", "-q", "-o", "out"]
    lock, couple = ["--lock", "elbow=0.1"], ["--couple", "elbow=shoulder*2"]
    (here / "own.yaml").write_text(
        "kinematics:\n"
        "  waist_link: {x: 0, y: 0, z: 0.201, roll: 0, pitch: 0, yaw: 0}\n"
        "  shoulder_link: {x: 0, y: 0, z: 0.1, roll: 0, pitch: 0, yaw: 0}\n"
        "  elbow_link: {x: 0, y: 0, z: 0.35, roll: 0, pitch: 0, yaw: 0}\n"
    )
    own, before = ["--calibration", "own.yaml"], "with no joint locked"
    assert run(plain) == 0
    for options, said in (
        (lock, "with elbow=0.1 locked"),
        (couple, "with elbow=shoulder*2 coupled"),
        (own, "calibrated by own.yaml"),
        ([], ""),
    ):
        bytes_before = (here / "out/elbow_ik.py").read_bytes()
        assert run([*plain, *options]) == 2
        assert f"out/elbow_ik.json has outputs of the arm {before}" in capsys.readouterr().err
        assert (here / "out/elbow_ik.py").read_bytes() == bytes_before
        assert run([*plain, *options, "--force"]) == run([*plain, *options]) == 0
        before = said


def test_arguments_that_make_another_robot(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (here / "elbow.urdf").read_text().replace('"0.3 0 0"', '"$(arg reach) 0 0"')
    declared = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="elbow">'
    declared += '<xacro:arg name="reach" default="0.3"/><xacro:arg name="colour" default="red"/>'
    (here / "arm.xacro").write_text(text.replace('<robot name="elbow">', declared))
    assert run(["from-urdf", "arm.xacro", *QUICK]) == 0
    assert run(["from-urdf", "arm.xacro", "--arg", "colour:=blue", *QUICK]) == 0
    assert run(["from-urdf", "arm.xacro", "--arg", "reach:=0.7", *QUICK]) == 2
    assert "another robot, arm.xacro with colour:=blue" in capsys.readouterr().err


def test_a_record_that_is_none_is_not_replaced(here: Path) -> None:
    (here / "out").mkdir()
    (here / "out/elbow_ik.json").write_text('{"mine": 1}')
    assert run(["from-urdf", "elbow.urdf", *QUICK]) == 2
    assert run(["from-urdf", "elbow.urdf", *QUICK, "--force"]) == 0


def test_languages_made_before_are_made_again(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["from-urdf", "elbow.urdf", *QUICK]) == 0
    write_robot(here / "elbow.urdf", reach=0.5)
    assert run(["from-urdf", "elbow.urdf", *QUICK, "--emit", "cpp"]) == 0
    record = json.loads((here / "out/elbow_ik.json").read_text())
    assert record["emit"] == ["python", "cpp"]
    assert set(record["files"]) == {"elbow_ik.py", "elbow_ik.hpp"}
    assert record["source_sha256"] in (here / "out/elbow_ik.py").read_text()
    capsys.readouterr()
    assert run(["from-urdf", "elbow.urdf", *QUICK[:1], *QUICK[2:], "--emit", "cpp", "--only"]) == 0
    assert "removed out/elbow_ik.py" in capsys.readouterr().err
    assert made(here / "out") == {"elbow_ik.hpp", "elbow_ik.json"}


def test_an_edited_output_is_not_removed(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["from-urdf", "elbow.urdf", *QUICK]) == 0
    with (here / "out/elbow_ik.py").open("a") as stream:
        stream.write("# mine\n")
    assert run(["from-urdf", "elbow.urdf", "--task", "position", "-o", "out", "--no-verify",
                "--emit", "cpp", "--only"]) == 0  # fmt: skip
    assert "out/elbow_ik.py is of an earlier run" in capsys.readouterr().err
    assert "elbow_ik.py" in made(here / "out")


def test_records_of_packages_lie_inside_them(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    packages = {
        "cpp-package": "elbow_ik_cpp",
        "nanobind": "elbow_ik_ext",
        "moveit": "elbow_ik_moveit",
    }
    assert run(["from-urdf", "elbow.urdf", *QUICK, "--emit", ",".join(packages)]) == 0
    out = here / "out"
    assert {p.parent.name for p in out.rglob("*_ik.json")} == set(packages.values())
    for emitter, folder in packages.items():
        record = json.loads((out / folder / "elbow_ik.json").read_text())
        assert record["emit"] == [emitter] and record["robot"] == "../../elbow.urdf"
        assert {(out / folder / name).is_file() for name in record["files"]} == {True}
    assert run(["from-urdf", "elbow.urdf", *QUICK]) == 0  # all again, and the Python module
    assert "elbow_ik.py" in made(out) and "elbow_ik_ext/elbow_ik.json" in made(out)
    (here / "ikgen.toml").write_text(
        '[[arm]]\nname = "elbow"\nrobot = "elbow.urdf"\ntask = "position"\nout = "out"\n'
        'emit = ["python", "moveit"]\n'
    )
    assert run(["build", "--check", "--no-verify"]) == 1
    assert "'emit' was" in capsys.readouterr().out
    assert run(["build", "--no-verify", "-q"]) == run(["build", "--check", "--no-verify"]) == 0
    assert not (out / "elbow_ik_ext").exists() and not (out / "elbow_ik_cpp").exists()
    assert run(["verify", "ikgen.toml", "--samples", "20", "--json"]) in (0, 2)  # 2: no compiler


@pytest.mark.parametrize("recorded", [True, False])
def test_files_of_others_are_not_replaced(
    here: Path, capsys: pytest.CaptureFixture[str], recorded: bool
) -> None:
    module = here / "out/elbow_ik.py"
    if recorded:
        assert run(["from-urdf", "elbow.urdf", *QUICK]) == 0
        assert run(["from-urdf", "elbow.urdf", *QUICK]) == 0  # as it was written
    else:
        module.parent.mkdir()
        module.write_text("")
    mine = module.read_text() + "print('mine')\n"
    module.write_text(mine)
    assert run(["from-urdf", "elbow.urdf", *QUICK]) == 2
    said = capsys.readouterr().err
    what = "was edited after it was generated" if recorded else "is in no record of ikgen"
    assert f"out/elbow_ik.py {what}" in said and "--force" in said
    assert module.read_text() == mine
    assert run(["from-urdf", "elbow.urdf", *QUICK, "--force"]) == 0
    assert module.read_text() != mine
