"""A chain of six joints as seven constant transforms: `T = F_0 M(v_1) F_1 ... M(v_6) F_6`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.rigid import z_motion
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain

__all__ = ["forward", "held_frames", "hold_joint", "jacobian", "over", "typical_length"]

_LEAST_WITH_SLIDES = 0.1  # m


def held_frames(dh: DHChain, value: float = 0.0) -> Array:
    """The file's own chain (n + 1, 4, 4) between the DH variables (rad or m) of its n moving rows, the
    free joints held at `value` (rad or m).

    Raises ValueError where a held joint drives several rows.
    """
    held = [dh.joints[row.driver].name in dh.free for row in dh.rows]
    if sum(held) != len(dh.free):
        raise ValueError("the eliminations are for held joints that drive one row each")
    frames = np.array(dh.file_frames, dtype=np.float64)
    for j in reversed([j for j, still in enumerate(held) if still]):
        frames = hold_joint(frames, j, value, revolute=dh.rows[j].revolute)
    return frames


def hold_joint(frames: Array, joint: int, value: float, *, revolute: bool = True) -> Array:
    """The chain (n, 4, 4) that is left of (n + 1, 4, 4) with joint `joint` (0-based) held at
    `value` rad or m."""
    merged = product(frames[joint], z_motion(revolute, value), frames[joint + 1])
    return np.concatenate([frames[:joint], merged[None], frames[joint + 2 :]])


def typical_length(frames: Array, turning: Sequence[bool] | None = None) -> float:
    """Sum of the distances between the axes' frames (m): the scale of the arm. It is at least 0.1 m where a
    joint slides, as slides alone may give an arm its size."""
    least = 1e-9 if turning is None or all(turning) else _LEAST_WITH_SLIDES
    return max(float(np.linalg.norm(frames[1:-1, :3, 3], axis=1).sum()), least)


def over(frames: Array, length: float) -> Array:
    """Transforms (..., 4, 4) with lengths over one (m)."""
    scaled: Array = frames.copy()
    scaled[..., :3, 3] /= length
    return scaled


def forward(frames: Array, values: Array, turning: Sequence[bool] | None = None) -> Array:
    """Poses (..., 4, 4) at joint values (..., n), rad or m; `turning` (None: all) says which turn."""
    T = frames[0]
    each = np.moveaxis(values, -1, 0)
    for frame, turns, value in zip(frames[1:], _kinds(each, turning), each, strict=True):
        T = product(T, z_motion(turns, value), frame)
    return np.asarray(T)


def jacobian(frames: Array, values: Array, turning: Sequence[bool] | None = None) -> Array:
    """Geometric Jacobians (..., 6, n) at the values (..., n): linear rows over the typical length, then
    angular; of slides by their value over that length."""
    axes, each = [], np.moveaxis(values, -1, 0)
    T = np.broadcast_to(frames[0], (*values.shape[:-1], 4, 4))
    for frame, turns, value in zip(frames[1:], _kinds(each, turning), each, strict=True):
        axes.append((turns, T[..., :3, 2], T[..., :3, 3]))
        T = product(T, z_motion(turns, value), frame)
    scale = typical_length(frames, turning)
    columns = [
        np.concatenate(
            [np.cross(z, T[..., :3, 3] - p) / scale, z] if turns else [z, np.zeros_like(z)], axis=-1
        )
        for turns, z, p in axes
    ]
    return np.stack(columns, axis=-1)


def _kinds(values: Array, turning: Sequence[bool] | None) -> Sequence[bool]:
    return (True,) * len(values) if turning is None else turning
