"""Solutions that share the angle which an elimination hides: one alone may find half of them, twice."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from tests.support.both_languages import emitted_in_both, header_of
from tests.support.dh_files import dh_file
from tests.support.redundant_arms import Joint, serial_urdf
from tests.support.row_gaps import row_gaps
from tests.support.sampled import PYTHON_OFTEN
from tests.support.solving import FIXTURES, NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.kinematics.forward import file_forward
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

LIFT: tuple[Joint, ...] = (
    ("lift", "prismatic", "0 0 1", "0 0 0.2", (0.0, 1.1)),
    ("arm", "prismatic", "0 -1 0", "0 -0.2 0", (0.0, 0.52)),
    ("yaw", "revolute", "0 0 -1", "0.08 -0.03 0", (-1.75, 4.0)),
    ("pitch", "revolute", "0 1 0", "0 -0.02 -0.02", (-1.57, 0.56)),
    ("roll", "revolute", "1 0 0", "0.02 -0.024 0.02", (-3.14, 3.14)),
)
"""The y axis of the tool lies along that of the pitch where the wrist is not rolled: all but the lift, the
arm and the pitch are the same then in two solutions."""

EIGHT = (
    ("revolute", 0.0, 0.0, 0.8504392468535797, 0.0),
    ("revolute", "pi/2", 0.5573812381766646, 0.0, 0.0),
    ("prismatic", "pi/2", 0.8946160701903778, 0.0, "pi/2"),
    ("revolute", "pi/2", 0.0, 0.6213572887019925, 0.0),
    ("revolute", "pi/2", 0.3022211447231815, 0.0, 0.0),
    ("revolute", "-pi/2", 0.336405713244554, 0.0, 0.0),
)
"""Joints 1, 4 and 6 are at right angles, to either side, in all of eight solutions of a pose."""


@PYTHON_OFTEN
@pytest.mark.parametrize("noise", [0.0, 1e-6])
def test_all_of_four_are_found(noise: float, language: str, tmp_path: Path) -> None:
    derivation = derive(Request(dh_file(tmp_path / "arm.toml", EIGHT)))
    under, runner = arm_of(derivation), runner_of(derivation, language, tmp_path)
    q = np.array([-1.0, 0.0, 0.0, -1.0, 1.0, 1.0]) * np.pi / 2
    poses = under.oracle.forward(q + noise * np.random.default_rng(0).normal(size=(50, 6)))
    assert runner.solve_many(poses).count.tolist() == [8] * 50


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
def test_all_are_found_where_the_wrist_is_not_rolled(tmp_path: Path) -> None:
    path = tmp_path / "stretch.urdf"
    path.write_text(serial_urdf("stretch", LIFT))
    arm, header = emitted_in_both(
        Request(path, name="stretch", task="position-direction", tool_axis="y"), tmp_path
    )
    random = np.random.default_rng(4)
    low, high = np.array(arm.LOWER), np.array(arm.UPPER)
    q = random.uniform(low, high, (1000, 5))
    q[:, 2] = random.choice([-np.pi / 2, np.pi / 2], 1000) + random.uniform(-0.01, 0.01, 1000)
    q[:, 4] = random.choice([0.0, 1e-6], 1000)
    poses = arm.forward(q)
    rows, (batch, _, _) = header.solve_many(poses), arm.solve_batch(poses)
    for found in (rows.q, batch):
        gap = np.abs(found - q[:, None]).max(axis=2)
        assert np.nanmin(np.where(np.isnan(gap), np.inf, gap), axis=1).max() < 1e-4


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
def test_a_root_that_is_one_of_a_fold_too_is_not_taken_for_one(tmp_path: Path) -> None:
    """Where the arm lies in a plane so, two solutions that meet have the angle of two regular ones."""
    module = derive(Request(FIXTURES / "fanuc_crx10ia.urdf", name="crx")).module
    header = header_of(module, tmp_path)
    q = np.random.default_rng(1).uniform(-3.0, 3.0, (500, 6))
    q[:, 1:5] = (
        -0.78539816362406467,
        -0.78539816372125193,
        -8.0763351867773405e-11,
        -0.78539816327510548,
    )
    found = header.solve_many(file_forward(module.dh, q)).q
    assert row_gaps(found, q).max() < 1e-6
