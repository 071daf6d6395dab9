"""The pose halfway from one to another."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["pose_between"]


def pose_between(a: Array, b: Array) -> Array:
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
    K = np.cross(np.eye(3), axis)
    half = 0.5 * angle
    T[:3, :3] = a[:3, :3] @ (np.eye(3) + np.sin(half) * K + (1.0 - np.cos(half)) * K @ K)
    return T
