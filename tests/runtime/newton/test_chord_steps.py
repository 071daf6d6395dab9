"""Newton steps of few rows of one pose, with the derivatives of where they start."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.given_rows import FRAMES, given_arm

from ikgen.runtime.python.arm.chain_kinematics import Motion, chain_of, forward
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arm.whole_pose import PoseTask
from ikgen.runtime.python.newton.chord_steps import chord_steps
from ikgen.runtime.python.newton.joint_refinement import refine_few

Array = NDArray[np.float64]

ROW = np.array([0.3, -0.7, 0.9, 0.4, 1.1, -0.2])
SIGNS = np.array([1.0, -1.0, 1.0, 1.0, -1.0, 1.0])
TURNING: tuple[Motion, ...] = tuple((j, True, 1.0, 0.0) for j in range(6))
SLIDING: tuple[Motion, ...] = (*TURNING[:2], (2, False, 1.0, 0.1), *TURNING[3:])
COUPLED: tuple[Motion, ...] = (
    *TURNING[:2],
    (2, True, -1.0, 0.2),
    (2, True, 1.0, 0.0),
    *TURNING[3:],
)


def arm_of(motions: tuple[Motion, ...], size: float = 1.0, **more: Any) -> Arm:
    frames = np.concatenate([FRAMES, FRAMES[1:2]])[: len(motions) + 1]
    dof = 1 + max(j for j, *_ in motions)
    return given_arm(None, chain=chain_of(frames, motions, dof), task=PoseTask(size), **more)


@pytest.mark.parametrize("size", [1.0, 0.4])
@pytest.mark.parametrize("motions", [TURNING, SLIDING, COUPLED])
def test_rows_near_their_solution_arrive(motions: tuple[Motion, ...], size: float) -> None:
    arm = arm_of(motions, size)
    T = forward(arm.chain, ROW)
    for off in (1e-7, 1e-5, 1e-3):
        found = chord_steps(arm, ROW + off * np.array([SIGNS, -SIGNS, np.roll(SIGNS, 1)]), T)
        assert found is not None and np.abs(found - ROW).max() < 1e-12


def test_held_joints_stay() -> None:
    motions: tuple[Motion, ...] = (*TURNING, (6, True, 1.0, 0.0))
    arm = arm_of(
        motions, free=(2,), free_joints=("elbow",), moving=(0, 1, 3, 4, 5, 6), lower=(-7.0,) * 7
    )
    row = np.array([*ROW, 0.5])
    start = row + 1e-4 * np.array([1.0, -1.0, 0.0, 1.0, 1.0, -1.0, 1.0])
    found = chord_steps(arm, start[None], forward(arm.chain, row))
    assert found is not None and np.abs(found - row).max() < 1e-12


def test_two_steps_leave_what_is_of_third_order() -> None:
    arm = arm_of(TURNING)
    T, left = forward(arm.chain, ROW), []
    loose = replace(arm, policy=replace(arm.policy, converged=1.0))
    for off in (4e-3, 2e-3):
        found = chord_steps(loose, (ROW + off * SIGNS)[None], T)
        assert found is not None
        left.append(np.abs(found - ROW).max())
    assert 6.0 < left[0] / left[1] < 10.0


def test_what_may_be_another_solution_is_left_to_others() -> None:
    """Far off, a long step for how near a singularity is, half a turn away, or without a solution."""
    arm = arm_of(TURNING)
    T = forward(arm.chain, ROW)
    assert chord_steps(arm, np.array([ROW, ROW + 0.1 * SIGNS]), T) is None
    turned = T.copy()
    turned[:3, :3] = T[:3, :3] @ np.diag([1.0, -1.0, -1.0])
    assert chord_steps(arm, ROW[None], turned) is None
    beyond = T.copy()
    beyond[:3, 3] *= 1e3
    assert chord_steps(arm, ROW[None], beyond) is None
    assert chord_steps(arm, np.full((1, 6), np.nan), T) is None


def test_beside_folds_it_judges_as_steps_with_new_derivatives_do() -> None:
    frames = np.tile(np.eye(4), (7, 1, 1))
    for k, (twist, x, z) in enumerate(
        [
            (0.0, 0.0, 0.3),
            (1.57, 0.02, 0.0),
            (0.0, 0.5, 0.0),
            (1.57, 0.0, 0.4),
            (-1.57, 0.0, 0.0),
            (1.57, 0.0, 0.0),
            (0.0, 0.0, 0.1),
        ]
    ):
        c, s = math.cos(twist), math.sin(twist)
        frames[k] = [
            [1.0, 0.0, 0.0, x],
            [0.0, c, -s, -s * z],
            [0.0, s, c, c * z],
            [0.0, 0.0, 0.0, 1.0],
        ]
    arm = given_arm(None, chain=chain_of(frames, TURNING, 6))
    told = 0
    for wrist in 10.0 ** np.linspace(-6.0, -1.0, 40):
        row = np.array([0.3, 0.4, 1.2, 0.2, wrist, -0.4])
        start = (row + 1e-4 * SIGNS)[None]
        T = forward(arm.chain, row)
        found = chord_steps(arm, start, T)
        if found is not None:
            told += 1
            end, arrived, _, strained = refine_few(arm, start, T[None])
            assert arrived.all() and not strained.any()
            assert np.abs(found - end).max() < 1e-9
    assert 10 < told < 40
