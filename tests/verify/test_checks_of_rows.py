"""Checks of returned rows on rows made by hand: what counts, what is told of it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.fake_arms import six_axis_oracle, six_axis_urdf, tree_of

from ikgen.tasks import find_task
from ikgen.verify import checks
from ikgen.verify.agreement import disagreements
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.checks import (
    check_closure,
    check_distinct,
    check_free_joints,
    check_inside_limits,
    check_seed_order,
    check_singular_flags,
)
from ikgen.verify.completeness import Sensitivity
from ikgen.verify.coverage import (
    check_exhaustive,
    check_limit_choice,
    check_singular_answers,
    check_status,
    check_unreachable,
)
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
    theirs = rows_of([base[1], base[1]], [base[0]], [base[0], row(1.5 + 3e-6)], [base[0]])
    wrong, compared, largest = disagreements(arm, ours, theirs)
    assert wrong.tolist() == [True, True, True, False]
    assert compared.tolist() == [True, True, True, False] and largest == 0.0


def test_without_a_seed_the_order_of_rows_is_not_promised(arm: ArmUnderTest) -> None:
    ours, theirs = rows_of([row(0.5), row(1.5), row(2.5)]), rows_of([row(2.5), row(0.5), row(1.5)])
    wrong, compared, largest = disagreements(arm, ours, theirs)
    assert compared.all() and not wrong.any() and largest == 0.0


def test_rows_with_slides_far_out_need_not_agree(arm: ArmUnderTest) -> None:
    """The joint in the middle taken for a slide."""
    sliding = replace(arm, revolute=np.arange(6) != 2, length=1.0)
    far, near, other = row(0.5, 0.1, -150.0), row(0.5, 0.1, 50.0), row(0.5, 0.1, 49.0)
    ours = rows_of([near, far], [far], [near], [near, far])
    theirs = rows_of([near], [], [], [other])
    wrong, compared, largest = disagreements(sliding, ours, theirs)
    assert wrong.tolist() == [False, False, True, True]
    assert compared.all() and largest == 0.0


def test_rows_outside_the_limits_are_told_with_the_worst(arm: ArmUnderTest) -> None:
    rows = rows_of([row(0.5), row(2.9 + 0.3)], [row(-2.9 - 0.5)], [row(2.9 + 5e-7)])
    free = rows_of([row(9.0)])
    found = check_inside_limits(arm, [trial_of(arm, rows), trial_of(arm, free, limits=False)])
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


def reached(arm: ArmUnderTest, q: Array, off: Array | None = None, *, label: str = "made") -> Trial:
    """Poses of configurations (N, 6), each answered with its own, moved by `off` (N, 6)."""
    moved = q if off is None else q + off
    answer = Rows(
        moved[:, None], np.ones(len(q), int), ("OK",) * len(q), np.zeros((len(q), 1), bool)
    )
    return Trial(SampleSet(label, q, arm.oracle.forward(q), arm.sigma(q)), answer, True, False)


def drawn(count: int) -> Array:
    return np.random.default_rng(2).uniform(0.3, 1.2, (count, 6))


def test_rows_off_their_pose_are_told_with_the_worst(arm: ArmUnderTest) -> None:
    q, off = drawn(4), np.zeros((4, 6))
    assert check_closure(arm, [reached(arm, q)]).passed
    off[1, 5], off[2, 1] = 1e-6, 3e-6  # the last joint turns the tip where it is
    found = check_closure(arm, [reached(arm, q), reached(arm, q, off, label="moved")])
    assert (found.count, found.failures, found.passed) == (8, 2, False)
    worst = dict(found.worst)
    assert worst["rotation rad"] == pytest.approx(3e-6, rel=1e-3)
    assert 5e-7 < worst["position m"] < 3e-6
    assert "moved #2" in found.worst_case
    nan = np.where(off > 0.0, np.nan, 0.0)
    assert check_closure(arm, [reached(arm, q, nan)]).failures == 2
    empty = trial_of(arm, rows_of([], []))
    after = check_closure(arm, [empty, reached(arm, q, off, label="moved"), empty])
    assert (after.count, after.failures) == (4, 2) and "moved #2" in after.worst_case
    none = check_closure(arm, [empty])
    assert not none.passed and none.worst_case == "no pose was answered with a row"


def test_of_rows_that_are_as_wrong_the_first_is_told(arm: ArmUnderTest) -> None:
    q, off = drawn(3), np.zeros((3, 6))
    off[1:, 5] = 1e-6
    trials = [reached(arm, q, off, label=label) for label in ("first", "second")]
    assert "first #" in check_closure(arm, trials).worst_case
    out = [row(0.5), row(2.9 + 0.3)]
    beyond = [trial_of(arm, rows_of(out)), trial_of(arm, rows_of([row(0.1)], out))]
    assert "made #0" in check_inside_limits(arm, beyond).worst_case
    double = rows_of([row(0.5)], [row(0.5), row(0.5)], [row(0.7), row(0.7)])
    assert "made #1" in check_distinct(arm, [trial_of(arm, double)] * 2).worst_case
    none = rows_of([row(0.5)], [], [])
    assert "made #1" in check_singular_answers(arm, [trial_of(arm, none)] * 2).worst_case
    wrong = replace(none, status=("LIMITS", "LIMITS", "OK"))
    assert "made, LIMITS #1" in check_unreachable(
        arm, [trial_of(arm, replace(none, status=("UNREACHABLE",) * 3, count=np.zeros(3, int))),
              trial_of(arm, replace(wrong, status=("UNREACHABLE", "LIMITS", "OK"), count=np.zeros(3, int)))]
    ).worst_case  # fmt: skip


def test_rows_on_limits_are_as_right_as_others(arm: ArmUnderTest) -> None:
    q, off = drawn(1), np.zeros((1, 6))
    q[0, 0], q[0, 5] = arm.lower[0], 0.4
    for by, right in ((0.9e-9, True), (1.1e-9, False)):
        off[0, 5] = by
        assert check_closure(arm, [reached(arm, q, off)]).passed == right


def test_flags_belong_to_continua(arm: ArmUnderTest) -> None:
    q = drawn(3)
    q[0, 4] = 0.0  # axes 4 and 6 in line
    trial = reached(arm, q)

    def told(*flags: bool) -> tuple[int, int, str]:
        answer = replace(trial.rows, singular=np.array(flags)[:, None])
        found = check_singular_flags(arm, [replace(trial, rows=answer)])
        assert ("made #" in found.worst_case) == (not found.passed)
        return found.count, found.failures, found.detail

    assert told(True, False, False) == (3, 0, "")
    assert told(False, False, False) == (3, 1, "1 rows of a continuum not flagged")
    assert told(True, True, False) == (3, 1, "0 rows of a continuum not flagged")
    assert told(False, True, True) == (3, 3, "1 rows of a continuum not flagged")


def test_rows_that_are_flagged_are_not_followed(
    arm: ArmUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And those of all trials that are not in one call: of many rows the price is that of the calls."""
    asked: list[list[float]] = []

    def followed(arm: ArmUnderTest, q: Any, targets: Any) -> Any:
        assert np.allclose(arm.oracle.forward(q), targets)
        asked.append(q[:, 0].tolist())
        return np.arange(len(q)) == 1

    monkeypatch.setattr(checks, "on_continuum", followed)
    trials = []
    for q, flags in ((drawn(3), (False, True, False)), (drawn(2), (True, False))):
        q[:, 0] = 0.1 * np.arange(len(q)) + len(q)
        trial = reached(arm, q)
        trials.append(replace(trial, rows=replace(trial.rows, singular=np.array(flags)[:, None])))
    found = check_singular_flags(arm, trials)
    np.testing.assert_allclose(asked, [[3.0, 3.2, 2.1]])
    assert (found.count, found.failures) == (5, 3) and "made #1: row = [3.1" in found.worst_case


