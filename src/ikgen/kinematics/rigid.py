"""Rigid transforms as matrices: rotations (3, 3), poses (4, 4), angles in rad, lengths in m.

Functions of joint values take one value or an array (...,) of them and give (..., 4, 4).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ikgen.kinematics.fixed_order import cosines, product, sines
from ikgen.model.arrays import Array

__all__ = [
    "axis_motion",
    "coordinate_motion",
    "cross_matrix",
    "dh_link",
    "exact_cos_sin",
    "inverse",
    "read_only",
    "rotation_about",
    "rotation_rpy",
    "rotation_x",
    "rotation_z",
    "z_motion",
]

_EXACT = 5e-16
"""What round-off leaves of a cosine or sine that is 0, 1/2 or 1."""


def inverse(T: Array) -> Array:
    """The inverses (..., 4, 4) of rigid transforms, their rotations without round-off."""
    out = _identities(T.shape[:-2])
    out[..., :3, :3] = np.swapaxes(T[..., :3, :3], -1, -2)
    out[..., :3, 3:] = -product(out[..., :3, :3], T[..., :3, 3:])
    return out


def exact_cos_sin(angle: float) -> tuple[float, float]:
    """Cosine and sine of `angle` (rad), with 0, ±1/2 and ±1 exact at multiples of pi/12."""
    c, s = math.cos(angle), math.sin(angle)
    half_c, half_s = round(2 * c) / 2, round(2 * s) / 2
    return (half_c if abs(c - half_c) < _EXACT else c, half_s if abs(s - half_s) < _EXACT else s)


def rotation_x(angle: float) -> Array:
    """Rotation (3, 3) about x by `angle` (rad)."""
    c, s = exact_cos_sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rotation_z(angle: float) -> Array:
    """Rotation (3, 3) about z by `angle` (rad)."""
    c, s = exact_cos_sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def rotation_rpy(roll: float, pitch: float, yaw: float) -> Array:
    """`Rz(yaw) Ry(pitch) Rx(roll)` (3, 3), URDF's rpy in rad."""
    (cr, sr), (cp, sp), (cy, sy) = map(exact_cos_sin, (roll, pitch, yaw))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def cross_matrix(v: Array) -> Array:
    """The matrix (3, 3) that maps w to v × w."""
    x, y, z = (float(part) for part in v)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def rotation_about(axis: Array, angle: ArrayLike) -> Array:
    """Rotations (..., 3, 3) about the unit vector `axis` (3,) by `angle` (...,), rad (Rodrigues'
    formula; Lynch and Park, Modern Robotics, section 3.2.3)."""
    K = cross_matrix(axis)
    angles = np.asarray(angle, dtype=np.float64)[..., None, None]
    return np.asarray(np.eye(3) + (sines(angles) * K + (1.0 - cosines(angles)) * product(K, K)))


def axis_motion(revolute: bool, axis: Array, value: ArrayLike) -> Array:
    """Rotation about or translation along the unit vector `axis` (3,), (..., 4, 4)."""
    T = _identities(np.shape(value))
    if revolute:
        T[..., :3, :3] = rotation_about(axis, value)
    else:
        T[..., :3, 3] = np.asarray(value)[..., None] * axis
    return T


def coordinate_motion(revolute: bool, axis: int, value: ArrayLike) -> Array:
    """Rotation about or translation along x, y or z (`axis` 0, 1, 2), (..., 4, 4)."""
    T = _identities(np.shape(value))
    if not revolute:
        T[..., axis, 3] = value
        return T
    i, j = (axis + 1) % 3, (axis + 2) % 3
    T[..., i, i] = T[..., j, j] = cosines(value)
    T[..., j, i] = sines(value)
    T[..., i, j] = -T[..., j, i]
    return T


def z_motion(revolute: bool, value: ArrayLike) -> Array:
    """Rotation about or translation along z, (..., 4, 4)."""
    return coordinate_motion(revolute, 2, value)


def dh_link(alpha: ArrayLike, a: ArrayLike, theta: ArrayLike, d: ArrayLike) -> Array:
    """`Rx(alpha) Tx(a) Rz(theta) Tz(d)` (..., 4, 4): a row of modified Denavit-Hartenberg parameters
    (Craig, Introduction to Robotics, section 3.4), each a number or an array (...,)."""
    (ca, sa), (ct, st) = _cos_sin(alpha), _cos_sin(theta)
    rows = (
        (ct, -st, 0.0, a),
        (st * ca, ct * ca, -sa, -np.asarray(d) * sa),
        (st * sa, ct * sa, ca, d * ca),
    )
    T = _identities(np.broadcast_shapes(*map(np.shape, (alpha, a, theta, d))))
    for i, row in enumerate(rows):
        for j, entry in enumerate(row):
            T[..., i, j] = entry
    return T


def _cos_sin(angle: ArrayLike) -> tuple[Any, Any]:
    if np.ndim(angle):
        return cosines(angle), sines(angle)
    return exact_cos_sin(float(np.asarray(angle)))


def read_only(matrix: ArrayLike) -> Array:
    """A copy of a matrix that nothing can write to."""
    copy = np.array(matrix, dtype=np.float64)
    copy.setflags(write=False)
    return copy


def _identities(shape: tuple[int, ...]) -> Array:
    T = np.zeros((*shape, 4, 4))
    T[..., range(4), range(4)] = 1.0
    return T
