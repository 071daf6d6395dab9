"""A search for all configurations of a pose that knows nothing of closed forms or eliminations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.elimination.routine import runtime_policy
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arm.chain_kinematics import Motion, chain_of
from ikgen.runtime.python.arm.whole_pose import PoseTask
from ikgen.runtime.python.newton.refinement import newton
from ikgen.runtime.python.rows.solution_rows import distinct_rows

__all__ = ["apart", "searched"]

Array = NDArray[np.float64]
_STARTS = 600
_SLIDES = 4.0  # lengths of the arm
_POLICY = runtime_policy(SolvePolicy())


def searched(
    frames: Array,
    motions: tuple[Motion, ...],
    turning: tuple[bool, ...],
    length: float,
    pose: Array,
    seed: int,
) -> Array:
    """Configurations (k, 6) of a pose: where Newton's method ends from random starts; fails without any.
    `frames` and `motions` as `chain_of` takes them, `length` (m): what positions are taken relative to."""
    F, T = frames.copy(), pose.copy()
    F[:, :3, 3] /= length
    T[:3, 3] /= length
    reach = np.where(turning, np.pi, _SLIDES)
    starts = np.random.default_rng(seed).uniform(-reach, reach, (_STARTS, 6))
    poses = np.broadcast_to(T, (_STARTS, 4, 4))
    chain, task = chain_of(F, motions, 6), PoseTask(1.0)
    q, error, *_ = newton(chain, task, range(6), starts, poses, 40, _POLICY)
    ends = q[error < _POLICY.arrived]
    assert len(ends), "the search found nothing to compare"
    pose_of = np.zeros(len(ends), dtype=np.intp)
    rows = distinct_rows(ends, pose_of, turning, _POLICY.coincident)[0]
    return np.asarray(rows * np.where(turning, 1.0, length))


def apart(rows: Array, q: Array, turning: tuple[bool, ...] = (True,) * 6) -> Array:
    """Largest difference (rad or m) between q (6,) and each of rows (k, 6); whole turns count as none."""
    gap = rows - q
    turned = np.remainder(gap + np.pi, 2.0 * np.pi) - np.pi
    return np.asarray(np.abs(np.where(turning, turned, gap)).max(axis=1))
