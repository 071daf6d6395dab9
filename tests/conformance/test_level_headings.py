"""Tools that a rounded file tilts keep their heading: the task by it, no row lost, level poses answered."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from tests.support.sampled import sampled
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.derivation.read import read
from ikgen.emit.derivation import Derivation
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request
from ikgen.tasks.fitting import fitting_tasks
from ikgen.verify.agreement import disagreements
from ikgen.verify.completeness import survey
from ikgen.verify.runners.runner import Runner
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import run_trial

SCARA = """<robot name="scara">
  <link name="base"/><link name="inner"/><link name="outer"/><link name="quill"/><link name="tool"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="inner"/>
    <origin xyz="0 0 0.22"/><axis xyz="0 0 1"/><limit lower="-2.4" upper="2.4"/></joint>
  <joint name="j2" type="revolute"><parent link="inner"/><child link="outer"/>
    <origin xyz="0.2 0 0"/><axis xyz="0 0 1"/><limit lower="-2.6" upper="2.6"/></joint>
  <joint name="j3" type="prismatic"><parent link="outer"/><child link="quill"/>
    <origin xyz="0.25 0 0" rpy="{half} 0 0"/><axis xyz="0 0 1"/><limit lower="0" upper="0.18"/></joint>
  <joint name="j4" type="revolute"><parent link="quill"/><child link="tool"/>
    <axis xyz="0 0 1"/><limit lower="-6" upper="6"/></joint>
</robot>
"""
HALVES = ["3.14159", "3.1416", "3.14", "3.1397"]
OFTEN = ["3.1397"]
Solved = tuple[Derivation, list[Runner]]


@pytest.fixture(scope="module", params=HALVES)
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("level") / "scara.urdf"
    path.write_text(SCARA.format(half=request.param))
    return path


@pytest.fixture(scope="module")
def solved(robot: Path) -> Solved:
    """How it is solved, and its code in both languages."""
    if NO_COMPILER:
        pytest.skip(NO_COMPILER)
    derivation = derive(Request(robot, task="position-yaw"))
    return derivation, [runner_of(derivation, x, robot.parent) for x in ("python", "cpp")]


def test_half_a_turn_in_few_digits_leaves_the_task_by_the_heading(robot: Path) -> None:
    assert fitting_tasks(read(Request(robot)).dh)[0].name == "position-yaw"


def test_a_tilt_that_is_no_rounding_does_not(tmp_path: Path) -> None:
    path = tmp_path / "scara.urdf"
    path.write_text(SCARA.format(half="3.1"))
    assert "position-yaw" not in {task.name for task in fitting_tasks(read(Request(path)).dh)}


@pytest.mark.parametrize("robot", sampled(HALVES, OFTEN), indirect=True)
def test_no_row_is_lost_beside_the_stretched_elbow(solved: Solved) -> None:
    derivation, runners = solved
    arm = arm_of(derivation)
    elbow = [s * 10.0**-k for k in range(2, 10) for s in (1.0, -1.0)]
    q = np.array([[0.3, x, 0.09, 1.2] for x in elbow] + [[-1.2, x, 0.1, 1.5717] for x in elbow])
    sample = SampleSet("stretched", q, arm.oracle.forward(q), arm.sigma(q))
    for runner in runners:
        found = survey(arm, runner, [run_trial(runner, arm, sample, limits=True)])
        lost = np.flatnonzero(found.missed | found.unanswered)
        assert not len(lost), found.case(int(lost[0]))
    python, cpp = (runner.solve_many(sample.poses) for runner in runners)
    wrong, _, _ = disagreements(arm, python, cpp)
    assert not wrong.any()


@pytest.mark.parametrize("robot", sampled(HALVES, OFTEN), indirect=True)
def test_level_poses_are_answered(solved: Solved) -> None:
    derivation, runners = solved
    arm = arm_of(derivation)
    yaw = np.linspace(-3.0, 3.0, 20)
    poses = np.tile(np.diag([1.0, -1.0, -1.0, 1.0]), (20, 1, 1))
    poses[:, :2, 0] = np.stack([np.cos(yaw), np.sin(yaw)], axis=1)
    poses[:, :2, 1] = np.stack([np.sin(yaw), -np.cos(yaw)], axis=1)
    poses[:, :3, 3] = [0.25, 0.1, 0.15]
    for runner in runners:
        rows = runner.solve_many(poses)
        for q, T in zip(rows, poses, strict=True):
            assert len(q) == 2
            there = arm.oracle.forward(q)
            assert np.abs(there[:, :3, 3] - T[:3, 3]).max() < 1e-9
            heading = np.arctan2(there[:, 1, 0], there[:, 0, 0])
            turned = np.exp(1j * (heading - np.arctan2(T[1, 0], T[0, 0])))
            assert np.abs(turned - 1.0).max() < 1e-9


PALLETIZER = """<robot name="palletizer">
  <link name="base"/><link name="column"/><link name="upper"/><link name="rod"/><link name="fore"/>
  <link name="plate"/><link name="flange"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="column"/>
    <origin xyz="0 0 0.23"/><axis xyz="0 0 1"/><limit lower="-2.7" upper="2.7"/></joint>
  <joint name="j2" type="revolute"><parent link="column"/><child link="upper"/>
    <origin xyz="0.04 0 0"/><axis xyz="0 1 0"/><limit lower="-0.4" upper="1.4"/></joint>
  <joint name="j2m" type="revolute"><parent link="upper"/><child link="rod"/>
    <origin xyz="0 0 0.175"/><axis xyz="0 1 0"/><limit lower="-3" upper="3"/>
    <mimic joint="j2" multiplier="-1"/></joint>
  <joint name="j3" type="revolute"><parent link="rod"/><child link="fore"/>
    <axis xyz="0 1 0"/><limit lower="-0.3" upper="1.8"/></joint>
  <joint name="j3m" type="revolute"><parent link="fore"/><child link="plate"/>
    <origin xyz="0.175 0 0"/><axis xyz="0 1 0"/><limit lower="-3" upper="3"/>
    <mimic joint="j3" multiplier="-1"/></joint>
  <joint name="j4" type="revolute"><parent link="plate"/><child link="flange"/>
    <origin xyz="0.066 0 -0.04" rpy="{turns}"/><axis xyz="0 0 1"/><limit lower="-6" upper="6"/></joint>
</robot>
"""
TURNS = ["0 3.14 0", "3.14 0 0", "3.14409 0 0", "0.0025 0.003 0"]


@pytest.mark.parametrize("turns", sampled(TURNS, ["3.14409 0 0"]))
def test_tilts_that_no_constant_of_the_rows_is_rounded_for_are_solved(
    tmp_path: Path, turns: str
) -> None:
    """A flange's turn about the axes of the arm before it is a constant like any other."""
    path = tmp_path / "palletizer.urdf"
    path.write_text(PALLETIZER.format(turns=turns))
    emit = ("python",) if NO_COMPILER else ("python", "cpp")
    made = generate(Request(path), Outputs(out=tmp_path, emit=emit, samples=200))
    assert made.derivation.task.name == "position-yaw"
    assert all(report.passed for report in made.reports.values())
