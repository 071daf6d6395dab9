"""What of the pose a task reads: its residual, its error in m and rad, and its Jacobian.

Residuals are written in the base link's axes, so the derivative of `task_residual` (target minus
tip) is minus `task_jacobian`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["TASK_SPACES", "TaskSpace"]

Array = NDArray[np.float64]


def _turn(cross: Array, dot: Array) -> Array:
    """Rotation vectors (N, 3) from `sin * axis` (N, 3) and cos (N,); any normal axis at 180
    degrees."""
    sine = np.linalg.norm(cross, axis=1)
    angle = np.arctan2(sine, dot)
    flipped = (sine < 1e-9) & (dot < 0)
    axis = np.where(flipped[:, None], [1.0, 0.0, 0.0], cross)
    sine = np.where(flipped, 1.0, sine)
    scale = np.divide(angle, sine, out=np.ones_like(angle), where=sine > 1e-300)
    return np.asarray(axis * scale[:, None])


def _rotation(T: Array, target: Array) -> Array:
    E = target[:, :3, :3] @ T[:, :3, :3].transpose(0, 2, 1)
    vee = np.stack([E[:, 2, 1] - E[:, 1, 2], E[:, 0, 2] - E[:, 2, 0], E[:, 1, 0] - E[:, 0, 1]], 1)
    return _turn(vee / 2, (np.trace(E, axis1=1, axis2=2) - 1) / 2)


def _direction(T: Array, target: Array) -> Array:
    z, wanted = T[:, :3, 2], target[:, :3, 2]
    return _turn(np.cross(z, wanted), np.einsum("ni,ni->n", z, wanted))


def _yaw(T: Array, target: Array) -> Array:
    difference = [np.arctan2(X[:, 1, 0], X[:, 0, 0]) for X in (target, T)]
    return np.asarray(
        (np.remainder(difference[0] - difference[1] + np.pi, 2 * np.pi) - np.pi)[:, None]
    )


def _rotation_rows(T: Array, J: Array) -> Array:
    return J[:, 3:]


def _direction_rows(T: Array, J: Array) -> Array:
    """Angular velocity without its part about the tool's z axis."""
    z = T[:, :3, 2]
    along = np.einsum("ni,nij->nj", z, J[:, 3:])
    return np.asarray(J[:, 3:] - z[:, :, None] * along[:, None, :])


def _yaw_rows(T: Array, J: Array) -> Array:
    x = T[:, :3, 0]
    velocity = np.cross(J[:, 3:], x[:, :, None], axis=1)
    squared = np.maximum(x[:, 0] ** 2 + x[:, 1] ** 2, 1e-12)[:, None]
    rate = (x[:, 0, None] * velocity[:, 1] - x[:, 1, None] * velocity[:, 0]) / squared
    return np.asarray(rate[:, None, :])


_Residual = Callable[[Array, Array], Array]


@dataclass(frozen=True, slots=True)
class TaskSpace:
    """One task. `rank` is its number of independent equations; `position` says whether it reads the
    tip's position; `orientation` names what it reads of the rotation ("", rotation, direction,
    yaw)."""

    name: str
    rank: int
    position: bool
    orientation: str

    def residual(self, T: Array, target: Array) -> Array:
        """Target minus tip, (N, m): position in m, then orientation as a rotation vector in rad."""
        parts = [target[:, :3, 3] - T[:, :3, 3]] if self.position else []
        if self.orientation:
            parts.append(_ORIENTATIONS[self.orientation][0](T, target))
        return np.concatenate(parts, axis=1)

    def jacobian(self, T: Array, J: Array) -> Array:
        """Task Jacobian (N, m, dof) from poses (N, 4, 4) and geometric Jacobians (N, 6, dof)."""
        parts = [J[:, :3]] if self.position else []
        if self.orientation:
            parts.append(_ORIENTATIONS[self.orientation][1](T, J))
        return np.concatenate(parts, axis=1)

    def errors(self, T: Array, target: Array) -> tuple[Array, Array]:
        """Distance (N,) in m and angle (N,) in rad between T and target, zero for what is not
        read."""
        zero = np.zeros(len(T))
        position = np.linalg.norm(T[:, :3, 3] - target[:, :3, 3], axis=1) if self.position else zero
        if not self.orientation:
            return np.asarray(position), zero
        turn = _ORIENTATIONS[self.orientation][0](T, target)
        return np.asarray(position), np.linalg.norm(turn, axis=1)


_ORIENTATIONS: dict[str, tuple[_Residual, _Residual]] = {
    "rotation": (_rotation, _rotation_rows),
    "direction": (_direction, _direction_rows),
    "yaw": (_yaw, _yaw_rows),
}

TASK_SPACES = {
    space.name: space
    for space in (
        TaskSpace("pose", 6, True, "rotation"),
        TaskSpace("position", 3, True, ""),
        TaskSpace("position-direction", 5, True, "direction"),
        TaskSpace("position-yaw", 4, True, "yaw"),
        TaskSpace("rotation", 3, False, "rotation"),
        TaskSpace("direction", 2, False, "direction"),
    )
}
