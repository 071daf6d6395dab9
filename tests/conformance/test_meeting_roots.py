"""Solutions whose roots nearly meet those of others."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
from benchmarks.agreement import arm_of, runner_of
from tests.support.sampled import PYTHON_OFTEN
from tests.support.serial_urdf import serial_urdf

from ikgen.derivation.derive import derive
from ikgen.records.request import Request
from ikgen.verify.completeness import survey
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import run_trial

ON_A_RAIL = [
    ("-0.06 0 0", f"0 0 {-pi / 2}"), ("0.075 0 -0.268", "0 0 0"), ("0.282 0 0", f"{pi / 2} 0 0"),
    ("-0.229 0.242 0", f"{-pi / 2} 0 0"), ("0.219 0 0", "0 0 0"), ("0 -0.354 0", f"{pi / 2} 0 0"),
]  # fmt: skip
SLIDE_IN_THE_FOREARM = [
    ("0 0 -0.254", "0 0 0"), ("-0.106 0.09 0", f"{pi / 2} 0 0"), ("-0.255 -0.385 0", f"{pi / 2} 0 0"),
    ("0.152 0 0", f"{-pi / 2} 0 0"), ("0 -0.362 0", f"{-pi / 2} 0 0"), ("-0.321 0.181 0", f"{pi / 2} 0 0"),
]  # fmt: skip
OFF_THE_WRIST = [
    ("0 0 0.1", "0 0 0"), ("0 0 0", "0 0 0"), ("0.04 0 0.11", "0 0 0"), ("0.16 0 0", "0 0 0"),
    ("0.03 0 0", "0 0 0"),
]  # fmt: skip


@PYTHON_OFTEN
def test_a_direction_is_told_that_the_digits_of_a_double_root_leave(
    language: str, tmp_path: Path
) -> None:
    """Joint 1 nearly straight, its direction 1e-5 to 9e-5 long, where a quartic has nearly double roots."""
    robot = serial_urdf(
        tmp_path / "slide.urdf", SLIDE_IN_THE_FOREARM, slides={3: "0 0 1"}, limit=3.3
    )
    derivation = derive(Request(robot))
    under, random = arm_of(derivation), np.random.default_rng(0)
    q = np.array([pi, pi, pi, -0.2, -pi, -pi / 2]) + 1e-4 * random.normal(size=(100, 6))
    q[:, 1] = pi + random.choice([-1e-5, 1e-5], 100) * random.uniform(1.0, 9.0, 100)
    sample = SampleSet("double roots", q, under.oracle.forward(q), under.sigma(q))
    trial = run_trial(runner_of(derivation, language, tmp_path), under, sample, limits=True)
    gaps = np.abs(under.difference(trial.rows.q, q[:, None])).max(axis=2)
    missed = np.flatnonzero(np.nanmin(gaps, axis=1) > 1e-3)
    assert not len(missed), (len(missed), q[missed[0]].tolist())


@PYTHON_OFTEN
def test_a_pose_is_answered_where_roots_that_nearly_meet_leave_few_digits_of_a_divisor(
    language: str, tmp_path: Path
) -> None:
    """Of a table top arm with its tool 2 mm off the wrist, its quartic's roots times 600: the divisor,
    1e-4, is just not small enough to be told, and no row is within 1e-3 before steps are taken."""
    robot = serial_urdf(
        tmp_path / "table_top.urdf", OFF_THE_WRIST, tip=("0.09 -0.0016 0", "0 0 0"),
        axes=["0 0 1", "0 1 0", "0 1 0", "0 1 0", "1 0 0"], limit=3.3,
    )  # fmt: skip
    derivation = derive(Request(robot))
    under, random = arm_of(derivation), np.random.default_rng(0)
    q = random.uniform(-3.0, 3.0, (1000, 5))
    q[:, 4] = random.choice([-1, 1], 1000) * (pi / 2 + random.uniform(0.9e-4, 1.2e-4, 1000))
    sample = SampleSet("roots that meet", q, under.oracle.forward(q), under.sigma(q))
    trial = run_trial(runner_of(derivation, language, tmp_path), under, sample, limits=True)
    nothing = np.flatnonzero(trial.rows.count == 0)
    assert not len(nothing), (len(nothing), q[nothing[0]].tolist())


@PYTHON_OFTEN
def test_none_is_lost_where_one_elimination_misses_it_twice(language: str, tmp_path: Path) -> None:
    robot = serial_urdf(tmp_path / "rail.urdf", ON_A_RAIL, slides={0: "0 0 1"}, limit=3.3)
    derivation = derive(Request(robot))
    under, random = arm_of(derivation), np.random.default_rng(0)
    q = np.array([-0.1, 0.0, pi / 2, pi, 0.0, pi]) + 3e-7 * random.normal(size=(100, 6))
    sample = SampleSet("roots that meet", q, under.oracle.forward(q), under.sigma(q))
    assert sample.sigma.min() > 0.04
    runner = runner_of(derivation, language, tmp_path)
    trial = run_trial(runner, under, sample, limits=True)
    missed = np.flatnonzero(survey(under, runner, [trial]).missed)
    assert not len(missed), (len(missed), q[missed[0]].tolist())
    assert set(trial.rows.count.tolist()) == {6}
