"""Errors as objects: one JSON document on stdout whatever ends a command."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.support.small_robots import write_robot
from tests.support.solving import FIXTURES

from ikgen.cli.main import run

pytestmark = pytest.mark.usefixtures("solved_once")

KUKA = Path(__file__).resolve().parents[2] / "urdf_fixtures" / "kuka_kr6r900sixx.urdf"
Called = Callable[..., tuple[int, dict[str, Any]]]


@pytest.fixture
def called(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Called:
    """Runs a command with --json beside a robot `elbow.urdf`: its exit code and the whole of stdout."""
    write_robot(tmp_path / "elbow.urdf")
    monkeypatch.chdir(tmp_path)

    def call(*arguments: str) -> tuple[int, dict[str, Any]]:
        capsys.readouterr()
        code = run([*arguments, "--json"])
        return code, json.loads(capsys.readouterr().out)

    return call


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["from-urdf", "nothing.urdf"], "no such file"),
        (["from-urdf"], "Missing argument"),
        (["from-urdf", "elbow.urdf", "--tip", "tol0"], "no link named 'tol0'"),
        (["from-dh", "elbow.urdf"], "not a TOML file"),
        (["inspect", "nothing.urdf"], "no such file"),
        (["report", "nothing.urdf"], "no such file"),
        (["build", "nothing.toml"], "no such file"),
        (["build", "--check"], "no ikgen.toml here"),
        (["verify", "nowhere"], "no such file or directory"),
        (["doctor", "--nonsense"], "No such option"),
    ],
)
def test_bad_input(called: Called, arguments: list[str], said: str) -> None:
    code, found = called(*arguments)
    assert code == found["error"]["exit_code"] == 2
    assert said in found["error"]["message"] and found["error"]["hint"]


def test_a_xacro_argument_in_its_own_way_is_told_how_to_be_given(called: Called) -> None:
    _, found = called("from-urdf", "arm.xacro", "use_gripper:=false")
    assert found["error"]["hint"] == "an argument of xacro: --arg use_gripper:=false"
    _, found = called("from-urdf", "arm.urdf", "more.urdf")
    assert found["error"]["hint"] == "see ikgen from-urdf --help"


def test_the_place_of_an_error(called: Called) -> None:
    Path("broken.urdf").write_text("<robot name='x'>\n<link>\n</robot>")
    code, found = called("from-urdf", "broken.urdf")
    assert (code, found["error"]["file"], found["error"]["line"]) == (2, "broken.urdf", 3)


def test_without_a_closed_form(called: Called) -> None:
    asked = (str(KUKA), "--task", "position-yaw", "--no-verify")
    code, found = called("from-urdf", *asked)
    error = found["error"]
    assert code == error["exit_code"] == 3 and error["task"] == "position-yaw"
    assert error["left"] and "--free JOINT --free JOINT" in error["hint"].splitlines()[-1]
    assert error["hint"].splitlines()[0] == f"ikgen from-urdf {KUKA}"
    code, found = called("report", *asked)
    assert code == found["error"]["exit_code"] == 3
    assert {Path(name).suffix for name in found["files"]} >= {".tex", ".html"}


def test_stale_and_wrong_outputs(called: Called) -> None:
    Path("ikgen.toml").write_text(
        '[[arm]]\nname = "elbow"\nrobot = "elbow.urdf"\ntask = "position"\n'
        '[[arm]]\nname = "other"\nrobot = "none.urdf"\n'
    )
    code, found = called("build", "--check")
    assert code == found["error"]["exit_code"] == 1
    assert found["error"]["hint"] == "ikgen build ikgen.toml" and len(found["arms"]) == 2
    code, found = called("build", "--no-verify")
    assert code == found["error"]["exit_code"] == 2
    assert [arm["generated"] for arm in found["arms"]] == [True, False]
    write_robot(Path("elbow.urdf"), reach=0.4)
    code, found = called("verify", "elbow_ik.json", "--samples", "20")
    assert code == found["error"]["exit_code"] == 1 and not found["passed"]
    assert found["error"]["hint"] == "ikgen build ikgen.toml"


def test_a_report_that_cannot_be_written(called: Called) -> None:
    code, _ = called("from-urdf", "elbow.urdf", "--task", "position", "--no-verify")
    assert code == 0
    code, found = called(
        "verify", "elbow_ik.json", "--samples", "20", "--junit-xml", "elbow.urdf/ik.xml"
    )
    assert code == found["error"]["exit_code"] == 2 and "elbow.urdf" in found["error"]["message"]


def test_an_internal_error(called: Called, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise RuntimeError("broken\nin two")

    monkeypatch.setattr("ikgen.generation.generate.generate", fail)
    code, found = called("from-urdf", "elbow.urdf")
    assert code == found["error"]["exit_code"] == 70
    assert found["error"]["message"] == "internal error: RuntimeError: broken in two"


def test_a_failed_verification(called: Called, monkeypatch: pytest.MonkeyPatch) -> None:
    from ikgen.emit.python import python_emitter

    emit = python_emitter.emit_derivation

    def wrong(derivation: Any) -> dict[str, str]:
        return {name: text.replace("2.5", "2.4") for name, text in emit(derivation).items()}

    monkeypatch.setattr(python_emitter, "emit_derivation", wrong)
    code, found = called(
        "from-urdf", "elbow.urdf", "--task", "position", "--samples", "20", "-o", "out"
    )
    assert code == found["error"]["exit_code"] == 1
    assert not found["error"]["verification"]["python"]["passed"]
    assert not Path("out").exists()
    assert found["error"]["hint"].startswith("nothing was written; run with -v")
    robot = Path("elbow.urdf")
    robot.write_text(robot.read_text().replace('effort="1"', 'effort="-1"'))
    code, found = called("from-urdf", "elbow.urdf", "--task", "position", "--samples", "20")
    assert code == 1 and "see first to what is odd in the file" in found["error"]["hint"]


def test_what_a_file_looks_like_is_said_before_what_failed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    far = tmp_path / "far.urdf"
    near = KUKA.read_text(encoding="utf-8")
    far.write_text(near.replace('"0.420 0 0"', '"420 0 0"').replace('"0.455 0 0"', '"455 0 0"'))
    assert run(["from-urdf", str(far), "--task", "position-yaw", "--no-verify"]) == 3
    told = capsys.readouterr().err
    assert -1 < told.find("like mm") < told.find("error: ")
    config = tmp_path / "ikgen.toml"
    config.write_text('[[arm]]\nname = "far"\nrobot = "far.urdf"\ntask = "position-yaw"\n')
    assert run(["build", str(config), "-j", "1"]) == 3
    told = capsys.readouterr().err
    assert -1 < told.find("like mm") < told.find("error: ")


def test_success_has_no_error(called: Called) -> None:
    code, found = called("from-urdf", "elbow.urdf", "--task", "position", "--no-verify")
    assert code == 0 and "error" not in found


def test_the_tree_is_shown_on_failure(called: Called, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["from-urdf", str(KUKA), "--task", "position-yaw", "--no-verify"]
    assert run(asked) == 3
    brief = capsys.readouterr().err
    assert "behavior tree:" not in brief and "equations" not in brief
    first = next(line for line in brief.splitlines() if line.startswith("error: "))
    assert "6 joints move and the task fixes 4 freedoms: 2 of them have to be held" in first
    assert "--task position-yaw --free JOINT --free JOINT" in brief
    assert run([*asked, "-v"]) == 3
    told = capsys.readouterr().err
    assert "behavior tree:\nround 1" in told and "left are the joints" in told


def test_outputs_that_cannot_be_written_fail_before_the_derivation(
    called: Called, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def derive(*_: object, **__: object) -> None:
        raise AssertionError("derived")

    monkeypatch.setattr("ikgen.generation.generate.derive", derive)
    monkeypatch.setattr("ikgen.generation.report_files.derive", derive)
    Path("file").write_text("")
    for command in ("from-urdf", "report"):
        code, found = called(command, "elbow.urdf", "-o", "file/out")
        assert code == 2 and "-o file/out: '" in found["error"]["message"]


def test_help_lists_the_outputs(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["from-urdf", "--help"]) == 0
    said = " ".join(capsys.readouterr().out.split()).replace("cpp- package", "cpp-package")
    assert "python, cpp, cpp-package, nanobind, moveit, report" in said


def test_a_table_with_a_suffix_in_capitals(called: Called, tmp_path: Path) -> None:
    text = (FIXTURES / "scara_standard.toml").read_text()
    Path("SCARA.TOML").write_text(text)
    code, _ = called("from-dh", "SCARA.TOML", "-o", "out", "--no-verify")
    assert code == 0
    code, found = called("inspect", "SCARA.TOML", "--no-advice")
    assert code == 0 and found["chain"]["dof"] == 4
    code, found = called("verify", "out", "--samples", "20")
    assert code == 0 and found["outputs"][0]["verification"]["python"]["passed"]
