"""`ikgen verify` notices what is wrong and says by how much."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from ikgen.cli.main import run

KUKA = Path(__file__).resolve().parents[2] / "urdf_fixtures" / "kuka_kr6r900sixx.urdf"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A robot with generated outputs in `out`, and the current directory."""
    shutil.copy(KUKA, tmp_path / "arm.urdf")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GITHUB_ACTIONS", raising=False)
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    assert run(["from-urdf", "arm.urdf", "-o", "out", "--name", "arm", "--no-verify", "-q"]) == 0
    return tmp_path


def edit(path: Path, before: str, after: str) -> None:
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after))


def check(*arguments: str) -> int:
    return run(["verify", *arguments, "--samples", "20"])


def test_right(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert check("out", "--json") == 0
    assert json.loads(capsys.readouterr().out)["passed"]


def test_another_geometry(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "arm.urdf", "0.455", "0.460")
    assert check("out") == 1
    message = capsys.readouterr().err
    assert "by up to 5 mm and" in message
    assert "ikgen from-urdf arm.urdf" in message


def test_the_command_told_puts_it_right(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import shlex

    edit(project / "arm.urdf", "0.455", "0.460")
    assert check("out") == 1
    hint = next(x for x in capsys.readouterr().err.splitlines() if x.startswith("hint: "))
    assert run([*shlex.split(hint.removeprefix("hint: "))[1:], "--no-verify"]) == 0
    assert check("out") == 0


def test_text_changed_but_not_the_geometry(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    edit(project / "arm.urdf", "</robot>", "<!-- a remark --></robot>")
    assert check("out") == 0
    assert "text of the description has changed" in capsys.readouterr().out


def test_limits_changed(project: Path) -> None:
    text = (project / "arm.urdf").read_text()
    start = text.index('lower="') + len('lower="')
    end = text.index('"', start)
    (project / "arm.urdf").write_text(text[:start] + "-1.0" + text[end:])
    assert check("out") == 1


def test_edited_output(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with (project / "out/arm_ik.py").open("a") as stream:
        stream.write("# a remark\n")
    assert check("out") == 1
    assert "was edited" in capsys.readouterr().err


def test_broken_output(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (project / "out/arm_ik.py").write_text("def (")
    assert check("out") == 1
    (project / "out/arm_ik.py").unlink()
    assert check("out") == 1
    assert "not there" in capsys.readouterr().err


def test_other_joints(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    edit(project / "arm.urdf", '"joint_a3"', '"elbow"')
    assert check("out") == 1
    assert "elbow" in capsys.readouterr().err


def test_a_tip_that_is_gone(project: Path) -> None:
    edit(project / "arm.urdf", '"tool0"', '"tool1"')
    assert check("out") == 1


def test_description_that_cannot_be_read(project: Path) -> None:
    (project / "arm.urdf").unlink()
    assert check("out") == 2
    (project / "out/arm_ik.json").write_text("{")
    assert check("out") == 2


def test_another_robot(project: Path) -> None:
    shutil.copy(KUKA, project / "copy.urdf")
    (project / "arm.urdf").unlink()
    assert check("out", "--robot", "copy.urdf") == 0


def test_junit_and_annotations(
    project: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import junitparser

    edit(project / "arm.urdf", "0.455", "0.460")
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(project / "summary.md"))
    assert check("out", "--junit-xml", "results/j.xml") == 1
    assert "::error file=out/arm_ik.py,line=1::" in capsys.readouterr().err
    assert "WRONG" in (project / "summary.md").read_text()
    assert junitparser.JUnitXml.fromfile("results/j.xml").failures == 1


def test_module_entry() -> None:
    done = subprocess.run([sys.executable, "-m", "ikgen", "--version"], capture_output=True)
    assert done.returncode == 0
