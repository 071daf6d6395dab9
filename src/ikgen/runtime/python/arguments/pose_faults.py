"""What is wrong with a pose that is none, and the rotation that one with few digits stands for."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite, sqrt

import numpy as np

from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.task_interface import Task
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.arrays.orthonormal_columns import columns_defect, determinant

__all__ = ["nearest_pose", "nearest_poses", "pose_fault"]

_PRINTED = 1e-3  # how far the entries of a rotation that was printed with a few digits may be off


def nearest_pose(task: Task, T: list[list[float]], policy: Policy) -> list[list[float]]:
    """The pose with the nearest rotation; as it is where that is too far."""
    return task.read(T, replace(policy, pose_tolerance=_PRINTED)) or T


def nearest_poses(task: Task, T: Array, policy: Policy) -> Array:
    """The same of T (N, 4, 4)."""
    near, good = task.read_batch(T, replace(policy, pose_tolerance=_PRINTED))
    return np.where(good[:, None, None], near, T)


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
        return f"{text} (a quaternion is to have norm 1)"
    return f"{text}: orthonormalize=True takes the nearest one"
