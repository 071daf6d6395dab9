"""Poses where solutions meet, or nearly do: none is lost, and C++ and Python have the same."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from math import pi
from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from numpy.typing import NDArray
from tests.support.sampled import in_languages, sampled
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import FIXTURES, NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.records.request import Request
from ikgen.verify.agreement import disagreements
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.completeness import survey
from ikgen.verify.runners.runner import Runner
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import nearest, run_trial

Array = NDArray[np.float64]

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or ""),
]

ARMS = ("ur5e", "doosan_m1013", "fanuc_crx10ia", "measured")
"""A continuum at the wrist, one that a file with offsets breaks into isolated solutions, an elimination;
ur5e with short offsets, whose quartic divides by them."""
COMPILED = ("doosan_m1013",)
"""Those whose header is compiled in every run; that of ur5e is in test_cpp.py too."""
SEEDED = [
    pytest.param(seeded, *case.values, marks=case.marks)
    for seeded, compiled in ((False, ()), (True, COMPILED))
    for case in in_languages(ARMS, compiled)
]
"""Whether there is a seed, arms and languages; headers have one in every run."""

MEASURED = {
    'xyz="-0.425 0 0"': 'xyz="-0.425628 -0.001152 0.000346"',
    'xyz="-0.3922 0 0.1333"': 'xyz="-0.39274 -0.001065 0.133624"',
    'xyz="0 -0.0997 -2.044881182297852e-11"': 'xyz="0.000654 -0.101177 0.000203"',
    'xyz="0 0.0996 -2.042830148012698e-11"': 'xyz="0.000808 0.098437 -0.000222"',
}

FOLDS = {
    "ur5e": [
        [-0.75 * pi, 0.0, 0.25 * pi, -0.75 * pi, -pi, -0.75 * pi],
        [-2.35, 0.4, 1e-4, -2.2, -2.9, -2.4],
        [-2.35, 0.4, -1e-4, -2.2, -2.9, -2.4],
        [2.8924685876503107, 2.9751769627630787, 0.9650107445478333, -2.5947716037, 2.6e-11, 1.49624],
    ],
    "doosan_m1013": [
        [0.5 * pi, 0.0, 0.0, 0.75 * pi, 0.0, 0.5 * pi],
        [1.6046566726690148, -2.0223269709953118, -2.28257596917011, -2.28909350703481, 1.2395e-4, -1.67],
        [-1.8760487350474973, -0.70900730592372, 1.59490233520665, -2.616762032884825, -2.6469e-5, 1.17],
    ],
    "measured": [
        [-0.75111895356, 2.1392537001188, -0.0346364609224, -0.3406335186724, -3.1415694472653, 1.36992],
        [1.29432046434, -1.8553812662845, -1.8049986261997, 1.7542030052082, -3.1415926162556, -2.39467],
        [-1.0654692642, 2.9360229593098, -1.7090559467926, -0.6971556704367, 3.14159265962702, -1.43321],
        [-1.0654691541, 2.9360228924123, -1.7090559217721, -0.6971558429400, 3.14159298898566, -1.43321],
        [0.3, -1.2, 1.4, -0.5, 1e-6, 0.7],
    ],
    "fanuc_crx10ia": [
        [-0.8402492929786658, -0.8327335483597, -0.0382845655676, 1.20801285863, 2.0957160413791, 0.64361],
        [
            -3.4467085546520425e-08, 2.3561946011689714, -5.4803318773353647e-08, -1.5707963189834826,
            -1.5707963485537608, -3.0031311422875451e-08,
        ],
        [
            -2.242293971516979, 0.78539803713561596, 3.141592677878728, 1.5707960793300157,
            1.5707964309507703, 3.9269906865462993,
        ],
        [
            -0.78539801789343688, 2.35619447957618, -3.1464459148592681e-07, -1.5707963931098576,
            1.570796252513978, -2.3561944836978346,
        ],
    ],
}  # fmt: skip
"""Configurations whose rows were once lost, or whose poses were not answered at all."""
BROKEN = [
    [-2.31700465461, 0.95856555996, -2.07848037404, 0.44496802397, 3.624271174e-4, 1.20277422],
    [-2.05400796922, 1.98194811986, 2.529082074551, 2.29050262631, 2.779734131e-5, 1.18474487],
    [-1.05973731496, -1.0055438335, 2.160463692485, 0.01819697479, 3.446376335e-5, -2.48936046],
    [-2.06148095647, -1.0564914756, 2.415564737814, -2.5238615926, -1.47082460e-4, -2.41890059],
    [0.66629416143965714, 2.4036006802125622, 1.76468305048577, -1.69177889886, -1.91622244e-5, -0.442814],
    [-1.2093058268383308, -0.47313019457992789, 1.00156464297913, 2.08747833688, -0.01013708657, -0.852148],
    [-0.90387735090401622, 0.61241593024322249, 2.2707206313224, 1.389358801715, 3.531673328e-6, 2.611432],
    [1.0256218073857359, 0.053994252862192137, 1.997232761418148, 1.40866154066, -3.36040826e-8, 2.608357],
    [0.811963783173784, -2.1892945920965663, -2.079161854537135, 0.117618272019, 3.033244637e-4, -2.22167],
    [1.135175370354121, -1.006482516345782, 2.216517862575349, -0.81163860851, -1.3043120554e-4, -1.83462],
    [1.2140510198582015, 1.033382937402007, -2.321490118624171, 0.18397602284, -3.0494033715e-4, -0.27745],
    [-0.590500131063263, 2.060901093680585, 2.401168166972753, -0.05007175476, 2.2749814262e-4, 1.297591],
    [2.5545962166124963, -0.928810123198353, 2.019686290840828, 2.10345398257, -0.0159033624361, -1.298454],
    [0.720389492356002, -1.941330482005393, 1.347765903154194, -0.205976223399, -6.0454075472e-6, 2.615905],
    [0.897133311080887, -2.514586545367363, -1.38945248945989, 1.627222891296, -5.404242746e-7, 0.3538144],
]  # fmt: skip
"""Of doosan_m1013: two solutions meet far from all rows that start from the closed form's."""


