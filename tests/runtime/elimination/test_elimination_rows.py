"""Chains with held joints, as the eliminations take them."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.chains import rotation, translation
from tests.support.held_stacks import assert_solved_as_each_alone
from tests.support.parallel_arms import parallel_frames

from ikgen.elimination.loop_frames import forward as chain_forward
from ikgen.elimination.loop_frames import hold_joint, over
from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.elimination import elimination_rows
from ikgen.runtime.python.elimination.elimination_rows import _six_joints
from ikgen.runtime.python.elimination.general_6r import Plan, candidates
from ikgen.runtime.python.elimination.parallel_axes import parallel_candidates
from ikgen.runtime.python.elimination.parallel_links import MEETING, PLAIN, UPRIGHT
from ikgen.runtime.python.elimination.six_joints import SixJoints

Array = NDArray[np.float64]
FRAMES = np.array(
    [rotation([1.0, 0.2 * k, 0.0], 0.3 * k) @ translation(0.1 * k, -0.2, 0.05) for k in range(8)]
)


TURNS = (True,) * 6


def merged(free: tuple[int, ...], slides: tuple[int, ...], held: Array) -> SixJoints:
    """What is left of a chain of six joints and the `free` ones; lengths over 2 m."""
    count = 6 + len(free)
    motions = tuple((k, k not in slides, 1.0, 0.0) for k in range(count))
    frames = np.concatenate([FRAMES, FRAMES])[: count + 1]
    arm: Any = SimpleNamespace(chain=SimpleNamespace(frames=frames, motions=motions), free=free)
    return _six_joints(arm, Plan(2.0, ((0, 0, 0),), TURNS, candidates), held)


@pytest.mark.parametrize("joint", [0, 3, 6])
@pytest.mark.parametrize("turns", [True, False])
def test_a_held_joint_is_merged_into_the_chain(joint: int, turns: bool) -> None:
    held = [math.cos(0.7), math.sin(0.7)] if turns else [0.7]
    six = merged((joint,), () if turns else (joint,), np.array([held]))
    expected = over(hold_joint(FRAMES, joint, 0.7, revolute=turns), 2.0)
    np.testing.assert_allclose(np.concatenate(six.frames), expected, atol=1e-15)


def test_two_held_joints_take_their_values_in_order() -> None:
    six = merged((1, 5), (5,), np.array([[math.cos(0.4), math.sin(0.4), -0.2]]))
    frames = np.concatenate([FRAMES, FRAMES[:1]])
    expected = over(hold_joint(hold_joint(frames, 5, -0.2, revolute=False), 1, 0.4), 2.0)
    np.testing.assert_allclose(np.concatenate(six.frames), expected, atol=1e-15)


def test_the_chain_that_rows_are_refined_on_has_the_held_joints_behind_the_six() -> None:
    rng = np.random.default_rng(1)
    q, values = rng.uniform(-1.0, 1.0, (5, 6)), rng.uniform(-1.0, 1.0, (5, 2))
    c, s = np.cos(values[:, 0]), np.sin(values[:, 0])
    six = merged((2, 6), (6,), np.stack([c, s, values[:, 1]], axis=1))
    poses = forward(six.chain, np.concatenate([q, six.held], axis=1))
    for k in range(5):
        chain = np.concatenate([frame[k % len(frame)][None] for frame in six.frames])
        np.testing.assert_allclose(chain_forward(chain, q[k]), poses[k], atol=1e-14)
    some = six.of(np.array([3, 1]))
    np.testing.assert_array_equal(some.held, six.held[[3, 1]])
    np.testing.assert_array_equal(some.frames[2], six.frames[2][[3, 1]])
    assert [len(frame) for frame in six.frames] == [1, 1, 5, 1, 1, 5, 1]


@pytest.mark.parametrize("place", range(7))
@pytest.mark.parametrize("kind", ["general", MEETING, UPRIGHT, PLAIN])
def test_poses_with_values_of_their_own_are_solved_as_each_is_alone(
    kind: str | int, place: int
) -> None:
    """A joint is put into the chain before each of its links."""
    frames = FRAMES[:7] if isinstance(kind, str) else parallel_frames(kind)
    direct = () if isinstance(kind, str) else ((parallel_candidates, (0, 0, kind), 1e-7),)
    plan = Plan(1.0, ((0, 0, 0), (0, 1, 0)), TURNS, candidates, direct)
    motions = [(k, True, 1.0, 0.0) for k in range(6)]
    rng = np.random.default_rng(place)
    held = rng.uniform(-0.3, 0.3, (4, 1))
    assert_solved_as_each_alone(plan, frames, motions, place, held, rng, 1e-9)


def test_samples_of_a_continuum_go_first_where_there_are_too_many_rows(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Rows of DH variables become joint values with the held ones among them, by offset and scale."""
    motions = ((1, True, 2.0, 0.5), (0, True, 1.0, 0.0), (2, False, -1.0, 0.1), (3, True, 1.0, 0.0))
    arm = SimpleNamespace(
        chain=SimpleNamespace(
            motions=motions,
            joint=np.array([1, 0, 2, 3]),
            offset=np.array([0.5, 0.0, 0.1, 0.0]),
            scale=np.array([2.0, 1.0, -1.0, 1.0]),
        ),
        free=(0, 2),
        lower=np.zeros(4),
        task=SimpleNamespace(error=lambda pose, T: (pose - T).reshape(-1, 16)),
        moving=(1, 3),
        most=2,
        policy=SimpleNamespace(continuum_below=1e-3, exact=1e-12),
    )
    seen = []
    sigmas, off = np.array([1e-5, 0.3, 0.2]), np.zeros(3)

    def sigma(chain: object, task: object, moving: object, q: NDArray[np.float64]) -> object:
        seen.append(q)
        return sigmas

    monkeypatch.setattr(elimination_rows, "smallest_singular_values", sigma)
    monkeypatch.setattr(elimination_rows, "forward", lambda chain, q: T + off[:, None, None])
    T = np.eye(4)
    angles = np.array([[0.9, 1.0], [0.7, 2.0], [0.5, 3.0]])
    held = np.array([math.cos(0.4), math.sin(0.4), -0.6])
    kept = elimination_rows._regular_first(arm, angles, held, T)
    np.testing.assert_array_equal(kept, angles[1:])
    np.testing.assert_allclose(seen[0][0], [0.4, 0.2, 0.7, 1.0])
    assert elimination_rows._regular_first(arm, angles[:2], held, T) is not None and len(seen) == 1
    sigmas[:], off[:] = 1e-5, [1e-11, 0.0, 0.0]  # what is off the pose goes before what is not
    kept = elimination_rows._regular_first(arm, angles, held, T)
    np.testing.assert_array_equal(kept, angles[1:])
