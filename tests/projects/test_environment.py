"""Descriptions that read the environment: outputs are stale when it has changed."""

from __future__ import annotations

from pathlib import Path

import pytest

from ikgen.cli.main import run

ROBOT = Path(__file__).resolve().parents[2] / "examples/setuptools_robot/urdf/elbow.urdf"


def test_a_variable_that_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("REACH", raising=False)
    read = "$(optenv REACH 0.3) 0 0"
    text = ROBOT.read_text().replace('xyz="0.3 0 0"', f'xyz="{read}"')
    assert read in text
    Path("arm.xacro").write_text(text.replace("<robot", '<robot xmlns:xacro="x"', 1))
    config = '[[arm]]\nname = "arm"\nrobot = "arm.xacro"\ntask = "position"\n'
    Path("ikgen.toml").write_text(config)
    check = ["build", "--check", "--no-verify"]
    assert run(["build", "--no-verify", "-q"]) == 0
    assert run(check) == 0
    monkeypatch.setenv("REACH", "secret")
    assert run(check) == 1
    assert "the environment variable REACH" in capsys.readouterr().out
    monkeypatch.setenv("REACH", "0.4")
    assert run(["build", "--no-verify", "-q"]) == 0
    assert run(check) == 0
    assert "0.4" not in Path("arm_ik.json").read_text()
    monkeypatch.delenv("REACH")
    assert run(check) == 1
