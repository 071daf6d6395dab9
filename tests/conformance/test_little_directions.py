"""Right-angled arms with two slides where little is left of what an unknown follows from."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from benchmarks.random_tables import Drawn, pattern, random_table, table_text
from tests.support.both_languages import header_of
from tests.support.dh_files import Row, dh_file
from tests.support.sampled import BOTH, PYTHON_OFTEN
from tests.support.solving import NO_COMPILER, import_text, solver_module

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.model.arrays import Array
from ikgen.records.request import Request
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.runners.runner import Rows
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import run_trial

UP, DOWN = "pi/2", "-pi/2"
TURN, SLIDE = "revolute", "prismatic"

DIVIDED_BY_A_COSINE: list[Row] = [
    (TURN, 0.0, 0.0, 0.0, 0.0), (TURN, DOWN, 0.33, 0.0, 0.0), (SLIDE, DOWN, 0.0, 0.0, DOWN),
    (SLIDE, DOWN, 0.57, 0.0, 0.0), (TURN, 0.0, 0.0, 0.59, 0.0), (TURN, DOWN, 0.57, 0.99, 0.0),
]  # fmt: skip
DIVIDED_BY_ITS_SQUARE: list[Row] = [
    (TURN, 0.0, 0.0, 0.0, 0.0), (SLIDE, UP, 0.74, 0.0, UP), (SLIDE, UP, 0.39, 0.0, 0.0),
    (TURN, UP, 0.0, 0.0, 0.0), (TURN, DOWN, 0.38, 0.0, 0.0), (TURN, UP, 0.57, 0.51, 0.0),
]  # fmt: skip
LAST_SLIDE_ALONG_THE_FIRST_AXIS: list[Row] = [
    (TURN, 0.0, 0.0, 0.0, 0.0), (TURN, 0.0, 0.94, 0.97, 0.0), (SLIDE, 0.0, 0.81, 0.0, 0.0),
    (TURN, UP, 0.38, 0.84, 0.0), (TURN, DOWN, 0.73, 0.71, 0.0), (SLIDE, DOWN, 0.48, 0.0, 0.0),
]  # fmt: skip
FOUR_THAT_MEET: list[Row] = [
    (TURN, 0.0, 0.0, 0.0, 0.0), (SLIDE, 0.0, 0.0, 0.0, 0.0), (TURN, DOWN, 0.0, 0.0, 0.0),
    (TURN, DOWN, 0.6682154567911516, 0.0, 0.0), (TURN, DOWN, 0.5841310041957618, 0.0, 0.0),
    (SLIDE, 0.0, 0.42282542686903757, 0.0, UP),
]  # fmt: skip
MEETING = [
    [1.5706749488577, -0.0999137189699, -0.00010586839, 2.1690331e-05, 1.5708965103363, -0.1000157212231],
    [-1.5707918833196, -1.73189481e-05, 3.14157259359, -4.12789364e-06, 1.5708108856085, -1.25765129e-05],
]  # fmt: skip
LOST = np.array(
    [[-2.8942425e-08, 4.8632856e-09, -5.936e-08, -5.8695558e-08, -5.9862056e-08, -8.5704e-10]]
)
AT_A_CURVE = [
    2.1764315431417565, -0.06920485406483609, -1.5707963279616897, 3.1415926531879905, -1.5707963270419494,
    -1.8607643449666769,
]  # fmt: skip
BESIDE_A_CONTINUUM: list[Row] = [
    (TURN, 0.0, 0.0, 0.39, 0.0), (TURN, DOWN, 0.85, 0.88, 0.0), (TURN, UP, 1.0, 0.94, 0.0),
    (SLIDE, DOWN, 0.62, 0.0, DOWN), (TURN, DOWN, 0.0, 0.0, 0.0), (SLIDE, 0.0, 0.86, 0.0, 0.0),
]  # fmt: skip


def answered(
    rows: list[Row], q: Array, language: str, folder: Path
) -> tuple[ArmUnderTest, Array, Rows]:
    """The arm, the smallest singular values at configurations (N, dof), and what it answers to them."""
    derivation = derive(Request(dh_file(folder / "arm.toml", rows)))
    under = arm_of(derivation)
    sample = SampleSet("little left", q, under.oracle.forward(q), under.sigma(q))
    trial = run_trial(runner_of(derivation, language, folder), under, sample, limits=True)
    return under, sample.sigma, trial.rows


def copies(at: list[float], noise: float) -> Array:
    """A hundred configurations beside one."""
    off = np.random.default_rng(0).normal(size=(100, len(at)))
    return np.asarray(np.array(at) + noise * off)


@PYTHON_OFTEN
@pytest.mark.parametrize(
    ("rows", "at", "noise", "regular"),
    [
        (DIVIDED_BY_A_COSINE, [pi / 2, 0.0, -0.1, 0.3, -pi / 2, 0.0], 4e-5, 5e-6),
        (DIVIDED_BY_ITS_SQUARE, [pi / 2, 0.3, 0.3, pi / 2, 0.0, -pi / 2], 3e-6, 1e-6),
    ],
)
def test_no_regular_row_is_lost(
    rows: list[Row], at: list[float], noise: float, regular: float, language: str, tmp_path: Path
) -> None:
    q = copies(at, noise)
    under, sigma, found = answered(rows, q, language, tmp_path)
    gap = np.nanmin(np.abs(under.difference(found.q, q[:, None])).max(axis=2), axis=1)
    assert (sigma > regular).sum() > 50
    lost = np.flatnonzero((sigma > regular) & ~(gap < 1e-3))
    assert not len(lost), (len(lost), q[lost[0]].tolist())


@PYTHON_OFTEN
def test_four_rows_that_meet_are_found(language: str, tmp_path: Path) -> None:
    """The roots of one elimination are off by the fourth root of round-off, and lead to two of them."""
    q = np.array(MEETING)
    _, _, found = answered(FOUR_THAT_MEET, q, language, tmp_path)
    assert found.count.tolist() == [4, 4]
    assert (np.nanmin(np.abs(found.q - q[:, None]).max(axis=2), axis=1) < 1e-6).all()


@BOTH
def test_a_slide_that_nearly_goes_along_the_first_axis_is_found(
    language: str, tmp_path: Path
) -> None:
    """The quadratic's leading coefficient is the square of what it is off: 1e-14 beside 1."""
    q = copies([pi / 2, 0.5, -0.1, -pi / 2, -pi / 2, -1.4], 1e-7)
    _, _, found = answered(LAST_SLIDE_ALONG_THE_FIRST_AXIS, q, language, tmp_path)
    assert (found.count > 0).all(), q[np.flatnonzero(found.count == 0)[0]].tolist()


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
def test_undamped_steps_lead_where_two_directions_are_nearly_lost(tmp_path: Path) -> None:
    """The closed form's row is off by 0.04 rad along a direction that hardly moves the pose."""
    random = np.random.default_rng(51)
    dh = [random_table(random, Drawn(6, 6, 2)) for _ in range(17)][-1]
    assert pattern(dh) == "P|aR|aP|aR|aRd|oRd"
    module = solver_module(dh)
    arm = import_text(emit_module(module), tmp_path)
    poses = arm.forward(np.array([-0.1, 1.54075, 0.0, 0.0, -pi / 2, -0.5844133]) + LOST)
    assert (arm.solve_batch(poses)[1] > 0).all()
    assert (header_of(module, tmp_path).solve_many(poses).count > 0).all()


