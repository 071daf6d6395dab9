"""Rotations as unit quaternions w, x, y, z and back."""

from __future__ import annotations

import numpy as np

from ikgen.kinematics.fixed_order import length
from ikgen.model.arrays import Array

__all__ = ["quaternion", "rotation"]


def quaternion(R: Array) -> Array:
    """w, x, y, z (4,) with w >= 0 of a rotation (3, 3): the eigenvector of the largest eigenvalue of
    Bar-Itzhack's matrix (New method for extracting the quaternion from a rotation matrix, 2000)."""
    (a, b, c), (d, e, f), (g, h, i) = R.tolist()
    K = np.array([
        [a + e + i, h - f, c - g, d - b],
        [h - f, a - e - i, b + d, c + g],
        [c - g, b + d, e - a - i, f + h],
        [d - b, c + g, f + h, i - a - e],
    ])  # fmt: skip
    found = np.linalg.eigh(K)[1][:, -1]
    return np.asarray(-found if found[0] < 0 else found)


def rotation(q: Array) -> Array:
    """The rotation (3, 3) of a quaternion w, x, y, z (4,), which need not be of length 1."""
    w, x, y, z = (q / length(q)).tolist()
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
