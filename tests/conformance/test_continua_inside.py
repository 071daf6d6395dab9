"""Continua, and what rounding leaves of them, whose rows have to be put inside the limits."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from numpy.typing import NDArray
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.sampled import PYTHON_OFTEN
from tests.support.serial_urdf import serial_urdf as origins_urdf
from tests.support.solving import FIXTURES

from ikgen.derivation.derive import derive
from ikgen.records.request import Request
from ikgen.verify.completeness import survey
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import run_trial

LOWER, UPPER = 0.5, 0.7
"""Of joint 4: neither 0 nor a multiple of the step between the values that are tried lies inside."""

pytestmark = pytest.mark.usefixtures("solved_once")


@PYTHON_OFTEN
def test_a_stretched_wrist_is_answered_inside_the_limits(language: str, tmp_path: Path) -> None:
    derivation = derive(Request(FIXTURES / "kuka_kr6r900sixx.urdf"))
    arm, rng = arm_of(derivation), np.random.default_rng(4)
    at = rng.uniform(0.2, 0.6, (20, 6))
    at[:, 3], at[:, 4] = rng.uniform(LOWER, UPPER, 20), 0.0
    dh = derivation.module.dh
    joints = list(dh.joints)
    joints[3] = replace(joints[3], limits=replace(joints[3].limits, lower=LOWER, upper=UPPER))
    limited = replace(dh, joints=tuple(joints))
    derivation = replace(derivation, module=replace(derivation.module, dh=limited))
    poses = arm.oracle.forward(at)
    rows = runner_of(derivation, language, tmp_path).solve_many(poses, seeds=None, limits=True)
    assert rows.mask.any(axis=1).all()
    index, q, _ = rows.flat()
    assert (q[:, 3] >= LOWER).all()
    assert (q[:, 3] <= UPPER).all()
    assert np.abs(arm.oracle.forward(q) - poses[index]).max() < 2e-9


@PYTHON_OFTEN
def test_a_held_joint_stays_on_its_turn_along_a_broken_continuum(
    language: str, tmp_path: Path
) -> None:
    (name, *rest, _), *others = SHOULDER_ELBOW_WRIST
    off = "2e-5 1e-5 0"  # a file's rounding, which parts axes that meet
    joints = [
        (name, *rest, (-5.0, 5.0)),
        *((*a[:3], off if a[3] == "0 0 0" else a[3], a[4]) for a in others),
    ]
    path = tmp_path / "arm.urdf"
    path.write_text(serial_urdf("arm", joints))
    derivation = derive(Request(path, free={name: None}))
    assert derivation.module.rounded
    q = np.random.default_rng(1).uniform(0.1, 1.2, (60, 7))
    q[:, 0] += 3.2
    q[:, 5] = 10.0 ** np.random.default_rng(2).uniform(-7.0, -2.0, 60)
    poses = arm_of(derivation).oracle.forward(q)
    rows = runner_of(derivation, language, tmp_path).solve_many(poses, free=q[:, :1])
    index, found, _ = rows.flat()
    assert (found[:, 0] == q[index, 0]).all()
    off_by = np.abs(found - q[index]).max(axis=1)
    assert [off_by[index == i].min() < 1e-4 for i in range(60)] == [True] * 60


H, PI = "1.5707963267948966", "3.141592653589793"
TURNED_ELBOW = [
    ("0 0 0", "0 0 0"), ("0.125 0 0", f"{H} 0 0"), ("0.09 0 0", f"-{H} {PI} -{H}"),
    ("-0.02 0 0.222", f"{H} -{H} 0"), ("0.162 -0.02 0", f"{H} -{H} -{H}"), ("0 0 -0.15", f"0 -{H} -{H}"),
    ("0 0 0", f"{H} 0 {H}"),
]  # fmt: skip
"""At 0 the elbow puts joints 3 and 5 on one axis, and the arm is not stretched."""

RANGES = [
    (-1.178, 1.571), (-1.178, 1.571), (-0.786, 3.927), (-0.393, 2.357), (-2.095, 2.095), (-1.414, 1.414),
    (-2.095, 2.095),
]  # fmt: skip
"""Rad, a joint each: the elbow bends to both sides."""


def straight_wrists() -> NDArray[np.float64]:
    """But for round-off to 1e-10 at multiples of 45 degrees: joint 7 goes round with joint 5, and in the
    second half, the elbow at 0, with joint 3 too. At many values of one the others are outside."""
    (low, high), random = np.array(RANGES).T, np.random.default_rng(6)
    least, most = np.ceil(low / (np.pi / 4)), np.floor(high / (np.pi / 4))
    q = random.integers(least.astype(int), most.astype(int) + 1, (400, 7)) * (np.pi / 4)
    q[:, 5], q[200:, 3] = 0.0, 0.0
    off = 10.0 ** random.uniform(-12.0, -10.0, (400, 1))
    return np.clip(q + random.normal(scale=off, size=q.shape), low, high)


@PYTHON_OFTEN
def test_a_continuum_has_a_row_inside_beside_those_of_other_branches(
    language: str, tmp_path: Path
) -> None:
    path = origins_urdf(tmp_path / "arm.urdf", TURNED_ELBOW, limit=RANGES)
    derivation = derive(Request(path, free={"j0": None}))
    under, q = arm_of(derivation), straight_wrists()
    sample = SampleSet("straight wrists", q, under.oracle.forward(q), under.sigma(q))
    runner = runner_of(derivation, language, tmp_path)
    trial = run_trial(runner, under, sample, limits=True)
    plain = (trial.rows.mask & ~trial.rows.singular).any(axis=1)
    assert plain[:200].sum() > 50
    assert plain[200:].sum() > 50
    assert trial.rows.singular.any(axis=1).all()
    assert not survey(under, runner, [trial]).missed.any()
