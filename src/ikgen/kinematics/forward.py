"""Forward kinematics of the chain in DH form and of the file's own, for one configuration or many.

`q` is (dof,) or (..., dof), in rad and m, in the order of `joints`; poses are (4, 4) or
(..., 4, 4).
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.rigid import dh_link, z_motion
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain

__all__ = [
    "RowConstants",
    "dh_forward",
    "dh_frames",
    "file_forward",
    "file_jacobian",
    "file_slopes",
    "pose_difference",
    "row_constant",
    "row_values",
]


class _Constant(Protocol):
    @property
    def value(self) -> float: ...


class RowConstants(Protocol):
    """The constants of a DH row: a chain's, or as a table has them."""

    @property
    def alpha(self) -> _Constant:
        """In rad."""

    @property
    def a(self) -> _Constant:
        """In m."""

    @property
    def theta(self) -> _Constant:
        """In rad."""

    @property
    def d(self) -> _Constant:
        """In m."""


def dh_forward(dh: DHChain, q: ArrayLike) -> Array:
    """`X_base A_1 ... A_n X_tip` of the exact DH rows."""
    values = row_values(dh, q)
    T = dh.X_base
    for i, row in enumerate(dh.rows):
        T = product(T, row_constant(row), z_motion(row.revolute, values[..., i]))
    return np.asarray(product(T, dh.X_tip))


def dh_frames(dh: DHChain) -> tuple[Array, ...]:
    """The n + 1 constants (4, 4) of the exact DH rows, as `file_frames` has those of the file's chain."""
    first, *others = (row_constant(row) for row in dh.rows)
    return (product(dh.X_base, first), *others, dh.X_tip)


def file_forward(dh: DHChain, q: ArrayLike) -> Array:
    """`F_0 M_1 F_1 ... M_n F_n`: the file's own pose, from the DH variables."""
    values = row_values(dh, q)
    T = dh.file_frames[0]
    for i, row in enumerate(dh.rows):
        T = product(T, z_motion(row.revolute, values[..., i]), dh.file_frames[i + 1])
    return np.asarray(T)


def file_jacobian(dh: DHChain, q: ArrayLike) -> Array:
    """Geometric Jacobian (..., 6, dof) of the file's chain at the tip's origin, in the base frame.

    Rows are linear (m/rad or m/m), then angular velocity (rad/rad), the order of Pinocchio.
    """
    values = row_values(dh, q)
    T = dh.file_frames[0]
    lines = []
    for i, row in enumerate(dh.rows):
        lines.append((T[..., :3, 2], T[..., :3, 3]))
        T = product(T, z_motion(row.revolute, values[..., i]), dh.file_frames[i + 1])
    J = np.zeros((*values.shape[:-1], 6, dh.dof))
    for row, (z, origin) in zip(dh.rows, lines, strict=True):
        if row.revolute:
            J[..., :3, row.driver] += row.scale * np.cross(z, T[..., :3, 3] - origin)
            J[..., 3:, row.driver] += row.scale * z
        else:
            J[..., :3, row.driver] += row.scale * z
    return J


def file_slopes(dh: DHChain, q: ArrayLike) -> Array:
    """How the entries of the file's pose change with the joints: (..., 3, 4, dof), per rad and m."""
    T, J = file_forward(dh, q), file_jacobian(dh, q)
    slopes = np.empty((*T.shape[:-2], 3, 4, dh.dof))
    slopes[..., :3, :] = np.cross(J[..., 3:, None, :], T[..., :3, :3, None], axis=-3)
    slopes[..., 3, :] = J[..., :3, :]
    return slopes


def row_values(dh: DHChain, q: ArrayLike) -> Array:
    """The DH variables (..., n), offsets included, at joint values `q` (..., dof)."""
    values = np.asarray(q, dtype=np.float64)
    scale = np.array([row.scale for row in dh.rows])
    offset = np.array([row.offset.value for row in dh.rows])
    return np.asarray(scale * values[..., [row.driver for row in dh.rows]] + offset)


def row_constant(row: RowConstants) -> Array:
    """`Rx(alpha) Tx(a) Rz(theta) Tz(d)` (4, 4) with the row's variable at 0."""
    return dh_link(row.alpha.value, row.a.value, row.theta.value, row.d.value)


def pose_difference(T_one: Array, T_other: Array) -> tuple[float, float]:
    """Largest distance (m) and angle (rad) between poses (..., 4, 4); small angles stay exact."""
    distance = np.linalg.norm(T_one[..., :3, 3] - T_other[..., :3, 3], axis=-1)
    chord = np.linalg.norm(T_one[..., :3, :3] - T_other[..., :3, :3], axis=(-2, -1))
    angle = 2 * np.arcsin(np.minimum(1.0, chord / (2 * math.sqrt(2))))
    return float(np.max(distance)), float(np.max(angle))