DIGITS = [
    ("0 0 0.123", "0 0 0"), ("0 0 0", "1.5708 -0.1359 -3.1416"), ("0.28503 0 0", "0 0 -1.7939"),
    ("-0.021984 -0.25075 0", "1.5708 0 0"), ("0 0 0", "-1.5708 0 0"), ("0 -0.091 0", "1.5708 0 0"),
]  # fmt: skip
"""A spherical wrist of five digits: origins of its joints."""
CROSSING = [
    0.71254153598584924, 0.36090978463110718, -0.09039248308837429, 0.95217906786908091,
    0.0080602407803691111, -0.60040183569898875,
]  # fmt: skip
"""Of that arm: its shoulder's continuum and its wrist's cross near it; rows start on one of them."""
OFFSET_WRIST = [
    ("0 0 0", "0 0 0"), ("0 0 0", "1.5708 0 0"), ("0 0.350 0", "0 3.14159 0"),
    ("0 0 0", "-1.5708 3.14159 0"), ("0 0.005263 0.305", "1.5708 0 3.14159"), ("0 0 0", "-1.5708 0 0"),
]  # fmt: skip
"""Axes 2 and 3 parallel but for rounding, which makes real roots of the elimination complex."""
SPLIT = [
    [
        2.2895252034364,
        1.2609804270047742,
        -1.239369193829827,
        -1.035813521442566,
        -0.004894098,
        0.524155,
    ],
    [
        -1.8607306980890808,
        2.0629663470185085,
        -2.59897556665991,
        2.499138387816748,
        -0.593451262,
        -0.548892,
    ],
    [
        0.696744942030947,
        -1.3786355823003311,
        2.3713593645100803,
        0.711279624879338,
        0.0171215263,
        2.727583,
    ],
]


@dataclass(frozen=True)
class Made:
    """One arm in both languages, and configurations whose rows meet, or nearly do."""

    q: Array
    arm: ArmUnderTest
    python: Runner
    header: Callable[[], Runner]

    @property
    def sample(self) -> SampleSet:
        poses = self.arm.oracle.forward(self.q)
        return SampleSet("folds", self.q, poses, self.arm.sigma(self.q))

    @property
    def cpp(self) -> Runner:
        """Compiled where it is asked for first."""
        return self.header()