def test_rows_come_in_the_order_of_some_distance_to_the_seed(arm: ArmUnderTest) -> None:
    seeds = np.zeros((3, 6))
    near, far = row(0.2, 0.2, 0.2), row(0.5)  # farther by the sum alone: 0.6 + 0.3 and 0.5 + 0.5

    def told(*answers: list[list[float]]) -> tuple[int, int]:
        found = check_seed_order(trial_of(arm, rows_of(*answers)), seeds)
        assert found.name == "seed order" and bool(found.worst_case) == (found.failures > 0)
        return found.count, found.failures

    assert told([near, far], [near], []) == (1, 0)
    assert told([far, near], [near, far], [near]) == (2, 1)
    one, other = row(0.4), [0.0, 0.3, 0.3, 0.1, 0.1, 0.1]
    assert told([one, other], [one, other], []) == (2, 0)
    swapped = [[other, one]] * 3  # nearer by the largest difference
    assert told(*swapped) == (3, 0)


def test_held_joints_stay(arm: ArmUnderTest) -> None:
    names = arm.oracle.joint_names
    held = arm_under_test(arm.oracle, arm.task, (arm.lower, arm.upper), (names[2], names[3]))
    q, off = drawn(3), np.zeros((3, 6))
    off[:, 1] = 0.1
    assert check_free_joints(held, [reached(held, q, off)]).passed
    off[1, 3] = 1e-6
    found = check_free_joints(held, [reached(held, q), reached(held, q, off)])
    assert (found.count, found.failures) == (6, 1) and "made #1" in found.worst_case
    assert found.detail == "" and dict(found.worst)["off rad or m"] == pytest.approx(1e-6)
    none = check_free_joints(arm, [reached(arm, q, off)])
    assert none.passed and (none.count, none.worst) == (0, ())
    assert none.detail == "no joint is held free"


