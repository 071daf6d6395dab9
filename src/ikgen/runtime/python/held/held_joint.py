"""An arm with one held joint, at many values of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, pi
from typing import Any

import numpy as np

from ikgen.runtime.python.arguments.pose_arguments import one_pose
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.solving.closed_form_rows import careful_rows, certain_rows

__all__ = ["HeldJoint", "Rows", "held_range", "merged_rows", "pose_lines", "rows_at"]

BranchesAndFolds = Callable[
    [Array, Array, Array, "list[Array]"], tuple[Array, Flags, Flags, Flags, Flags]
]


@dataclass(frozen=True)
class HeldJoint:
    """`branches_and_folds`: the arm's closed form, which adds to a list what is positive where rows are
    real; `guarded`: whether that is all that makes rows come and go."""

    arm: Arm
    branches_and_folds: BranchesAndFolds
    guarded: bool

    @property
    def poses(self) -> int:
        """At how many poses the closed form gives rows: the one asked for, and those beside it."""
        return _poses(self.arm)

    @property
    def margins_tell(self) -> bool:
        """Whether rows come and go where those are 0: a rounded arm's do so beside."""
        return self.guarded and not self.arm.rounded


@dataclass(frozen=True)
class Rows:
    """At values `held` (n,) of the held joint, ascending: rows `q` (n, m, dof), which of them are `real`
    (n, m), and what is positive where they are, `folds` (n, m, k)."""

    held: Array
    q: Array
    real: Flags
    folds: Array


def rows_at(joint: HeldJoint, T: Array, held: Array) -> Rows:
    """The rows of a pose T (4, 4) at values of the held joint, without limits."""
    count, parts = len(held), list[list[Array]]()

    def branches(
        poses: Array, q0: Array, values: Array
    ) -> tuple[Array, Flags, Flags, Flags, Flags]:
        parts.append([])
        return joint.branches_and_folds(poses, q0, values, parts[-1])

    arm = replace(joint.arm, branches_batch=branches)
    q, real = _all_rows(arm, np.broadcast_to(T, (count, 4, 4)), held[:, None])
    folds = np.full((*real.shape, len(parts[0])), inf)
    for k, margins in enumerate(zip(*parts)):
        values = np.concatenate(margins)[:count]  # what follows is of poses beside
        folds[:, : values.shape[1], k] = values
    return Rows(held, q, real, folds)


def _all_rows(arm: Arm, T: Array, held: Array) -> tuple[Array, Flags]:
    """Rows (n, m, dof), and which of them are solutions: those of the closed form first, then those of
    poses beside; no more than `solve` gives."""
    if arm.together is None:
        q, real, _ = careful_rows(arm, T, held, None)
    else:
        some, sure, doubt = certain_rows(arm, arm.together, T, held, None)
        size = some.shape[1] * _poses(arm)
        q = np.zeros((len(T), size, some.shape[2]))
        real = np.zeros(q.shape[:2], dtype=bool)
        q[:, : some.shape[1]], real[:, : some.shape[1]] = some, sure
        if doubt.any():
            q[doubt], real[doubt], _ = careful_rows(arm, T[doubt], held[doubt], None)
    return q, real & (np.cumsum(real, axis=1) <= arm.most)


def _poses(arm: Arm) -> int:
    return 1 + len(arm.beside) * arm.policy.beside_anywhere


def merged_rows(one: Rows, other: Rows) -> Rows:
    """Both, in the order of the held joint's values."""
    held = np.concatenate([one.held, other.held])
    order = np.argsort(held, kind="stable")
    q, folds = (
        np.concatenate(pair)[order] for pair in ((one.q, other.q), (one.folds, other.folds))
    )
    return Rows(held[order], q, np.concatenate([one.real, other.real])[order], folds)


def held_range(arm: Arm, T: Array, limits: bool) -> tuple[float, float]:
    """Values of the held joint that count: its limits; one turn where it turns without any, or none are
    asked for. A slide without limits is looked at as far as the arm's lengths reach from the pose."""
    if not arm.free:
        return -pi, pi
    (j,) = arm.free
    low, high = arm.lower[j], arm.upper[j]
    if half := 0.5 * arm.period[j]:
        return (low, high) if limits and high - low < inf else (-half, half)
    lengths = np.linalg.norm(arm.chain.frames[:, :3, 3], axis=1).sum()
    slides = sum(
        max(abs(a), abs(b))
        for a, b, turns in zip(arm.lower, arm.upper, arm.period)
        if not turns and b - a < inf
    )
    far = float(np.linalg.norm(T[:3, 3]) + lengths + slides)
    return max(low, -far), min(high, far)


def pose_lines(arm: Arm, pose: Any) -> Array | None:
    """A pose as it is read, (4, 4); None for what is no pose. Raises ValueError for a wrong shape."""
    T = arm.task.read(one_pose(pose, arm.task.alone).tolist(), arm.policy)
    return None if T is None else np.array(T)
