"""The examples of a leaf and a task as packages: installed, found, solved with and verified."""

from __future__ import annotations

import importlib
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.support.small_robots import PLANAR
from tests.support.solving import NO_COMPILER, import_text
from tests.support.twist_arm import REACH, TWIST

from ikgen.generation.generate import generate
from ikgen.plugins import find_plug_in
from ikgen.records.request import Outputs, Request
from ikgen.solver import leaves
from ikgen.tasks import TASKS, find_task

pytest.importorskip("hatchling")

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
LANGUAGES = ("python",) if NO_COMPILER else ("python", "cpp")


@pytest.fixture
def install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[str], None]:
    """Puts an example's package on the path, as pip installs it."""

    def put(name: str) -> None:
        project = shutil.copytree(EXAMPLES / name, tmp_path / name)
        command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
        subprocess.run(command, cwd=project, check=True, capture_output=True)
        site = tmp_path / "site"
        with zipfile.ZipFile(next(tmp_path.glob("*.whl"))) as wheel:
            wheel.extractall(site)
        monkeypatch.syspath_prepend(str(site))
        importlib.invalidate_caches()

    return put


def test_the_leaf_solves_with_four_branches(
    install: Callable[[str], None], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    install("plugin_leaf")
    assert leaves.all_leaves()[-1].name == "double angle"
    monkeypatch.setattr("ikgen.tasks.TASKS", (*TASKS, REACH))
    robot, out = tmp_path / "twist.urdf", tmp_path / "out"
    robot.write_text(TWIST)
    request = Request(robot, task="reach")
    beside = generate(request, Outputs(("python",), out, verify=False)).derivation.graph
    assert beside.steps[0].candidate.leaf == "quartic"
    assert "double angle" in {one.leaf for one in beside.steps[0].rejected}
    own = [one for one in leaves.LEAVES if one.name not in ("quartic", "trigonometric polynomial")]
    monkeypatch.setattr(leaves, "LEAVES", tuple(own))
    made = generate(request, Outputs(LANGUAGES, tmp_path / "alone", samples=200))
    assert [step.candidate.leaf for step in made.derivation.graph.steps] == [
        "double angle",
        "algebraic",
    ]
    assert sorted(made.reports) == sorted(LANGUAGES)
    assert all(report.passed for report in made.reports.values())
    assert made.derivation.module.program.max_solutions == 4


def test_the_task_is_found_solved_and_verified(
    install: Callable[[str], None], tmp_path: Path
) -> None:
    install("plugin_task")
    assert find_plug_in("ikgen.tasks", "plane") is not None
    assert find_task("plane").readable == {"px", "py"}
    robot = tmp_path / "planar.urdf"
    robot.write_text(PLANAR)
    made = generate(Request(robot, task="plane"), Outputs(LANGUAGES, tmp_path / "out", samples=200))
    assert sorted(made.reports) == sorted(LANGUAGES)
    assert all(report.passed for report in made.reports.values())
    arm = import_text((tmp_path / "out/planar_ik.py").read_text(), tmp_path)
    pose = arm.forward([0.3, 0.9])
    pose[:2, :2] = np.eye(2)  # what the task does not read
    found = arm.solve(pose).q
    assert len(found) == 2 and np.abs(found - [0.3, 0.9]).max(axis=1).min() < 1e-9
