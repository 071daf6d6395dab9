"""Small rigid motions in generic directions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.kinematics.rigid import inverse

__all__ = ["displacements"]

Array = NDArray[np.float64]

_DIRECTIONS = (
    (0.31, -0.52, 0.17, 0.44, 0.61, -0.23),
    (-0.47, -0.11, 0.58, -0.35, 0.21, 0.51),
    (0.19, 0.63, 0.41, -0.29, 0.37, -0.42),
)
"""Rotation vectors and translations, no two parallel, none along an axis; about of unit length."""


def displacements(size: float) -> tuple[Array, ...]:
    """Six rigid motions (4, 4) of about `size` (rad and m together), each with its inverse."""
    moves = [_motion(size * np.array(direction)) for direction in _DIRECTIONS]
    return tuple(D for move in moves for D in (move, inverse(move)))


def _motion(twist: Array) -> Array:
    """The motion with a rotation vector and a translation (Rodrigues' formula)."""
    x, y, z = twist[:3]
    angle = float(np.linalg.norm(twist[:3]))
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]) / angle
    T = np.eye(4)
    T[:3, :3] += np.sin(angle) * K + (1.0 - np.cos(angle)) * K @ K
    T[:3, 3] = twist[3:]
    return T
