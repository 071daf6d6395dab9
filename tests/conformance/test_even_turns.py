"""Poses with all joints at multiples of 45 degrees, or one of them next to that: solutions meet there, or
are of continua, and where a closed form has none of them they have to be searched."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from numpy.typing import NDArray
from tests.support.dh_files import dh_file
from tests.support.sampled import PYTHON_OFTEN, in_languages
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import FIXTURES

from ikgen.derivation.derive import derive
from ikgen.records.request import Request
from ikgen.verify.completeness import survey
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import run_trial

pytestmark = pytest.mark.usefixtures("solved_once")

R, P = "revolute", "prismatic"
ELBOWS = [
    (R, "pi/2", 0, 0, 0), (R, "pi/2", 0.02, 0, 0), (R, "pi/2", 0.02, -0.33, 0), (R, "pi/2", 0.02, 0, 0),
    (R, "pi/2", 0.02, -0.34, 0), (R, "pi/2", 0, 0, 0), (R, "pi/2", 0.07, 0, 0),
]  # fmt: skip
ON_A_SLIDE = [
    (P, 0, 0, 0, 0), (R, "pi/2", 0.16, 0.2, 0), (R, "pi/2", 0, 0, "pi/2"), (R, 0, 0.28, 0.01, "pi/2"),
    (R, "pi/2", 0, 0.245, "-pi/2"), (R, "pi/2", 0, 0.057, "pi"), (R, "pi/2", 0, 0, "pi/2"),
]  # fmt: skip
ROUNDED = [
    ("0 0 0.187", "0 0 0"), ("0 -0.006 0", "1.5708 -1.5708 0"), ("0.21 0 0", "0 0 -1.5708"),
    ("0 0.2105 0", "-1.5708 0 0"), ("0 0 0", "1.5708 0 0"), ("0 0.1593 0", "-1.5708 0 0"),
]  # fmt: skip
LIMIT = 3.2
"""Rad or m, to either side."""
BESIDE = 1e-7
"""Rad."""


def elbows() -> NDArray[np.float64]:
    """With the second joint and the elbow straight, where the others turn one about another."""
    q = np.random.default_rng(3).integers(-4, 5, (30, 7)) * (pi / 4)
    q[:, (1, 3)] = pi
    return q


def on_a_slide() -> NDArray[np.float64]:
    """Where up to three singular values vanish."""
    turns = [
        [-1, 0, -1, 2, -1, 1], [1, -4, 0, 2, 0, 2], [2, -4, 0, -2, -4, -1], [0, 3, 4, -2, 2, -3],
        [-2, 0, 0, -2, 4, -4], [-2, -4, 4, -2, 1, 2],
    ]  # fmt: skip
    q = np.array(turns) * (pi / 4)
    q[[0, 1, 3, 4, 5], [1, 2, 0, 2, 0]] += [1e-4, -1e-4, BESIDE, BESIDE, BESIDE]
    return np.concatenate([[[0.42], [-0.24], [-0.24], [0.22], [0.03], [-0.16]], q], axis=1)


def stretched() -> NDArray[np.float64]:
    """Upright, the wrist straight: above the first axis."""
    q = np.random.default_rng(5).integers(-4, 5, (40, 6)) * (pi / 4)
    q[:, (1, 2, 4)] = 0.0
    q[20:, 2] = BESIDE
    return q


def arm(name: str, folder: Path) -> tuple[Request, NDArray[np.float64]]:
    """An arm, and configurations at whose poses there was no row."""
    if name == "elbows":
        file = dh_file(folder / "elbows.toml", ELBOWS, limit=LIMIT)
        return Request(file, free={"theta_3": None}), elbows()
    if name == "slide":
        file = dh_file(folder / "slide.toml", ON_A_SLIDE, limit=LIMIT)
        return Request(file, free={"theta_5": None}), on_a_slide()
    return Request(serial_urdf(folder / "rounded.urdf", ROUNDED, limit=LIMIT)), stretched()


@pytest.mark.parametrize(
    ("name", "language"), in_languages(["elbows", "slide", "rounded"], [], ["rounded"])
)
def test_none_is_without_a_row(name: str, language: str, tmp_path: Path) -> None:
    request, q = arm(name, tmp_path)
    derivation = derive(request)
    under = arm_of(derivation)
    sample = SampleSet("even turns", q, under.oracle.forward(q), under.sigma(q))
    assert np.median(sample.sigma) < 1e-4
    runner = runner_of(derivation, language, tmp_path)
    trial = run_trial(runner, under, sample, limits=True)
    lost = np.flatnonzero(survey(under, runner, [trial]).unanswered)
    assert not len(lost), (len(lost), q[lost[0]].tolist())


@PYTHON_OFTEN
def test_last_digits_do_not_decide(language: str, tmp_path: Path) -> None:
    """What an elimination's roots are there hangs on how sums are rounded."""
    request, given = arm("slide", tmp_path)
    derivation = derive(request)
    under, random = arm_of(derivation), np.random.default_rng(0)
    q = np.repeat(given[[1, 2, 5]], 20, axis=0)
    q += random.choice([1e-15, 1e-9], (60, 1)) * random.normal(size=q.shape)
    sample = SampleSet("beside even turns", q, under.oracle.forward(q), under.sigma(q))
    trial = run_trial(runner_of(derivation, language, tmp_path), under, sample, limits=True)
    lost = np.flatnonzero(trial.rows.count == 0)
    assert not len(lost), (len(lost), q[lost[0]].tolist())


@PYTHON_OFTEN
def test_a_double_root_is_found_where_no_elimination_tells_it(
    language: str, tmp_path: Path
) -> None:
    """Two solutions of an offset wrist meet where joint 4 is at 90 degrees and joint 5 is straight."""
    derivation = derive(Request(FIXTURES / "fanuc_crx10ia.urdf"))
    under, random = arm_of(derivation), np.random.default_rng(10)
    q = random.uniform(-3.0, 3.0, (400, 6))
    off = 10.0 ** random.uniform(-9.0, -7.0, (400, 1))
    q[:, 3], q[:, 4] = random.choice([-pi / 2, pi / 2], 400), 0.0
    q += random.normal(scale=off, size=q.shape)
    sample = SampleSet("offset wrists", q, under.oracle.forward(q), under.sigma(q))
    runner = runner_of(derivation, language, tmp_path)
    trial = run_trial(runner, under, sample, limits=False)
    missed = np.flatnonzero(survey(under, runner, [trial]).missed)
    assert not len(missed), (len(missed), q[missed[0]].tolist())
