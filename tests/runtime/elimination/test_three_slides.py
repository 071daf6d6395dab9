"""Three turns and three slides: both solutions of the angles, and where they are one."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.chains import rotation, translation

from ikgen.runtime.python.arm.chain_kinematics import chain_of, forward
from ikgen.runtime.python.elimination.three_slides import three_slide_candidates

Array = NDArray[np.float64]
TURNING = (True, False) * 3
MOTIONS = tuple((k, turns, 1.0, 0.0) for k, turns in enumerate(TURNING))


def twisted(*angles: float) -> Array:
    """Links with these twists (rad) about x, and lengths."""
    X = [
        rotation([1.0, 0.0, 0.0], a) @ translation(0.2 + 0.1 * k, -0.3, 0.1)
        for k, a in enumerate(angles)
    ]
    return np.array([np.eye(4), *X])


def skew() -> Array:
    rng = np.random.default_rng(7)
    return np.array(
        [rotation(rng.normal(size=3), 1.1) @ translation(*rng.normal(size=3)) for _ in range(7)]
    )


@pytest.mark.parametrize(
    "frames", [skew(), twisted(0.5, 0.7, -0.3, 0.8, 0.4, 0.9)], ids=["skew", "twisted"]
)
def test_both_solutions_are_told_apart(frames: Array) -> None:
    chain = chain_of(frames, MOTIONS, 6)
    q = np.random.default_rng(8).uniform(-1.2, 1.2, (6, 6))
    T = forward(chain, q)
    pose, rows, count, simple = three_slide_candidates(
        [F[None] for F in frames], T, (0, 0, 0), TURNING
    )
    assert count.tolist() == [2] * 6 and simple.all()
    for k in range(6):
        mine = rows[pose == k]
        assert len(mine) == 2 and np.abs(mine - q[k]).max(axis=1).min() < 1e-9
        assert np.abs(forward(chain, mine) - T[k]).max() < 1e-9
        assert np.abs(mine[0] - mine[1]).max() > 1e-3


def test_where_the_outer_axes_are_as_far_apart_as_they_go_both_are_one() -> None:
    frames = twisted(0.5, 0.7, -0.3, 0.8, 0.4, 0.9)
    chain = chain_of(frames, MOTIONS, 6)
    q = np.array([[0.3, 0.2, 0.0, -0.4, 1.1, 0.5], [0.3, 0.2, pi, -0.4, 1.1, 0.5]])
    T = forward(chain, q)
    pose, rows, _, simple = three_slide_candidates([F[None] for F in frames], T, (0, 0, 0), TURNING)
    assert not simple.any()
    for k in set(pose.tolist()):
        assert np.abs(forward(chain, rows[pose == k]) - T[k]).max() < 1e-6


def test_where_the_outer_axes_are_in_line_they_are_not_told_apart() -> None:
    frames = twisted(0.5, 0.7, -0.5, -0.7, 0.4, 0.9)  # in line at angle 0 of the middle joint
    chain = chain_of(frames, MOTIONS, 6)
    T = forward(chain, np.array([[0.3, 0.2, 0.0, -0.4, 1.1, 0.5]]))
    assert not three_slide_candidates([F[None] for F in frames], T, (0, 0, 0), TURNING)[3].any()
