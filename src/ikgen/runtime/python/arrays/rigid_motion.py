"""Rigid transforms in arrays."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["inverses", "motions_z", "rotations_z"]


def rotations_z(t: Array) -> Array:
    """Rotations about z by t (...): (..., 4, 4)."""
    R = np.zeros((*np.shape(t), 4, 4))
    R[..., 0, 0] = R[..., 1, 1] = np.cos(t)
    R[..., 1, 0] = np.sin(t)
    R[..., 0, 1] = -R[..., 1, 0]
    R[..., 2, 2] = R[..., 3, 3] = 1.0
    return R


def motions_z(d: Array) -> Array:
    """Motions along z by d (...): (..., 4, 4)."""
    X = np.zeros((*np.shape(d), 4, 4))
    X[..., (0, 1, 2, 3), (0, 1, 2, 3)] = 1.0
    X[..., 2, 3] = d
    return X


def inverses(T: Array) -> Array:
    """Inverses of rigid transforms (..., 4, 4)."""
    G = np.zeros_like(T)
    G[..., :3, :3] = np.swapaxes(T[..., :3, :3], -1, -2)
    G[..., :3, 3:] = -G[..., :3, :3] @ T[..., :3, 3:]
    G[..., 3, 3] = 1.0
    return G
