"""Rows of several poses that are the same."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.rows.solution_rows import first_of_equals

TURNING = (True, True, False, True, True, False)
COINCIDENT = 1e-6


def drawn(count: int, seed: int) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Rows of poses in order, many of which are alike in some joints, and some in all."""
    rng = np.random.default_rng(seed)
    q = rng.choice([-np.pi + 1e-8, -1.0, 0.0, 1e-7, 2e3, 2e3 + 1e-4, np.pi - 1e-8], (count, 6))
    q[rng.random(count) < 0.5] = q[0]
    q[:, 5] += rng.choice([0.0, 3e-7, 3e-6], count)
    return q, np.sort(rng.integers(3, 9, count))


def test_a_row_counts_where_no_earlier_one_of_its_pose_equals_it() -> None:
    lost = 0
    for seed in range(20):
        q, pose = drawn(60, seed)
        wanted = []
        for k, row in enumerate(q):
            gap = np.abs(q[:k][pose[:k] == pose[k]] - row)
            long = np.maximum(np.abs(q[:k][pose[:k] == pose[k]]), 1.0)
            gap = np.where(TURNING, np.minimum(gap, 2.0 * np.pi - gap), gap / long)
            wanted.append(not (np.abs(gap) < COINCIDENT).all(axis=1).any())
        assert first_of_equals(q, pose, TURNING, COINCIDENT).tolist() == wanted
        lost += len(wanted) - sum(wanted)
    assert lost > 200


def test_rows_that_all_differ_and_none() -> None:
    q, pose = np.arange(18.0).reshape(3, 6), np.array([4, 4, 7])
    assert first_of_equals(q, pose, TURNING, COINCIDENT).tolist() == [True] * 3
    assert first_of_equals(q[:0], pose[:0], TURNING, COINCIDENT).tolist() == []