@pytest.fixture(scope="module")
def made_once(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Made]:
    return cache(lambda name: make(name, tmp_path_factory.mktemp(name)))


@pytest.fixture
def made(request: pytest.FixtureRequest, made_once: Callable[[str], Made]) -> Made:
    return made_once(request.param)


def make(name: str, folder: Path) -> Made:
    derivation = derive(Request(measured(folder) if name == "measured" else robot(name)))
    python = runner_of(derivation, "python", folder)
    cpp = cache(lambda: runner_of(derivation, "cpp", folder))
    arm = arm_of(derivation)
    q = np.vstack([FOLDS[name], np.clip(special(120), arm.lower, arm.upper)])
    return Made(q, arm, python, cpp)


@pytest.mark.long
def test_roots_that_rounding_made_complex_are_found(tmp_path: Path) -> None:
    derivation = derive(Request(serial_urdf(tmp_path / "wrist.urdf", OFFSET_WRIST)))
    arm, q = arm_of(derivation), np.array(SPLIT)
    sample = SampleSet("split", q, arm.oracle.forward(q), arm.sigma(q))
    for language in ("python", "cpp"):
        runner = runner_of(derivation, language, tmp_path)
        found = survey(arm, runner, [run_trial(runner, arm, sample, limits=False)])
        assert not found.missed.any(), language


@pytest.mark.long
def test_continua_that_cross_are_followed_from_what_is_found_between_them(tmp_path: Path) -> None:
    derivation = derive(Request(serial_urdf(tmp_path / "digits.urdf", DIGITS)))
    runner = runner_of(derivation, "cpp", tmp_path)
    q = np.array([CROSSING])
    rows = runner.solve_many(runner.forward(q), limits=False)
    assert nearest(arm_of(derivation), q[:, None], rows.q).max() < 1e-6


def robot(name: str) -> Path:
    return FIXTURES / f"{name}.urdf"


def measured(folder: Path) -> Path:
    text = robot("ur5e").read_text()
    for before, after in MEASURED.items():
        assert before in text
        text = text.replace(before, after)
    path = folder / "measured.urdf"
    path.write_text(text)
    return path


def special(count: int) -> Array:
    """Configurations (count, 6) with all joints at multiples of 45 degrees, every other one beside."""
    random = np.random.default_rng(4)
    q = random.integers(-4, 5, (count, 6)) * pi / 4
    beside = 10.0 ** -random.uniform(1.0, 10.0, (count, 1)) * random.normal(size=(count, 6))
    q[1::2] += beside[1::2]
    return np.asarray(q)


@pytest.mark.parametrize(("seeded", "made", "language"), SEEDED, indirect=["made"])
def test_nothing_is_lost(made: Made, language: str, seeded: bool) -> None:
    runner: Runner = getattr(made, language)
    trial = run_trial(runner, made.arm, made.sample, limits=False, seeded=seeded)
    found = survey(made.arm, runner, [trial])
    lost = np.flatnonzero(found.missed | found.unanswered)
    assert not len(lost), found.case(int(lost[0]))


@pytest.mark.parametrize("made", ["doosan_m1013"], indirect=True)
@pytest.mark.parametrize("language", ["python", "cpp"])
def test_none_is_lost_where_two_meet_along_a_broken_continuum(made: Made, language: str) -> None:
    lost, runner = replace(made, q=np.array(BROKEN)), getattr(made, language)
    trial = run_trial(runner, made.arm, lost.sample, limits=False)
    found = survey(made.arm, runner, [trial])
    assert not (found.missed | found.unanswered).any(), found.case(0)


@pytest.mark.parametrize("made", sampled(ARMS, COMPILED), indirect=True)
def test_rows_are_the_same_in_both_languages_and_in_batches(made: Made) -> None:
    poses = made.sample.poses
    python, cpp = (runner.solve_many(poses, limits=False) for runner in (made.python, made.cpp))
    batch = made.python.solve_batch(poses, limits=False)
    assert batch is not None
    for other in (cpp, batch):
        wrong, compared, _ = disagreements(made.arm, python, other)
        assert compared.sum() > 60 and not wrong.any(), (other is cpp, np.flatnonzero(wrong))
