"""What of the pose a task reads: its residual, its error in m and rad, and its Jacobian.

Residuals are written in the base link's axes, so the derivative of `TaskSpace.residual` (target minus
tip) is minus `TaskSpace.jacobian`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ikgen.model.arrays import Array
from ikgen.program.policy import LEVEL
from ikgen.tasks import AXES, Task

__all__ = ["TaskSpace", "task_space"]


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


def _rotation(T: Array, target: Array, axis: int) -> Array:
    E = target[:, :3, :3] @ T[:, :3, :3].transpose(0, 2, 1)
    vee = np.stack([E[:, 2, 1] - E[:, 1, 2], E[:, 0, 2] - E[:, 2, 0], E[:, 1, 0] - E[:, 0, 1]], 1)
    return _turn(vee / 2, (np.trace(E, axis1=1, axis2=2) - 1) / 2)


def _direction(T: Array, target: Array, axis: int) -> Array:
    z, wanted = T[:, :3, axis], target[:, :3, axis]
    return _turn(np.cross(z, wanted), np.einsum("ni,ni->n", z, wanted))


def _pitch(T: Array, target: Array, axis: int) -> Array:
    """Differences of the elevation's sine, which is what the pose has."""
    return np.asarray((target[:, 2, axis] - T[:, 2, axis])[:, None])


def _yaw(T: Array, target: Array, axis: int) -> Array:
    """Differences of what the pose has of the heading, which a tilt shortens, but for the little that a
    rounded file tilts it."""
    both = np.stack([target[:, :2, axis], T[:, :2, axis]])
    square = (both**2).sum(axis=2, keepdims=True)
    wanted, there = both / np.where((square >= 1.0 - LEVEL).all(axis=0), np.sqrt(square), 1.0)
    return np.asarray(wanted - there)


def _rotation_rows(T: Array, J: Array, axis: int) -> Array:
    return J[:, 3:]


def _direction_rows(T: Array, J: Array, axis: int) -> Array:
    """Angular velocity without its part about the tool's axis."""
    z = T[:, :3, axis]
    along = np.einsum("ni,nij->nj", z, J[:, 3:])
    return np.asarray(J[:, 3:] - z[:, :, None] * along[:, None, :])


def _pitch_rows(T: Array, J: Array, axis: int) -> Array:
    return _entry_rows(T, J, ((2, axis),))


def _yaw_rows(T: Array, J: Array, axis: int) -> Array:
    return _entry_rows(T, J, ((0, axis), (1, axis)))


def _entry_rows(T: Array, J: Array, entries: tuple[tuple[int, int], ...]) -> Array:
    """Derivatives of single entries of the pose."""
    rows = []
    for r, c in entries:
        turn = np.cross(J[:, 3:], T[:, :3, min(c, 2), None], axis=1)
        rows.append(J[:, r] if c == 3 else turn[:, r])
    return np.stack(rows, axis=1)


_Residual = Callable[[Array, Array, int], Array]


@dataclass(frozen=True, slots=True)
class TaskSpace:
    """One task. `rank` is its number of independent equations; `position` says whether it reads the
    tip's position; `orientation` names what it reads of the rotation ("", rotation, direction,
    yaw, pitch), all but rotation by the tool's `axis` (0 to 2); or else `entries` of the pose
    (row, column) count each for itself."""

    name: str
    rank: int
    position: bool
    orientation: str
    entries: tuple[tuple[int, int], ...] = ()
    axis: int = 2

    @property
    def lengths(self) -> list[int]:
        """Which components of the residual are in m."""
        own = [i for i, (_, column) in enumerate(self.entries) if column == 3]
        return [*range(3), *own] if self.position else own

    def residual(self, T: Array, target: Array) -> Array:
        """Target minus tip, (N, m): position in m, then orientation as a rotation vector in rad."""
        parts = [target[:, :3, 3] - T[:, :3, 3]] if self.position else []
        if self.orientation:
            parts.append(_ORIENTATIONS[self.orientation][0](T, target, self.axis))
        if self.entries:
            rows, columns = zip(*self.entries, strict=True)
            parts.append(target[:, rows, columns] - T[:, rows, columns])
        return np.concatenate(parts, axis=1)

    def jacobian(self, T: Array, J: Array) -> Array:
        """Task Jacobian (N, m, dof) from poses (N, 4, 4) and geometric Jacobians (N, 6, dof)."""
        parts = [J[:, :3]] if self.position else []
        if self.orientation:
            parts.append(_ORIENTATIONS[self.orientation][1](T, J, self.axis))
        if self.entries:
            parts.append(_entry_rows(T, J, self.entries))
        return np.concatenate(parts, axis=1)

    def errors(self, T: Array, target: Array) -> tuple[Array, Array]:
        """Distance (N,) in m and angle (N,) in rad between T and target, zero for what is not
        read."""
        zero = np.zeros(len(T))
        if self.entries:
            difference = self.residual(T, target)
            lengths = np.isin(np.arange(difference.shape[1]), self.lengths)
            return (
                np.asarray(np.linalg.norm(difference[:, lengths], axis=1)),
                np.asarray(np.linalg.norm(difference[:, ~lengths], axis=1)),
            )
        position = np.linalg.norm(T[:, :3, 3] - target[:, :3, 3], axis=1) if self.position else zero
        if not self.orientation:
            return np.asarray(position), zero
        turn = _ORIENTATIONS[self.orientation][0](T, target, self.axis)
        return np.asarray(position), np.linalg.norm(turn, axis=1)


_ORIENTATIONS: dict[str, tuple[_Residual, _Residual]] = {
    "rotation": (_rotation, _rotation_rows),
    "direction": (_direction, _direction_rows),
    "yaw": (_yaw, _yaw_rows),
    "pitch": (_pitch, _pitch_rows),
}


def task_space(task: Task) -> TaskSpace:
    """How a task is verified."""
    if task.orientation == "entries":
        return TaskSpace(task.name, task.freedoms, False, "", task.entries)
    axis = AXES.index(task.axis) if task.axis else 2
    return TaskSpace(task.name, task.freedoms, task.position, task.orientation, axis=axis)
