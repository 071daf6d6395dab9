"""Chains with held joints, as the eliminations take them."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.chains import rotation, translation

from ikgen.elimination.loop_frames import hold_joint
from ikgen.runtime.python import elimination_rows
from ikgen.runtime.python.elimination_rows import _frames

FRAMES = np.array(
    [rotation([1.0, 0.2 * k, 0.0], 0.3 * k) @ translation(0.1 * k, -0.2, 0.05) for k in range(8)]
)


@pytest.mark.parametrize("joint", [0, 3, 6])
@pytest.mark.parametrize("turns", [True, False])
def test_a_held_joint_is_merged_into_the_chain(joint: int, turns: bool) -> None:
    motions = tuple((k, turns if k == joint else True, 1.0, 0.0) for k in range(7))
    arm = SimpleNamespace(chain=SimpleNamespace(frames=FRAMES, motions=motions), free=(joint,))
    held = [math.cos(0.7), math.sin(0.7)] if turns else [0.7]
    merged: NDArray[np.float64] = _frames(arm, np.array(held))
    np.testing.assert_allclose(merged, hold_joint(FRAMES, joint, 0.7, revolute=turns), atol=1e-15)


def test_two_held_joints_take_their_values_in_order() -> None:
    motions = tuple((k, k != 5, 1.0, 0.0) for k in range(8))
    frames = np.concatenate([FRAMES, FRAMES[:1]])
    arm = SimpleNamespace(chain=SimpleNamespace(frames=frames, motions=motions), free=(1, 5))
    merged = _frames(arm, np.array([math.cos(0.4), math.sin(0.4), -0.2]))
    expected = hold_joint(hold_joint(frames, 5, -0.2, revolute=False), 1, 0.4)
    np.testing.assert_allclose(merged, expected, atol=1e-15)


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
        task=None,
        moving=(1, 3),
        most=2,
        policy=SimpleNamespace(continuum_rank_loss=1e-3),
    )
    seen = []

    def loss(chain: object, task: object, moving: object, q: NDArray[np.float64]) -> object:
        seen.append(q)
        return np.array([1e-5, 0.3, 0.2])

    monkeypatch.setattr(elimination_rows, "rank_loss", loss)
    angles = np.array([[0.9, 1.0], [0.7, 2.0], [0.5, 3.0]])
    held = np.array([math.cos(0.4), math.sin(0.4), -0.6])
    kept = elimination_rows._regular_first(arm, angles, held)
    np.testing.assert_array_equal(kept, angles[1:])
    np.testing.assert_allclose(seen[0][0], [0.4, 0.2, 0.7, 1.0])
    assert elimination_rows._regular_first(arm, angles[:2], held) is not None and len(seen) == 1
