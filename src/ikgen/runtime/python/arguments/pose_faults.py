"""What is wrong with a pose that is not read, and the rotation that one with few digits stands for."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite, sqrt

import numpy as np

from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.task_interface import Task
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.arrays.orthonormal_columns import columns_defect, determinant

__all__ = ["nearest_pose", "nearest_poses", "pose_fault", "too_far"]

_PRINTED = 1e-3  # how far the entries of a rotation that was printed with a few digits may be off


def nearest_pose(task: Task, T: list[list[float]], policy: Policy) -> list[list[float]]:
    """The pose with the nearest rotation; as it is where that is too far."""
    lines = task.read(T, replace(policy, pose_tolerance=_PRINTED))
    if lines is not None:
        return lines
    out: list[list[float]] = nearest_poses(task, np.array([T]), policy)[0].tolist()
    return out


def nearest_poses(task: Task, T: Array, policy: Policy) -> Array:
    """The nearest poses of T (N, 4, 4), as `nearest_pose` has them."""
    near, good = task.read_batch(_at_origin(T), replace(policy, pose_tolerance=_PRINTED))
    out: Array = np.where(good[:, None, None], near, T)
    out[:, :3, 3] = T[:, :3, 3]
    return out


def too_far(task: Task, T: Array, policy: Policy) -> Flags:
    """Which of T (N, 4, 4) that the task does not read are poses whose position is beyond all reach."""
    return task.read_batch(_at_origin(T), policy)[1]


def _at_origin(T: Array) -> Array:
    """The poses with positions at 0, but for what is no number of them."""
    out: Array = T.copy()
    out[:, :3, 3][np.isfinite(T[:, :3, 3])] = 0.0
    return out


def pose_fault(task: Task, T: list[list[float]], policy: Policy) -> str:
    """Why a pose is none."""
    if not all(isfinite(x) for row in T[:3] for x in row):
        return "the pose has entries that are not finite"
    if T[3] != [0.0, 0.0, 0.0, 1.0]:
        return f"the pose's last row is {T[3]}, not [0, 0, 0, 1]"
    R = [(x, y, z) for x, y, z in zip(*T[:3])]
    columns = tuple(R[j] for j in task.unit)
    if len(columns) == 3 and determinant(columns) < 0.0:
        return "the pose's rotation is a reflection: its determinant is negative"
    if not columns:
        return "the pose has entries that no rotation has"
    defect = sqrt(columns_defect(columns))
    off = (sqrt(1.0 + defect) - 1.0) / sqrt(3.0 * len(columns))
    text = f"the pose's rotation is off by {off:.1e}, more than {policy.pose_tolerance:.0e}"
    if task.read(T, replace(policy, pose_tolerance=_PRINTED)) is None:
        return f"{text}, and than the {_PRINTED:.0e} of orthonormalize (norm 1 of a quaternion?)"
    return f"{text}: solve(pose, orthonormalize=True) takes the nearest one"
