"""Joint values along a path of poses, on one branch."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.chain_kinematics import tip_and_jacobian
from ikgen.runtime.python.held_shift import Shift, limit_excess, shifted
from ikgen.runtime.python.joint_arguments import seed_rows
from ikgen.runtime.python.pose_solving import solve_pose
from ikgen.runtime.python.solutions import Status
from ikgen.runtime.python.solved_arm import Arm

__all__ = ["Path", "follow_poses"]

_DEEPEST = 24  # of the way from one pose to the next
_FARTHEST = 0.3  # rad or m that a joint may move at once
_OFF = 0.2  # of the motion, and
_LEAST_OFF = 1e-4  # rad or m: how far a row may be from where the Jacobian leads
_DAMPING = 1e-8  # of directions that are all but lost
_JUMP = 0.05  # rad or m that a row may be from the last one where halving does not help


@dataclass(frozen=True)
class Path:
    """Joint values `q` (N, DOF) along N poses, on one branch and without leaps of whole turns; NaN from the first
    that was not reached. `reached`: how many were; `status`: OK for all of them, else why the next was not,
    SINGULAR where its rows are a leap away. `singular` (N,): the row is at a singularity, or was reached across
    one."""

    q: Array
    reached: int
    status: Status
    singular: Flags


def follow_poses(
    arm: Arm, shift: Shift | None, poses: ArrayLike, start: ArrayLike, limits: bool
) -> Path:
    """From the row of the first pose (N, 4, 4) that is nearest to `start` (dof,). Raises ValueError for bad
    arguments."""
    T, dof = np.asarray(poses, dtype=float), len(arm.lower)
    if T.ndim != 3 or T.shape[1:] != (4, 4):
        raise ValueError(f"poses have shape {T.shape}, expected (N, 4, 4)")
    row = seed_rows(arm, start, (dof,))
    q, singular = np.full((len(T), dof), np.nan), np.zeros(len(T), dtype=bool)
    walk = _Walk(arm, shift, limits)
    for i, pose in enumerate(T):
        if arm.task.read(pose.tolist(), arm.policy) is None:
            return Path(q, i, Status.INVALID, singular)
        walk.crossed = False
        if i == 0:
            status = walk.begin(pose, row)
        else:
            status = walk.step(T[i - 1], pose, 0)
            if status is Status.OK:
                status = walk.keep_inside(pose)
        if status is not Status.OK:
            return Path(q, i, status, singular)
        q[i], singular[i] = walk.q, walk.crossed
    return Path(q, len(T), Status.OK, singular)


class _Walk:
    """`q`: where the arm is; `crossed`: whether it came across a singularity since that was last unset."""

    def __init__(self, arm: Arm, shift: Shift | None, limits: bool) -> None:
        self.arm, self.shift, self.limits = arm, shift, limits
        self.q: Array = np.zeros(len(arm.lower))
        self.crossed = False

    def begin(self, pose: Array, start: Array) -> Status:
        """To the row nearest to the start."""
        self.q = start
        found = solve_pose(self.arm, pose, None, start, self.limits)
        if len(found):
            self.q, self.crossed = found.q[0], bool(found.singular[0])
            return Status.OK
        row = None if self.shift is None else self.shift.search(pose, start, self.limits)
        if row is None:
            return found.status
        self.q = row
        return Status.OK

    def step(self, before: Array, pose: Array, depth: int) -> Status:
        """From a pose to the next, with halved steps where the rows do not follow the Jacobian."""
        expected = self._expected(pose)
        rows, flags, status = self._rows(pose, expected)
        if len(rows):
            gap = np.abs(rows - expected).max(axis=1)
            k = int(gap.argmin())
            moved = float(np.abs(rows[k] - self.q).max())
            if moved < _FARTHEST and gap[k] < _LEAST_OFF + _OFF * moved:
                self.q, self.crossed = rows[k], self.crossed or bool(flags[k])
                return Status.OK
            if depth == _DEEPEST:
                if moved > _JUMP:
                    return Status.SINGULAR
                self.q, self.crossed = rows[k], True
                return Status.OK
        if depth == _DEEPEST or (depth > 8 and not len(rows)):
            return status if not len(rows) else Status.SINGULAR
        middle = _between(before, pose)
        first = self.step(before, middle, depth + 1)
        if first is Status.OK:
            first = self.keep_inside(middle) if self.shift is not None else first
        return first if first is not Status.OK else self.step(middle, pose, depth + 1)

    def keep_inside(self, pose: Array) -> Status:
        """Held joints are moved so that the row stays inside the limits, and clear of where its branch ends."""
        if self.shift is not None:
            self.q = shifted(self.arm, self.shift, pose, self.q, self.limits)
        if self.limits and limit_excess(self.arm, self.q) > self.arm.policy.limit_tolerance:
            return Status.LIMITS
        if self.limits:
            self.q = np.clip(self.q, self.arm.lower, self.arm.upper)
        return Status.OK

    def _rows(self, pose: Array, expected: Array) -> tuple[Array, Flags, Status]:
        """All rows with the held joints where they are expected."""
        held = expected[list(self.arm.free)].tolist()
        found = solve_pose(self.arm, pose, held, self.q, False)
        return found.q, found.singular, found.status

    def _expected(self, pose: Array) -> Array:
        """Where the shortest motion by the Jacobian leads from here, held joints inside their limits."""
        arm = self.arm
        here, J = tip_and_jacobian(arm.chain, self.q[None])
        error, rows = arm.task.error(here, pose[None])[0], arm.task.rows(here, J)[0]
        normal = rows @ rows.T + _DAMPING * np.eye(len(rows))
        expected = self.q + np.clip(rows.T @ np.linalg.solve(normal, error), -1.0, 1.0)
        for j in arm.free if self.limits else ():
            expected[j] = min(max(expected[j], arm.lower[j]), arm.upper[j])
        return np.asarray(expected)


def _between(a: Array, b: Array) -> Array:
    """The pose halfway (4, 4): the middle of the positions, half of the turn between (its axis by the
    antisymmetric part, or the largest column of the symmetric one for half turns)."""
    T = 0.5 * (a + b)
    R = a[:3, :3].T @ b[:3, :3]
    w = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    sine, cosine = 0.5 * float(np.linalg.norm(w)), 0.5 * (float(np.trace(R)) - 1.0)
    angle = float(np.arctan2(sine, cosine))
    if sine > 1e-6:
        axis = w / (2.0 * sine)
    elif cosine > 0.0:
        return np.asarray(np.where(np.arange(4) == 3, T, a))
    else:
        S = R + np.eye(3)
        column = S[:, int(np.argmax(np.diag(S)))]
        axis = column / np.linalg.norm(column)
    K = np.cross(np.eye(3), -axis)
    half = 0.5 * angle
    T[:3, :3] = a[:3, :3] @ (np.eye(3) + np.sin(half) * K + (1.0 - np.cos(half)) * K @ K)
    return T