def test_limits_choose_among_the_rows_without_them(arm: ArmUnderTest) -> None:
    inside, beyond, turned = row(0.5), row(3.0), row(0.7 + 2.0 * math.pi)

    def told(limited: Rows, unlimited: Rows) -> tuple[int, int, str]:
        found = check_limit_choice(
            arm, trial_of(arm, limited), trial_of(arm, unlimited, limits=False)
        )
        return found.count, found.failures, found.worst_case

    every = rows_of([inside, beyond, turned])
    assert told(rows_of([inside, row(0.7)]), every) == (4, 0, "")
    count, failures, case = told(rows_of([inside]), every)
    assert (count, failures) == (3, 1) and "dropped #0" in case
    count, failures, case = told(rows_of([inside, row(0.7), row(0.9)]), every)
    assert (count, failures) == (5, 1) and "not without limits #0" in case
    flagged = rows_of([inside, beyond, turned], singular=(0, 1))
    assert told(rows_of([inside]), flagged) == (0, 0, "")
    assert told(rows_of([inside], singular=(0, 0)), every) == (0, 0, "")


def test_the_status_says_what_limits_leave(arm: ArmUnderTest) -> None:
    some, none = [row(0.5)], list[list[float]]()
    with_, without = rows_of(some, none, none), rows_of(some, some, none)
    with_ = replace(with_, status=("OK", "LIMITS", "UNREACHABLE"))

    def told(limited: Rows, unlimited: Rows) -> int:
        pair = trial_of(arm, limited), trial_of(arm, unlimited, limits=False)
        found = check_status([pair])
        assert found.count == 3 and bool(found.worst_case) == (found.failures > 0)
        return found.failures

    assert told(with_, without) == 0
    late = replace(with_, status=("OK", "OK", "OK"))
    pairs = [
        (trial_of(arm, one), trial_of(arm, without, limits=False)) for one in (with_, late, late)
    ]
    found = check_status(pairs)
    assert (found.count, found.failures) == (9, 4) and "made, OK #1" in found.worst_case
    assert told(replace(with_, status=("OK", "UNREACHABLE", "UNREACHABLE")), without) == 1
    assert told(replace(with_, status=("LIMITS", "LIMITS", "LIMITS")), without) == 2
    assert told(with_, replace(without, status=("UNREACHABLE", "OK", "OK"))) == 2


