"""Poses at which an elimination loses its rank altogether, all links of a chain in one plane; and at which
its roots are far from the solutions, as a file rounds what it takes for parallel."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from tests.support.dh_files import dh_file
from tests.support.sampled import in_languages
from tests.support.serial_urdf import serial_urdf

from ikgen.generation.derive import derive
from ikgen.generation.request import Request
from ikgen.verify.completeness import survey
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import run_trial

POSES = 40


@pytest.mark.parametrize(("name", "language"), in_languages(["plane"], []))
def test_none_is_without_a_row_where_all_links_lie_in_one_plane(
    name: str, language: str, tmp_path: Path
) -> None:
    """Four parallel axes behind two that are not: with the second joint at exactly 0 the first axis lies
    in their plane, and two joints more than the pose reads move it there."""
    links = [("0", 0), ("pi/2", 1.1), ("pi/2", 1.1), ("0", 1.1), ("0", 1.1), ("0", 1.1)]
    turned = "[base]\nrpy = [3.141592653589793, -1.5707963267948966, 0]\n"
    tool = "[tool]\nxyz = [1.2, 0, 0]\nrpy = [0, 1.5707963267948966, 0]\n"
    rows = [("revolute", alpha, a, 0, 0) for alpha, a in links]
    derivation = derive(
        Request(dh_file(tmp_path / f"{name}.toml", rows, limit=2.8, ends=turned + tool))
    )
    arm = arm_of(derivation)
    q = arm.uniform(np.random.default_rng(1), POSES)
    q[:, 1] = 0.0
    sample = SampleSet("plane", q, arm.oracle.forward(q), arm.sigma(q))
    assert sample.sigma.max() < 1e-15
    runner = runner_of(derivation, language, tmp_path)
    trial = run_trial(runner, arm, sample, limits=True)
    assert not survey(arm, runner, [trial]).unanswered.any()
    assert (trial.rows.count > 0).all()


OFFSET_WRIST = [
    ("0 0 0.1", "0 0 0"), ("0 0 0", "1.5708 0 0"), ("0 0.35 0", "0 3.14159 0"),
    ("0 0 0", "-1.5708 3.14159 0"), ("0 0.005263 0.305", "1.5708 0 3.14159"), ("0 0 0", "-1.5708 0 0"),
]  # fmt: skip
"""Axes 2 and 3 are 3e-6 rad from parallel."""


def test_rounding_takes_double_roots_far_apart(tmp_path: Path) -> None:
    """Two solutions that nearly meet are roots of an imaginary part of 0.064 rad for the parallel axes."""
    derivation = derive(Request(serial_urdf(tmp_path / "wrist.urdf", OFFSET_WRIST, limit=2.9)))
    arm = arm_of(derivation)
    q = np.array(
        [[-0.195815245, 2.182835712, -2.188854052, 2.819053734, 0.976226554, -1.255587152]]
    )
    sample = SampleSet("fold", q, arm.oracle.forward(q), arm.sigma(q))
    assert 1e-6 < sample.sigma[0] < 1e-5
    runner = runner_of(derivation, "python", tmp_path)
    assert not survey(arm, runner, [run_trial(runner, arm, sample, limits=True)]).missed.any()
