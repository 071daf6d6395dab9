"""Poses with values of a held joint of their own, in one stack and each alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ikgen.elimination.routine import runtime_policy
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arm.chain_kinematics import Motion, forward
from ikgen.runtime.python.elimination.general_6r import Plan, six_joint_rows
from ikgen.runtime.python.elimination.six_joints import six_joints

__all__ = ["assert_solved_as_each_alone"]


def assert_solved_as_each_alone(
    plan: Plan,
    frames: NDArray[np.float64],
    motions: Sequence[Motion],
    place: int,
    held: NDArray[np.float64],
    rng: np.random.Generator,
    atol: float,
) -> None:
    """Of a chain with a turning joint, held at `held` (k, 1), put in after `place` of its motions."""
    chain = np.insert(frames, place + 1, np.eye(4), axis=0)
    moved = (*motions[:place], (6, True, 1.0, 0.0), *motions[place:])
    six = six_joints(chain, plan.length, moved, held)
    q = np.concatenate([rng.uniform(-3.0, 3.0, (len(held), 6)), held], axis=1)
    T = forward(six.chain, q)
    T[:, :3, 3] *= plan.length
    policy = runtime_policy(SolvePolicy())
    pose, rows, _ = six_joint_rows(six, plan, T, policy)
    for k in range(len(held)):
        one = six_joints(chain, plan.length, moved, held[k : k + 1])
        _, alone, _ = six_joint_rows(one, plan, T[k : k + 1], policy)
        assert len(alone) >= 1
        np.testing.assert_allclose(rows[pose == k], alone, atol=atol)