def test_poses_out_of_reach_have_neither_rows_nor_another_status(arm: ArmUnderTest) -> None:
    none = rows_of([], [])
    assert check_unreachable(arm, [trial_of(arm, none)]).passed
    wrong = replace(none, status=("UNREACHABLE", "LIMITS"))
    found = check_unreachable(arm, [trial_of(arm, none), trial_of(arm, wrong)])
    assert (found.count, found.failures) == (4, 1) and "made" in found.worst_case
    rows = rows_of([row(0.5)], [])
    assert check_unreachable(arm, [trial_of(arm, rows)]).failures == 1


def test_solutions_that_a_search_finds_are_among_the_rows(
    arm: ArmUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each is counted once, however often it is found; singular ones are not."""
    one, two, three = (np.array(row(*first)) for first in ([0.5], [0.9, 0.4], [1.4, -0.6]))
    flat = np.array([*row(0.5)[:4], 0.0, 0.1])
    turn = 2.0 * np.pi * np.eye(6)[3]
    found = [
        np.array([one, two, one + 1e-9, flat, two + turn, three]), np.empty((0, 6)), flat[None],
        np.array([three, three]),
    ]  # fmt: skip
    monkeypatch.setattr("ikgen.verify.coverage.find_solutions", lambda *_: found)
    nothing: list[list[float]] = []

    def told(*answers: list[list[float]]) -> tuple[int, int, str]:
        trial = trial_of(arm, rows_of(*answers), limits=False)
        result = check_exhaustive(arm, trial, 7, np.random.default_rng(0))
        assert result.detail == "4 poses, 7 starts each"
        return result.count, result.failures, result.worst_case

    every = [list(one), list(two - turn), list(three)]
    assert told(every, nothing, nothing, every) == (4, 0, "")
    count, failures, case = told(every[:1], nothing, nothing, every[:2])
    assert (count, failures) == (4, 3) and "made #0" in case and "0.9" in case and "1.4" in case
    count, failures, case = told(every, nothing, nothing, nothing)
    assert (count, failures) == (4, 1) and "made #3" in case


def test_an_arm_angle_that_is_held_counts_as_one_more(arm: ArmUnderTest) -> None:
    assert arm.rank == 6 and replace(arm, angle=object()).rank == 7


def test_a_search_finds_solutions_as_near_as_its_residual_tells(
    arm: ArmUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a mast 1e5 times as long as the arm, a residual of 1e-11 of it is some 1e-6 rad."""
    far = replace(arm, length=1e5 * arm.length)
    q = np.array(row(0.9, 0.4))
    for one, off, failures in ((arm, 3e-6, 1), (far, 3e-6, 0), (far, 2e-2, 1)):
        monkeypatch.setattr(
            "ikgen.verify.coverage.find_solutions", lambda *_, off=off: [np.array([q + off])]
        )
        trial = trial_of(one, rows_of([list(q)]), limits=False)
        assert check_exhaustive(one, trial, 7, np.random.default_rng(0)).failures == failures


def test_a_search_that_ends_beside_a_fold_is_as_far_off_as_the_fold_lets_it(
    arm: ArmUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`kappa x^2 / 2 = 1e-11` with kappa 0.1 ends at x = 1.4e-5, where sigma is kappa x."""
    off = (2e-11 / 0.1) ** 0.5
    known = Sensitivity(np.array([0.1 * off]), np.array([0.1]))
    monkeypatch.setattr("ikgen.verify.coverage.sensitivity", lambda *_: known)
    q = np.array(row(0.9, 0.4))
    for share, failures in ((0.95, 0), (2.5, 1)):
        found = [np.array([q + share * off * np.eye(6)[0]])]
        monkeypatch.setattr("ikgen.verify.coverage.find_solutions", lambda *_, found=found: found)
        trial = trial_of(arm, rows_of([list(q)]), limits=False)
        assert check_exhaustive(arm, trial, 7, np.random.default_rng(0)).failures == failures
