"""Checks of returned rows on rows made by hand: what counts, what is told of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.fake_arms import six_axis_oracle, six_axis_urdf, tree_of

from ikgen.tasks import find_task
from ikgen.verify.agreement import disagreements
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.checks import check_distinct, check_inside_limits
from ikgen.verify.coverage import check_singular_answers
from ikgen.verify.oracle import PinocchioOracle
from ikgen.verify.runners.runner import Rows
from ikgen.verify.sampling import SampleSet
from ikgen.verify.task_space import task_space
from ikgen.verify.trials import Trial

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def arm() -> ArmUnderTest:
    oracle = six_axis_oracle()
    limits = (oracle.lower, oracle.upper)
    return arm_under_test(oracle, task_space(find_task("pose")), limits, ())


def rows_of(*answers: list[list[float]], singular: tuple[int, int] | None = None) -> Rows:
    """Rows by pose; statuses follow from their number."""
    most = max(map(len, answers))
    q = np.full((len(answers), most, 6), np.nan)
    flags = np.zeros((len(answers), most), dtype=bool)
    for k, answer in enumerate(answers):
        for i, row in enumerate(answer):
            q[k, i] = row
    if singular is not None:
        flags[singular] = True
    status = tuple("OK" if answer else "UNREACHABLE" for answer in answers)
    return Rows(q, np.array([len(a) for a in answers]), status, flags)


def trial_of(arm: ArmUnderTest, rows: Rows, *, limits: bool = True) -> Trial:
    q = np.zeros((len(rows), 6))
    sample = SampleSet("made", q, arm.oracle.forward(q), np.ones(len(q)))
    return Trial(sample, rows, limits, False)


def row(*first: float) -> list[float]:
    return [*first, *[0.1] * (6 - len(first))]


def test_rows_agree_but_for_whole_turns_and_late_digits(arm: ArmUnderTest) -> None:
    ours = rows_of([row(0.5), row(1.5)], [row(0.2)], [])
    theirs = rows_of([row(0.5 + 4e-7), row(1.5 - 2.0 * math.pi)], [row(0.2)], [])
    wrong, compared, largest = disagreements(arm, ours, theirs)
    assert not wrong.any() and compared.all()
    assert largest == pytest.approx(4e-7, rel=1e-3)


def test_what_two_languages_may_not_differ_in(arm: ArmUnderTest) -> None:
    base = [row(0.5), row(1.5)]
    ours = rows_of(base, base, base, base, singular=(3, 1))
    theirs = rows_of([base[1], base[0]], [base[0]], [base[0], row(1.5 + 3e-6)], [base[0]])
    wrong, compared, largest = disagreements(arm, ours, theirs)
    assert wrong.tolist() == [True, True, True, False]
    assert compared.tolist() == [True, True, True, False] and largest == 0.0


def test_rows_outside_the_limits_are_told_with_the_worst(arm: ArmUnderTest) -> None:
    rows = rows_of([row(0.5), row(2.9 + 0.3)], [row(-2.9 - 0.5)], [row(2.9 + 5e-7)])
    found = check_inside_limits(arm, [trial_of(arm, rows), trial_of(arm, rows, limits=False)])
    assert (found.count, found.failures, found.passed) == (4, 2, False)
    assert dict(found.worst)["beyond rad or m"] == pytest.approx(0.5)
    assert "made #1" in found.worst_case and "-3.4" in found.worst_case
    good = check_inside_limits(arm, [trial_of(arm, rows_of([row(0.5)]))])
    assert good.passed and dict(good.worst)["beyond rad or m"] == 0.0 and not good.worst_case


def test_rows_a_turn_apart_are_one(arm: ArmUnderTest) -> None:
    rows = rows_of([row(0.5), row(1.5)], [row(0.5), row(0.5 + 2.0 * math.pi), row(1.0)])
    found = check_distinct(arm, [trial_of(arm, rows)])
    assert (found.count, found.failures) == (5, 2) and "made #1" in found.worst_case


def test_the_length_of_a_small_arm_is_its_own() -> None:
    """What errors of position are relative to, and what is no longer one: below a millimetre."""
    for scale, low, high in ((0.1, 0.05, 0.2), (1e-6, 1e-3, 1e-3)):
        text = six_axis_urdf()
        for z in ("0.4", "0.5", "0.1"):
            text = text.replace(f'xyz="0 0 {z}"', f'xyz="0 0 {float(z) * scale!r}"')
        oracle = PinocchioOracle(tree_of(text), "l0", "tip", ("j1", "j2", "j3", "j4", "j5", "j6"))
        limits = (oracle.lower, oracle.upper)
        small = arm_under_test(oracle, task_space(find_task("pose")), limits, ())
        assert low <= small.length <= high


def test_poses_without_a_row_are_counted_and_so_are_seeds_found(arm: ArmUnderTest) -> None:
    zero = [0.0] * 6
    trials = [trial_of(arm, rows_of([zero], [], [row(1.0)])), trial_of(arm, rows_of([zero]))]
    found = check_singular_answers(arm, trials)
    assert (found.count, found.failures, found.passed) == (4, 1, False)
    assert "in 2 of 4" in found.detail and "made #1" in found.worst_case
    assert check_singular_answers(arm, trials[1:]).passed
