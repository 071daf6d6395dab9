"""Calibrated arms with four joints, stretched: more than two solutions lie near one another."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.records.request import Request
from ikgen.verify.completeness import survey
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import run_trial

CALIBRATED = [
    ("0 0 0.41195", "-0.00016352 -4.4641e-05 -2.4485e-05"),
    ("-0.000269 0.000264 -8.6e-05", "1.571081466 0.000311972 -0.000316021"),
    ("0.449798 0.000156 0.00021", "-4.641e-05 -0.000322052 0.000191935"),
    ("0.387894 -0.000175 -0.29766", "-0.000193456 -0.000127947 -0.000191216"),
]
FOUR_MEET = [
    [0.00022331, -0.000137495, 0.000115441, 0.000164134],
    [0.00038918, -0.000197362, 0.000208873, 0.000135575],
    [0.000072635, -0.000124785, 0.000036204, 0.000219211],
    [-0.000020338, 0.000121127, -0.000002405, 0.000013227],
    [-0.000103048, 0.000007116, 0.000077889, 0.000062792],
    [-0.000026925, 0.000071684, 0.000029723, 0.000031506],
    [-0.000047803, 0.000012022, 0.000026212, 0.00009881],
    [0.000006803, 0.000057112, 0.000065052, 0.000021397],
    [0.000003772, 0.000037443, 0.000054702, 0.000047779],
]
"""Stretched: four solutions lie within 1.2e-3 rad, two of them 2.5e-4 apart."""


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.parametrize("language", ["python", "cpp"])
def test_solutions_a_little_apart_are_not_taken_for_one(language: str, tmp_path: Path) -> None:
    tip = ("0.228 0 0", "0 0 0")
    path = serial_urdf(tmp_path / "four.urdf", CALIBRATED, tip=tip, limit=3.2)
    derivation = derive(Request(path))
    arm, runner = arm_of(derivation), runner_of(derivation, language, tmp_path)
    q = np.array(FOUR_MEET)
    sample = SampleSet("four meet", q, arm.oracle.forward(q), arm.sigma(q))
    assert sample.sigma.min() > 3e-5 and sample.sigma.max() < 1e-4
    trial = run_trial(runner, arm, sample, limits=False)
    found = survey(arm, runner, [trial])
    assert not found.missed.any(), found.case(int(np.argmax(found.missed)))
