"""Poses halfway between two, which paths are halved by; and where a walk may end."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.path_following import _between, _Walk
from ikgen.runtime.python.solutions import Status

Array = NDArray[np.float64]


def turn(axis: Array, angle: float, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Array:
    """A turn about an axis, by Rodrigues' formula."""
    x, y, z = axis / np.linalg.norm(axis)
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    T = np.eye(4)
    T[:3, :3] += math.sin(angle) * K + (1.0 - math.cos(angle)) * K @ K
    T[:3, 3] = at
    return T


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-5, 0.3, 1.5, 2.9, math.pi - 1e-9, math.pi])
def test_the_pose_halfway_has_half_of_the_turn(angle: float) -> None:
    rng = np.random.default_rng(4)
    for way in (*np.eye(3), *-np.eye(3), *rng.normal(size=(6, 3))):
        a = turn(rng.normal(size=3), 1.2, (0.3, -0.2, 0.9))
        b = a @ turn(way, angle)
        b[:3, 3] = 1.0, 0.5, -0.3
        middle = _between(a, b)
        np.testing.assert_allclose(middle[:3, 3], [0.65, 0.15, 0.3], atol=1e-15)
        np.testing.assert_allclose(middle[3], [0.0, 0.0, 0.0, 1.0])
        half = a[:3, :3].T @ middle[:3, :3]
        np.testing.assert_allclose(half @ half.T, np.eye(3), atol=1e-9)
        np.testing.assert_allclose(half @ half, a[:3, :3].T @ b[:3, :3], atol=2e-8)
        assert np.trace(half) >= 1.0 - 1e-6  # at most a quarter of a turn


def test_a_walk_arrives_inside_the_limits_or_not_at_all() -> None:
    arm: Any = SimpleNamespace(
        lower=(-1.0, 0.0), upper=(1.0, 2.0), policy=SimpleNamespace(limit_tolerance=1e-9)
    )
    for limits in (True, False):
        walk = _Walk(arm, limits)
        assert walk._arrive(np.array([0.5, 1.5])) is Status.OK and walk.q.tolist() == [0.5, 1.5]
        told = walk._arrive(np.array([0.5, 2.0 + 3e-9]))
        assert told is (Status.LIMITS if limits else Status.OK)
        assert walk.q.tolist() == ([0.5, 1.5] if limits else [0.5, 2.0 + 3e-9])
        assert walk._arrive(np.array([-1.0 - 5e-10, 0.0])) is Status.OK
        assert walk.q[0] == (-1.0 if limits else -1.0 - 5e-10)