@PYTHON_OFTEN
def test_rows_of_an_elimination_are_right_as_the_arm_counts_errors(
    language: str, tmp_path: Path
) -> None:
    """Along a curve rows are off by 8e-10 m, less than half a nanometre in lengths of 1.8 m."""
    random = np.random.default_rng(51)
    dh = [random_table(random, Drawn(6, 6, 2)) for _ in range(28)][-1]
    table = tmp_path / "arm.toml"
    table.write_text(table_text(dh, "arm"))
    derivation = derive(Request(table))
    poses = arm_of(derivation).oracle.forward(np.array([AT_A_CURVE]))
    found = runner_of(derivation, language, tmp_path).solve_many(poses)
    assert (found.count > 0).all()


@PYTHON_OFTEN
@pytest.mark.parametrize("noise", [0.0, 1e-12, 1e-9])
def test_samples_of_a_continuum_do_not_stand_for_the_rows_beside_it(
    noise: float, language: str, tmp_path: Path
) -> None:
    """Where every angle is a root, those of other solutions are none that stand out."""
    q = np.concatenate(
        [
            copies([-pi / 2, pi, pi, 0.3, 0.0, 0.1], noise),
            copies([pi, 0.0, -pi / 2, 0.3, pi, 0.0], noise),
        ]
    )
    under, _, found = answered(BESIDE_A_CONTINUUM, q, language, tmp_path)
    there = ~np.isnan(found.q[..., 0])
    regular = np.zeros(there.shape, dtype=bool)
    regular[there] = under.sigma(found.q[there]) > 0.01
    assert (regular.sum(axis=1) == 2).all(), regular.sum(axis=1).tolist()
