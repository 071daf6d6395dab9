"""Which eliminations are kept does not hang on the last bits of what probing measures."""

from __future__ import annotations

import numpy as np
import pytest
from tests.elimination.test_elimination import arm_frames

from ikgen.elimination.loop_frames import forward, typical_length
from ikgen.elimination.plan import _separate, digits_lost, ranking
from ikgen.elimination.resultant import root_shifts


@pytest.mark.parametrize("seed", range(5))
def test_half_a_tenth_of_a_digit_of_noise_changes_no_order(seed: int) -> None:
    """Mirrored eliminations, which lose alike; one that is worse, one that loses solutions."""
    noise = np.random.default_rng(seed).uniform(-0.05, 0.05, 7)
    rough = np.array([3.0, 1.3, 1.28, 0.4, 1.5, 0.35, 0.3]) + noise
    hits = np.ones((7, 200), dtype=bool)
    hits[6, :20] = False
    assert ranking(hits, rough)[:2] == [3, 5]
    assert ranking(hits[:5], rough[:5]) == [3, 1]
    noise *= 4.0
    shifts = 10.0 ** np.array([-1.0, -9.6, -6.0, -9.9, -9.8, -1.2]) * 10.0 ** noise[:6]
    assert _separate(shifts) == [1, 3]


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
