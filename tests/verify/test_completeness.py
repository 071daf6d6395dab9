"""Generating configurations are looked for at every pose, however singular, and counted by that."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.fake_arms import six_axis_module, six_axis_oracle

from ikgen.tasks import find_task
from ikgen.verify import completeness
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.completeness import FAILS_ABOVE, sensitivity, survey
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.runners.runner import Rows, Stack
from ikgen.verify.sampling import SampleSet
from ikgen.verify.search import converge
from ikgen.verify.task_space import task_space
from ikgen.verify.trials import Trial, run_trial
from ikgen.verify.verification import verify

Array = NDArray[np.float64]
STRETCHED = np.array([0.3, 0.5, 0.0, 0.4, 0.6, -1.0])  # a fold
ALIGNED = np.array([0.3, 0.5, 0.7, 0.4, 0.0, -1.0])  # a continuum


class Forgetful(PythonModule):
    """Loses the rows of poses with its wrist or its elbow nearly straight; all of them or those alone."""

    within = 1e-4
    everything = False

    def solve_stacks(self, stacks: Sequence[Stack]) -> list[Rows]:
        return [self._left(rows) for rows in super().solve_stacks(stacks)]

    def _left(self, rows: Rows) -> Rows:
        straight = (np.abs(np.sin(rows.q[:, :, [2, 4]])) < self.within).any(axis=2)
        drop = straight.any(axis=1)[:, None] if self.everything else straight
        keep = ~(drop | np.isnan(rows.q).any(axis=2))
        order = np.argsort(~keep, axis=1, kind="stable")
        q = np.take_along_axis(
            np.where(keep[:, :, None], rows.q, np.nan), order[:, :, None], axis=1
        )
        flags = np.take_along_axis(rows.singular & keep, order, axis=1)
        count = keep.sum(axis=1)
        status = tuple("OK" if n else "UNREACHABLE" for n in count)
        return Rows(q, count, status, flags)


def arm() -> ArmUnderTest:
    """The six-axis arm, its whole pose."""
    free = np.full(6, np.inf)
    return arm_under_test(six_axis_oracle(), task_space(find_task("pose")), (-free, free), ())


def sample_of(a: ArmUnderTest, *q: Array) -> SampleSet:
    rows = np.array(q)
    return SampleSet("some", rows, a.oracle.forward(rows), a.sigma(rows))


def answered(a: ArmUnderTest, sample: SampleSet, rows: Array) -> Trial:
    """Each pose of the sample answered with one row of `rows` (N, dof)."""
    n = len(rows)
    given = Rows(rows[:, None], np.ones(n, int), ("OK",) * n, np.zeros((n, 1), bool))
    return Trial(sample, given, False, False)


def test_a_right_module_misses_nothing_at_any_singular_value(tmp_path: Path) -> None:
    report = verify(six_axis_module(tmp_path), six_axis_oracle(), samples=160)
    assert all(band.poses > 10 for band in report.bands)
    assert [(b.missed, b.loose, b.unanswered) for b in report.bands] == [(0, 0, 0)] * 4
    assert report.missed == 0


@pytest.mark.parametrize("everything", [False, True])
def test_what_is_missed_near_singularities_is_counted(tmp_path: Path, everything: bool) -> None:
    runner = Forgetful(six_axis_module(tmp_path).path)
    runner.everything = everything
    report = verify(runner, six_axis_oracle(), samples=160)
    regular, *near = report.bands
    assert regular.missed == 0 and all(band.missed > 0 for band in near[1:])
    assert not everything or all(band.unanswered == band.missed for band in near)
    assert report.check("completeness").passed and report.check("poses answered").passed
    assert report.missed >= sum(band.missed for band in near)
    assert "q = [" in near[-1].case and "pose = [" in near[-1].case
    assert f"{sum(b.missed for b in near)} of {sum(b.poses for b in near)} below 1e-03" in (
        report.check("completeness").detail
    )


def test_the_threshold_decides_what_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    runner = Forgetful(six_axis_module(tmp_path).path)
    runner.everything = True
    monkeypatch.setattr(completeness, "FAILS_ABOVE", 1e-12)
    report = verify(runner, six_axis_oracle(), samples=100)
    assert not report.check("completeness").passed
    assert not report.check("poses answered").passed
    assert "q = [" in report.check("poses answered").worst_case


def test_misses_above_the_threshold_fail(tmp_path: Path) -> None:
    runner = Forgetful(six_axis_module(tmp_path).path)
    runner.within = 0.3
    report = verify(runner, six_axis_oracle(), samples=100)
    assert not report.check("completeness").passed
    missed = sum(band.missed for band in report.bands if band.low >= completeness.FAILS_ABOVE)
    assert missed == report.check("completeness").failures > 0


def test_a_fold_bounds_the_distance_and_a_continuum_does_not() -> None:
    a = arm()
    fold, continuum = (sensitivity(a, q[None]) for q in (STRETCHED, ALIGNED))
    assert max(fold.sigma[0], continuum.sigma[0]) < 1e-12
    assert fold.kappa[0] > 0.01 and continuum.kappa[0] < 1e-4
    assert fold.within(1e-13)[0] < 1e-5
    assert continuum.within(1e-13)[0] > 1e-3


def test_a_singular_value_of_minus_zero_bounds_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """As LAPACK gives it at configurations that are singular to the last bit."""
    svd = np.linalg.svd

    def signed(*arguments: Any, **options: Any) -> Any:
        u, s, vt = svd(*arguments, **options)
        return u, np.where(s < 1e-9, -0.0, s), vt

    monkeypatch.setattr(np.linalg, "svd", signed)
    assert sensitivity(arm(), ALIGNED[None]).within(1e-13)[0] > 1e-3


def test_the_distance_follows_the_singular_value() -> None:
    a = arm()
    q = np.repeat(ALIGNED[None], 3, axis=0)
    q[:, 4] = (1e-2, 1e-6, 1e-9)
    near = sensitivity(a, q).within(1e-13)
    assert near[0] < 1.1e-6 < near[1] < 1e-5 < near[2] < 1e-2


def test_a_row_with_a_closure_error_is_loose_and_another_solution_is_missed() -> None:
    """A row 1e-5 off a fold changes the pose by some 1e-11, which explains the distance; the partner of a
    configuration 2e-5 beside the fold is as near, but reproduces the pose."""
    a = arm()
    null = np.linalg.svd(a.scaled_jacobian(STRETCHED[None])[1])[2][0, -1]
    at_fold, beside = STRETCHED, STRETCHED + 2e-5 * null
    sample = sample_of(a, at_fold, beside)
    partner, reached = converge(a, (STRETCHED - 2e-5 * null)[None], sample.poses[1:])
    assert reached[0] and np.abs(partner[0] - beside).max() > 1e-5
    found = survey(a, None, [answered(a, sample, np.array([at_fold + 1e-5 * null, partner[0]]))])  # type: ignore[arg-type]
    assert found.loose.tolist() == [True, False]
    assert found.missed.tolist() == [False, True]


def test_rows_of_a_continuum_are_asked_for_again_with_a_seed(tmp_path: Path) -> None:
    a, runner = arm(), six_axis_module(tmp_path)
    trial = run_trial(runner, a, sample_of(a, ALIGNED), limits=False)
    nearest = np.nanmin(np.abs(a.difference(trial.rows.q[0], ALIGNED)).max(axis=1))
    assert trial.rows.singular.any() and nearest > 0.1
    assert not survey(a, runner, [trial]).missed.any()
    unflagged = replace(
        trial, rows=replace(trial.rows, singular=np.zeros_like(trial.rows.singular))
    )
    assert survey(a, runner, [unflagged]).missed.all()


def test_no_row_is_a_miss_and_unanswered() -> None:
    a = arm()
    sample = sample_of(a, ALIGNED + 0.1)
    none = Rows(
        np.full((1, 8, 6), np.nan), np.zeros(1, int), ("UNREACHABLE",), np.zeros((1, 8), bool)
    )
    found = survey(a, None, [Trial(sample, none, True, False)])  # type: ignore[arg-type]
    assert found.missed.all() and found.unanswered.all() and found.sigma[0] > FAILS_ABOVE
    assert not completeness.check_answered(found).passed
    assert not completeness.check_completeness(found).passed


def test_tolerances_on_slides_are_relative_to_their_values() -> None:
    slides = replace(arm(), revolute=np.array([False, *[True] * 5]))
    a, b = np.zeros((1, 6)), np.zeros((1, 6))
    a[0, 0], b[0, 0] = 1e7, 1e7 + 1e-3
    assert slides.distance(a, b)[0] < 1e-9
    assert slides.distance(a - a, b - a)[0] == pytest.approx(1e-3)
    assert slides.size_of(a)[0] == 1e7
    assert arm().distance(a, b)[0] > 1e-4


@pytest.mark.parametrize(
    ("values", "alone"),
    [((3.0, 0.5, 1e-9), True), ((3.0, 1e-7, 1e-9), False), ((0.5, 0.4, 0.3), True)],
)
def test_how_a_singular_value_turns_is_known_where_it_is_the_only_small_one(
    values: tuple[float, ...], alone: bool
) -> None:
    """Of a matrix whose last entry is the joint's value: its derivative along the last joint is 1."""

    def jacobian(q: Array) -> tuple[None, Array]:
        J = np.tile(np.diag(values), (len(q), 1, 1))
        J[:, 2, 2] += q[:, 2]
        return None, J

    made = SimpleNamespace(
        active=(0, 1, 2), rank=3, revolute=np.ones(3, bool), length=1.0, scaled_jacobian=jacobian
    )
    found = sensitivity(made, np.zeros((2, 3)))  # type: ignore[arg-type]
    assert found.sigma == pytest.approx([values[2]] * 2)
    assert found.kappa == pytest.approx([1.0 if alone else 0.0] * 2, rel=1e-4)


def test_every_pose_is_in_one_band() -> None:
    sigma = np.array([0.0, *completeness.BAND_EDGES, 0.5 * completeness.BAND_EDGES[0], 1.0, 7.0])
    count, none = len(sigma), np.zeros(len(sigma), dtype=bool)
    where = np.zeros(count, dtype=int)
    loose = none.copy()
    loose[0] = True
    made = completeness.Survey((), where, where, sigma, sigma, none, loose, ~none, 1e-3)
    bands = made.bands
    assert sum(band.poses for band in bands) == sum(band.unanswered for band in bands) == count
    assert [band.low for band in bands] == [*completeness.BAND_EDGES, 0.0]
    assert bands[-1].poses == 1 and bands[-1].loose == 1 == sum(band.loose for band in bands)
    assert not any(band.missed or band.case for band in bands)
