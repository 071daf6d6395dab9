"""Poses halfway between two, which paths are halved by; and where a walk may end."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.given_rows import given_arm

from ikgen.runtime.python.arm.chain_kinematics import forward, tip_and_jacobian
from ikgen.runtime.python.rows.solutions import Solutions, Status
from ikgen.runtime.python.solving import path_following
from ikgen.runtime.python.solving.path_following import _Walk
from ikgen.runtime.python.solving.pose_between import pose_between

Array = NDArray[np.float64]


def no_search(pose: Array, start: Array, limits: bool) -> Solutions:
    raise AssertionError("walks of arms without held joints search for nothing")


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
        middle = pose_between(a, b)
        np.testing.assert_allclose(middle[:3, 3], [0.65, 0.15, 0.3], atol=1e-15)
        np.testing.assert_allclose(middle[3], [0.0, 0.0, 0.0, 1.0])
        half = a[:3, :3].T @ middle[:3, :3]
        np.testing.assert_allclose(half @ half.T, np.eye(3), atol=1e-9)
        np.testing.assert_allclose(half @ half, a[:3, :3].T @ b[:3, :3], atol=2e-8)
        assert np.trace(half) >= 1.0 - 1e-6  # at most a quarter of a turn


def test_a_walk_arrives_inside_the_limits_or_not_at_all(monkeypatch: pytest.MonkeyPatch) -> None:
    arm: Any = SimpleNamespace(
        lower=np.array([-1.0, 0.0]), upper=np.array([1.0, 2.0]),
        policy=SimpleNamespace(limit_tolerance=1e-9, limit_reach=1e-5),
    )  # fmt: skip
    placed: list[list[float]] = []
    monkeypatch.setattr(
        path_following, "solve_pose", lambda *_: SimpleNamespace(q=np.reshape(placed, (-1, 2)))
    )
    here = np.eye(4)
    for limits in (True, False):
        walk = _Walk(arm, no_search, limits)
        assert walk._arrive(np.array([0.5, 1.5]), here) is Status.OK
        assert walk.q.tolist() == [0.5, 1.5]
        told = walk._arrive(np.array([0.5, 2.0 + 3e-9]), here)
        assert told is (Status.LIMITS if limits else Status.OK)
        assert walk.q.tolist() == ([0.5, 1.5] if limits else [0.5, 2.0 + 3e-9])
        assert walk._arrive(np.array([-1.0 - 5e-10, 0.0]), here) is Status.OK
        assert walk.q[0] == (-1.0 if limits else -1.0 - 5e-10)
    walk = _Walk(arm, no_search, True)
    placed.extend([[-0.9, 1.0], [0.5 + 1e-7, 2.0]])
    assert walk._arrive(np.array([0.5, 2.0 + 3e-9]), here) is Status.OK
    assert walk.q.tolist() == [0.5 + 1e-7, 2.0]
    assert walk._arrive(np.array([0.5, 2.0 + 3e-5]), here) is Status.LIMITS
    del placed[1]
    assert walk._arrive(np.array([0.5, 2.0 + 3e-9]), here) is Status.LIMITS


def test_the_shortest_motion_is_the_damped_least_squares_one() -> None:
    """Its gradient is nothing, also where directions are all but lost; held joints stay."""
    arm = given_arm(None)
    rng = np.random.default_rng(6)
    walk = _Walk(arm, no_search, False)
    for damping, moving in ((0.1, [0, 1, 2, 3, 4, 5]), (1e-8, [0, 2, 3, 5]), (1e-3, [1, 4])):
        q, off = rng.uniform(-1.0, 1.0, 6), rng.normal(size=6) * 1e-3
        pose = forward(arm.chain, q + off)
        step, error = walk._motion(q, pose, moving, damping)
        here, J = tip_and_jacobian(arm.chain, q[None])
        missed = arm.task.error(here, pose[None])[0]
        part = J[0][:, moving]
        gradient = part.T @ (part @ step[moving] - missed) + damping * step[moving]
        assert np.abs(gradient).max() < 1e-9
        assert not np.delete(step, moving).any() and error == np.abs(missed).max()
    far = forward(arm.chain, q + 2.0)
    assert np.abs(walk._motion(q, far, [0, 1, 2, 3, 4, 5], 1e-14)[0]).max() <= 1.0


def missing(walk: _Walk, errors: list[float]) -> list[int]:
    """The steps of a walk whose motions leave these errors, and the last for ever."""
    steps: list[int] = []

    def motion(q: Array, pose: Array, moving: list[int], damping: float) -> tuple[Array, float]:
        steps.append(len(steps))
        return np.ones(1), errors[min(len(steps), len(errors)) - 1]

    walk._motion = motion  # type: ignore[method-assign]
    return steps


def test_steps_end_where_they_do_not_halve_the_error_or_arrive() -> None:
    arm: Any = SimpleNamespace(lower=(0.0,), policy=SimpleNamespace(converged=1e-12))
    for errors, count, best in (
        ([1.0, 0.9, 0.8, 0.7, 0.6], 4, 3.0),  # from the fourth on
        ([1e-3, 9e-4, 8e-4, 7e-4, 6e-4], 4, 3.0),
        ([1.0, 0.4, 0.1, 0.04, 0.01, 0.009, 0.0], 6, 5.0),
        ([1.0, 0.1, 1e-13, 1.0], 3, 2.0),
        ([0.5, 0.9, 0.8, 0.7, 0.6], 4, 0.0),
    ):
        walk = _Walk(arm, no_search, False)
        steps = missing(walk, errors)
        q, least = walk._newton(np.zeros(1), np.eye(4), [0])
        assert len(steps) == count and q[0] == best and least == min(errors[:count])


def test_long_ways_are_gone_in_steps_of_less_than_a_third_of_a_radian() -> None:
    """Of a joint whose value is the pose's first coordinate."""
    policy = SimpleNamespace(limit_tolerance=1e-9)
    arm: Any = SimpleNamespace(lower=(0.0,), policy=policy, free_joints=("q",))
    for way in (0.2, 0.5, 2.0):
        walk, at = _Walk(arm, no_search, False), [0.0]

        def rows(pose: Array) -> Any:
            return pose[:1, 3][None], np.zeros(1, dtype=bool), Status.OK, pose[:1, 3]

        def arrive(row: Array, _: Array, walk: _Walk = walk, at: list[float] = at) -> Status:
            at.append(float(row[0]))
            walk.q = row
            return Status.OK

        walk._rows, walk._arrive = rows, arrive  # type: ignore[assignment, method-assign]
        there = turn(np.array([0.0, 0.0, 1.0]), 0.0, (way, 0.0, 0.0))
        assert walk.step(np.eye(4), there, 0) is Status.OK and walk.q[0] == way
        assert max(np.diff(at)) < 0.3 and not walk.crossed


def test_rows_that_follow_at_no_length_end_the_way_soon() -> None:
    """Each a little beside where the Jacobian leads: every step would be halved down to the last."""
    walk, asked = _Walk(given_arm(lambda *_: None), no_search, False), [0]

    def rows(pose: Array) -> Any:
        asked[0] += 1
        return (walk.q + 0.01)[None], np.zeros(1, dtype=bool), Status.OK, walk.q

    walk._rows = rows  # type: ignore[method-assign]
    here = walk.q
    there = turn(np.array([0.0, 0.0, 1.0]), 0.0, (0.4, 0.0, 0.0))
    assert walk.go_on(np.eye(4), there) is Status.OK and walk.crossed  # to the row next to it
    assert np.abs(walk.q - here).max() == 0.01
    assert 500 < asked[0] < 1100
