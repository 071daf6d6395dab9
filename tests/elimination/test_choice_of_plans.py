"""Which eliminations are kept does not hang on the last bits of what probing measures."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.elimination.test_elimination import arm_frames, configurations, dh_frames, missing

from ikgen.elimination.elimination_table import finder
from ikgen.elimination.loop_frames import forward, hold_joint, typical_length
from ikgen.elimination.plan import _separate, choose_plan, ranking
from ikgen.elimination.probing import digits_lost
from ikgen.elimination.resultant import RESULTANTS, root_shifts, roots_shared
from ikgen.elimination.routine import FirstRun, Plan, first_runs
from ikgen.runtime.python.elimination.general_6r import candidates

Array = NDArray[np.float64]


@pytest.mark.parametrize("seed", range(5))
def test_half_a_tenth_of_a_digit_of_noise_changes_no_order(seed: int) -> None:
    """Mirrored eliminations, which lose alike; one that is worse, one that loses solutions."""
    noise = np.random.default_rng(seed).uniform(-0.05, 0.05, 7)
    rough = np.array([3.0, 1.3, 1.28, 0.4, 1.5, 0.35, 0.3]) + noise
    hits = np.ones((7, 200), dtype=bool)
    hits[6, :20] = False
    enough = np.ones(7)
    assert ranking(hits, rough, enough)[:2] == [3, 5]
    assert ranking(hits[:5], rough[:5], enough[:5]) == [3, 1]
    noise *= 4.0
    shifts = 10.0 ** np.array([-1.0, -9.6, -6.0, -9.9, -9.8, -1.2]) * 10.0 ** noise[:6]
    assert _separate(shifts) == [1, 3]


def test_of_two_slides_the_second_hidden_angle_is_not_opposite_to_the_first() -> None:
    hits, rough = np.ones((4, 9), dtype=bool), np.array([2.0, 0.0, 0.9, 0.01])
    assert ranking(hits, rough, np.ones(4)) == [1, 3]
    assert ranking(hits, rough, np.ones(4), opposite=2) == [1, 2]


def test_what_is_enough_more_often_comes_before_what_loses_a_digit_less() -> None:
    hits, rough = np.ones((4, 24), dtype=bool), np.array([1.5, 1.0, 2.5, 2.4])
    enough = np.array([4.0, 3.0, 11.0, 12.0]) / 12.0
    assert ranking(hits, rough, enough) == [2, 3]
    enough[2] -= 2.0 / 12.0
    assert ranking(hits, rough, enough)[0] == 3
    hits[2:, 0] = False
    assert ranking(hits, rough, enough)[0] == 1


def test_roots_that_lie_in_pairs_are_left_to_another_hidden_angle() -> None:
    """A wrist whose axes miss each other by a hundredth of the arm: its two solutions for each position
    share the angles of the first three joints, nearly."""
    h = 0.5 * np.pi
    a, d = [0.0, 0.1, 0.4, 0.02, 0.004, 0.0], [0.0, 0.0, 0.1, 0.4, 0.005, 0.0]
    frames = dh_frames([0.0, -h, 0.0, h, -h, h], a, d)
    plan = choose_plan(frames)
    q = configurations(frames, 24)
    poses = np.array([forward(frames, row) for row in q])
    find = finder(plan.turning)
    alone = [Plan(plan.length, (e,), plan.turning, find) for e in (plan.eliminations[0], (2, 0, 0))]
    chosen, paired = (run.often_enough for run in first_runs(frames, alone, poses))
    assert chosen > 0.9 > 0.5 > paired


def test_a_run_is_enough_at_none_of_no_poses() -> None:
    assert FirstRun([], np.zeros(0), np.zeros(0, dtype=bool)).often_enough == 0.0


def test_only_what_separates_roots_is_kept() -> None:
    assert _separate(np.array([1.0, 2e-2, 3e-5, 1.0])) == [2]
    assert _separate(np.ones(4)) == []


def test_one_bad_solution_of_many_counts_little_and_no_solution_as_all_bad() -> None:
    errors = np.full(150, 1e-12)
    assert digits_lost(errors) == 0.0
    errors[0] = 1e-3
    assert digits_lost(errors) == pytest.approx(5.0 / 150.0)
    assert digits_lost(np.full(3, 1e-6)) == pytest.approx(2.0)
    assert digits_lost(np.zeros(0)) == 8.0


def test_how_far_roots_move_is_the_same_whatever_the_last_bits() -> None:
    """A hidden angle whose roots nearly meet: rounding, played by noise of one bit, moves what is measured
    of them by a hundredth."""
    frames = arm_frames("fanuc_crx30ia")
    frames[:, :3, 3] /= typical_length(frames)
    random = np.random.default_rng(0)
    q = random.uniform(-np.pi, np.pi, (24, 6))
    poses = np.array([forward(frames, row) for row in q])
    found = []
    for _ in range(4):
        bits = random.choice((-1.0, 0.0, 1.0), poses.shape) * 2.0**-53
        shifts = np.quantile(root_shifts(frames, poses * (1.0 + bits), q), 0.75, axis=1)
        found.append(shifts[shifts < 0.1])
    assert all(len(one) == 1 for one in found)
    assert np.ptp(found) < 0.03 * np.mean(found)


def _link(quarters: int, x: float, y: float, z: float) -> Array:
    """A displacement (m), and as many right angles about x."""
    frame = np.eye(4)
    c, s = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarters % 4]
    frame[1:3, 1:3] = [[c, -s], [s, c]]
    frame[:3, 3] = x, y, z
    return frame


def seven_axes() -> Array:
    """Frames (8, 4, 4) of an arm with its second and fourth axes parallel where the third joint is at 0."""
    shoulder = _link(0, 0.0, 0.0, 0.3), _link(-1, 0.04, 0.02, 0.18), _link(1, 0.02, -0.17, -0.04)
    elbow = _link(1, 0.02, -0.04, 0.16), _link(-1, -0.02, 0.17, -0.04)
    wrist = _link(-1, 0.0, -0.04, 0.165), _link(1, 0.07, -0.05, -0.04), _link(0, 0.0, 0.0, 0.02)
    return np.array([*shoulder, *elbow, *wrist])


def test_a_held_joint_that_makes_axes_parallel_leaves_the_first_elimination_its_rank() -> None:
    """Held at 0 or pi the third joint puts its neighbours' axes in parallel: some eliminations, one of them
    the best elsewhere, are singular at every angle there, find half of the rows by chance, and say so."""
    frames = seven_axes()
    special = [hold_joint(frames, 2, value) for value in (0.0, np.pi)]
    family = np.array([hold_joint(frames, 2, value) for value in (0.4, -1.1, 2.2)])
    plan, elsewhere = choose_plan(family, special=special), (1, 0, 0)
    for held in special:
        q = configurations(held, 20)
        poses = np.array([forward(held, row) for row in q])
        alone = Plan(plan.length, plan.eliminations[:1], plan.turning, finder(plan.turning))
        assert missing(first_runs(held, [alone], poses)[0].rows, q) == 0
        said = [candidates(held[:, None], poses, e, plan.turning)[2] for e in plan.eliminations]
        assert np.min(said) >= 0
        assert (candidates(held[:, None], poses, elsewhere, plan.turning)[2] == -1).all()


def test_no_resultant_is_kept_of_which_one_root_is_two_solutions() -> None:
    """The sides of an elbow between parallel axes have the other three angles in common."""
    shared = roots_shared(
        [np.array([[0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [0.1, 0.2, 0.3, -0.4, 1.3, 0.2]])]
    )
    alike = {plan for plan, both in zip(RESULTANTS, shared[:, 0], strict=True) if both}
    assert alike == {(4, 0), (5, 0), (0, 0), (2, 1), (3, 1), (4, 1)}
    once = np.array([[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]])
    assert not roots_shared([np.concatenate([once, once + 1e-9, once + 2.0 * np.pi])]).any()
    a, d = [0.0, 0.1, 0.2, 0.3, 0.25, 0.05], [0.0, 0.05, 0.1, 0.0, 0.02, 0.1]
    frames = dh_frames([0.0, -1.1, 0.9, 0.0, 0.0, 1.2], a, d)
    plan = choose_plan(frames)
    find, poses = finder(plan.turning), forward(frames, configurations(frames, 12))
    runs = first_runs(
        frames, [Plan(plan.length, (e,), plan.turning, find) for e in plan.eliminations], poses
    )
    shared = roots_shared([np.concatenate([run.rows[i] for run in runs]) for i in range(12)])
    lost = {RESULTANTS[k] for k in np.flatnonzero(shared.any(axis=1))}
    assert lost == {(3, 0), (4, 0), (5, 0), (1, 1), (2, 1), (3, 1)}
    assert plan.resultants and not lost & {*plan.resultants}
