"""Arms generated in processes of their own: killed workers, and programs that cannot be run twice."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from tests.support.sampled import sampled

from ikgen.cli.build import _print
from ikgen.cli.main import run
from ikgen.projects.project_build import Outcome


def killed(job: object) -> Outcome:
    """Stands for a generation that the system kills; workers import it from here."""
    os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError


@pytest.mark.skipif(os.name == "nt", reason="needs signals")
@pytest.mark.usefixtures("project")
def test_a_killed_worker_is_told_for_each_arm(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("ikgen.projects.project_build._build_one", killed)
    assert run(["build", "--jobs", "2"]) == 70
    said = capsys.readouterr().err
    for name in ("first", "second"):
        assert f"error: {name}: not generated: a worker process was killed" in said
    assert "--jobs 1" in said and "Traceback" not in said


@pytest.mark.parametrize("jobs", sampled(["1", "2"], ["2"]))
def test_steps_of_every_arm_are_told(
    jobs: str, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = '[[arm]]\nname = "bad"\nrobot = "elbow.urdf"\ntip = "none"\n'
    with (project / "ikgen.toml").open("a") as config:
        config.write(bad)
    assert run(["build", "-v", "--jobs", jobs]) != 0
    said = capsys.readouterr().err
    for name in ("first", "second"):
        for line in ("deriving theta_1", "verifying closure", "behavior tree:", "  closure "):
            assert f"\n{name}: {line}" in said
    assert "\nbad: reading elbow.urdf" in said and "\nbad: verifying" not in said
    assert run(["build", "--force", "--jobs", jobs]) != 0
    assert "behavior tree" not in capsys.readouterr().err


def test_a_setup_file_without_a_main_guard(project: Path) -> None:
    pytest.importorskip("setuptools")
    (project / "setup.py").write_text(
        "from setuptools import setup\n"
        "from ikgen.projects.setuptools import BuildPy\n"
        "print('run once')\n"
        "setup(name='x', version='1', py_modules=[], cmdclass={'build_py': BuildPy})\n"
    )
    done = subprocess.run(
        [sys.executable, "setup.py", "-q", "build_py"], cwd=project, text=True, capture_output=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("run once") == 1
    assert (project / "first_ik.py").is_file() and (project / "second_ik.py").is_file()


def test_what_a_verification_missed_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    outcome = Outcome("arm", "asked for", solutions=8, missed="python 4 missed, all of them")
    _print([outcome], [], 0, as_json=False, quiet=False, verbose=False)
    said = capsys.readouterr().out
    assert "at most 8 solutions a pose (asked for); python 4 missed, all of them" in said
