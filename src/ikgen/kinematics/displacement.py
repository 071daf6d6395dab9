"""Small rigid motions in generic directions."""

from __future__ import annotations

import numpy as np

from ikgen.kinematics.fixed_order import length
from ikgen.kinematics.rigid import inverse, rotation_about
from ikgen.model.arrays import Array

__all__ = ["displacements"]


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
    """The motion with a rotation vector and a translation."""
    angle = length(twist[:3])
    T = np.eye(4)
    T[:3, :3] = rotation_about(twist[:3] / angle, angle)
    T[:3, 3] = twist[3:]
    return T
