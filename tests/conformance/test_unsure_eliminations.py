"""Poses at which an elimination loses its rank altogether, all links of a chain in one plane; and at which
its roots are far from the solutions, as a file rounds what it takes for parallel."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from tests.support.dh_files import dh_file
from tests.support.sampled import BOTH, in_languages
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import import_text

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request
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


Q, H = "1.5707963267948966", "3.141592653589793"

NEARLY_FOUR_PARALLEL = (
    ("0 0 0.07", "0 0 0"), ("-0.231 0 0", f"{Q} 0 0"), ("-0.129 0.352 0", f"-{Q} 0 0"),
    ("-0.255 0 0.25", "0 0 0"), ("0.555 0 -0.162", "0 0 0"),
)  # fmt: skip
OFF = [
    (0.001230, 0.298746, -0.274138, -0.890592, -0.454671),
    (0.689404, -0.327213, -0.368576, -0.250195, 1.523529),
    (-0.807367, -0.721515, 0.583305, -0.755515, 0.432780),
    (0.897304, 0.380998, -0.600947, -0.014876, 0.756800),
    (-0.186036, -0.198165, 0.786506, 1.045260, -1.509444),
    (0.619141, -0.334903, 0.498716, -0.890060, -0.361714),
]
"""1e-7 rad: off the second joint at half a turn, where four axes are parallel and move round a curve."""


@BOTH
def test_rows_beside_a_curve_are_found_on_it(language: str, tmp_path: Path) -> None:
    """Where the elimination's roots, and what is nearest to the pose, lie at other places of the curve."""
    tip = ("0.151 0 0", "0 0 0")
    path = serial_urdf(tmp_path / "five.urdf", NEARLY_FOUR_PARALLEL, tip=tip, limit=3.2)
    derivation = derive(Request(path))
    assert derivation.module.plan is not None
    arm = arm_of(derivation)
    q = np.array([-np.pi, -np.pi, 0.5 * np.pi, 0.0, 0.0]) + 1e-7 * np.array(OFF)
    sample = SampleSet("beside a curve", q, arm.oracle.forward(q), arm.sigma(q))
    assert sample.sigma.max() < 1e-12
    trial = run_trial(runner_of(derivation, language, tmp_path), arm, sample, limits=False)
    assert (trial.rows.count > 0).all()
    index, rows, _ = trial.rows.flat()
    position, rotation = arm.task.errors(arm.oracle.forward(rows), sample.poses[index])
    assert max(position.max(), rotation.max()) < 1e-9


BESIDE_A_CONTINUUM = (
    ("-0.141 0 0.318", f"0 -{Q} {Q}"), ("0.102 0 0", f"{Q} 0 0"), ("-0.128 0 0", f"{Q} {Q} {Q}"),
    ("-0.109 0 0", f"{Q} 0 -{Q}"), ("-0.137 0.123 0", "0 0 0"),
)  # fmt: skip

POSES_ON_IT = [
    (
        (-0.74831109780259, -np.pi, 2.36695429734563, 1.73408746177857, 0.5 * np.pi),
        (
            (
                -1.92081648667837,
                2.05788676413409,
                2.42886460298044,
                2.42886460298044,
                2.65450221625059,
            ),
            (
                2.02086061587181,
                1.95095211081817,
                -2.58919917853553,
                0.55239347507425,
                0.38015578402328,
            ),
        ),
    ),
    (
        (2.42365285981732, np.pi, np.pi, 0.0, 0.5 * np.pi),
        (
            (
                -0.54144325514108,
                2.11909833318043,
                2.35336981387606,
                2.35336981387606,
                2.5932906472042,
            ),
        ),
    ),
]
"""Configurations of a continuum, and regular ones of the same pose."""


def test_solutions_beside_a_continuum_are_found_where_the_polynomial_vanishes(
    tmp_path: Path,
) -> None:
    """Its values are rounding there, which has real roots too, and each leads to a solution."""
    axes = ("0 0 1", "-1 0 0", "0 1 0", "1 0 0", "0 -1 0")
    file = serial_urdf(
        tmp_path / "five.urdf",
        BESIDE_A_CONTINUUM,
        axes=axes,
        tip=("0.05 0.02 0.11", "0 0 0"),
        limit=3.2,
    )
    module = derive(Request(file)).module
    assert module.plan is not None and module.plan.parallel is not None
    arm = import_text(emit_module(module), tmp_path)
    for q, others in POSES_ON_IT:
        rows = arm.solve(arm.forward(np.array(q))).q
        for other in others:
            apart = np.abs(np.remainder(rows - other + np.pi, 2.0 * np.pi) - np.pi).max(axis=1)
            assert apart.min() < 1e-9


@BOTH
def test_a_root_without_a_solution_gives_no_row(language: str, tmp_path: Path) -> None:
    """Beside right angles some roots lead to no numbers at all: these are as far off as can be."""
    file = Path(__file__).parents[2] / "urdf_fixtures" / "fanuc_crx10ia.urdf"
    derivation = derive(Request(file))
    arm, random = arm_of(derivation), np.random.default_rng(0)
    straight = (
        np.pi
        / 4
        * np.array([[4, 0, 2, 1, -1, -3], [-1, 0, 2, 2.287, -2.66, -2.735], [-2, 0, 2, 3, -1, -4]])
    )
    q = straight[np.arange(300) % 3]
    q = q + random.normal(size=q.shape) * 10.0 ** random.uniform(-9.5, -8, (300, 1))
    sample = SampleSet("right angles", q, arm.oracle.forward(q), arm.sigma(q))
    trial = run_trial(runner_of(derivation, language, tmp_path), arm, sample, limits=False)
    rows, poses = trial.rows.q, sample.poses
    for pose, found, count in zip(poses, rows, trial.rows.count, strict=True):
        assert count
        assert np.abs(arm.oracle.forward(found[:count]) - pose).max() < 1e-9
