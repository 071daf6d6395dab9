"""A 6R chain as seven constant transforms: `T = F_0 Rz(v_1) F_1 ... Rz(v_6) F_6`."""

from __future__ import annotations

import numpy as np

from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.rigid import z_motion
from ikgen.model.dh import DHChain
from ikgen.model.joint_tree import Matrix

__all__ = ["forward", "held_frames", "hold_joint", "jacobian", "typical_length"]


def held_frames(dh: DHChain, value: float = 0.0) -> Matrix:
    """The file's own chain (n + 1, 4, 4) between the DH variables (rad) of its n moving joints, the
    free ones held at `value` (rad or m).

    Raises ValueError where a moving joint is prismatic or drives several rows.
    """
    held = [dh.joints[row.driver].name in dh.free for row in dh.rows]
    moving = [row for row, still in zip(dh.rows, held, strict=True) if not still]
    if not all(row.revolute for row in moving) or len(dh.rows) != dh.dof:
        raise ValueError("the universal solver is for revolute joints")
    frames = np.array(dh.file_frames, dtype=np.float64)
    for j in reversed([j for j, still in enumerate(held) if still]):
        frames = hold_joint(frames, j, value, revolute=dh.rows[j].revolute)
    return frames


def hold_joint(frames: Matrix, joint: int, value: float, *, revolute: bool = True) -> Matrix:
    """The chain (n, 4, 4) that is left of (n + 1, 4, 4) with joint `joint` (0-based) held at
    `value` rad or m."""
    merged = product(frames[joint], z_motion(revolute, value), frames[joint + 1])
    return np.concatenate([frames[:joint], merged[None], frames[joint + 2 :]])


def typical_length(frames: Matrix) -> float:
    """Sum of the distances between the axes' frames (m), at least 1e-9: the scale of the arm."""
    return max(float(np.linalg.norm(frames[1:-1, :3, 3], axis=1).sum()), 1e-9)


def forward(frames: Matrix, angles: Matrix) -> Matrix:
    """Pose (4, 4) at the joint angles (n,) in rad."""
    T = frames[0]
    for frame, angle in zip(frames[1:], angles, strict=True):
        T = product(T, z_motion(True, angle), frame)
    return np.asarray(T)


def jacobian(frames: Matrix, angles: Matrix) -> Matrix:
    """Geometric Jacobian (6, n) at the angles (n,): linear rows over the typical length, then
    angular."""
    axes, T = [], frames[0]
    for frame, angle in zip(frames[1:], angles, strict=True):
        axes.append((T[:3, 2], T[:3, 3]))
        T = product(T, z_motion(True, angle), frame)
    scale = typical_length(frames)
    columns = [np.r_[np.cross(z, T[:3, 3] - p) / scale, z] for z, p in axes]
    return np.asarray(np.array(columns).T)
