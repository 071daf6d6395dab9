"""Configurations to put emitted modules through, by the emitted functions alone: random ones, joints at
multiples of 45 degrees, one joint beside a multiple of 90 degrees; and how singular they are."""

from __future__ import annotations

import zlib
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

__all__ = ["draw", "held_joints", "revolute", "smallest_singular"]

Array = NDArray[np.float64]

FAR = 1e3
"""Limits beyond this (rad or m) mean "none"."""
NEAREST = 10
"""One joint is put up to 10^-10 beside a multiple of 90 degrees."""


def revolute(module: ModuleType) -> NDArray[np.bool_]:
    """Which joints turn (dof,): their columns of the Jacobian have an angular part."""
    q = np.full(len(module.LOWER), 0.3)
    return np.asarray(np.abs(module.jacobian(q)[3:]).max(axis=0) > 1e-12)


def held_joints(module: ModuleType) -> list[int]:
    """The numbers of the joints that are held, in the order of their values."""
    return [module.JOINT_NAMES.index(name) for name in module.FREE_JOINTS]


def draw(module: ModuleType, key: str, count: int) -> Array:
    """Configurations (count, dof) inside the limits, the same for the same key: half of them random, a
    quarter with joints at multiples of 45 degrees, a quarter with one joint beside a right angle."""
    rng = np.random.default_rng(zlib.crc32(key.encode()))
    turning = revolute(module)
    lower, upper = (np.array(x, dtype=float) for x in (module.LOWER, module.UPPER))
    half = np.where(turning, np.pi, 1.0)
    low = np.where(np.abs(lower) > FAR, -half, np.maximum(lower, -np.where(turning, np.pi, np.inf)))
    high = np.where(np.abs(upper) > FAR, half, np.minimum(upper, np.where(turning, np.pi, np.inf)))
    low, high = np.where(low > high, lower, low), np.where(low > high, upper, high)
    q = rng.uniform(low, high, (count, len(low)))
    special, near = slice(count // 2, 3 * count // 4), slice(3 * count // 4, count)
    q[special] = _on_grid(q[special], np.pi / 4, rng.random(q[special].shape) < 0.8, turning)
    chosen = np.zeros(q[near].shape, dtype=bool)
    places = np.flatnonzero(turning) if turning.any() else np.arange(len(low))
    chosen[np.arange(len(chosen)), rng.choice(places, len(chosen))] = True
    beside = 10.0 ** -rng.integers(1, NEAREST + 1, chosen.shape) * rng.choice([-1.0, 1.0])
    q[near] = _on_grid(q[near], np.pi / 2, chosen, turning) + np.where(chosen, beside, 0.0)
    return np.asarray(np.clip(q, low, high))


def _on_grid(q: Array, step: float, chosen: NDArray[np.bool_], turning: NDArray[np.bool_]) -> Array:
    return np.asarray(np.where(chosen & turning, step * np.round(q / step), q))


def smallest_singular(module: ModuleType, q: Array) -> Array:
    """Smallest singular value (N,) of the Jacobian's rows that the task reads, in the joints that are
    not held; lengths in units of the arm's reach."""
    free = held_joints(module)
    active = [j for j in range(len(module.LOWER)) if j not in free]
    tips = module.forward(np.random.default_rng(0).uniform(-1.0, 1.0, (64, len(module.LOWER))))
    size = max(float(np.linalg.norm(tips[:, :3, 3], axis=1).max()), 1e-3)
    unit = np.where(revolute(module), 1.0, size)
    values = []
    for row in q:
        J = module.jacobian(row) * unit
        J[:3] /= size
        axis = getattr(module, "TOOL_AXIS", "z")
        rows = _task_rows(module.TASK, axis, J, module.forward(row))[:, active]
        values.append(np.linalg.svd(rows, compute_uv=False))
    return np.array([v[min(_FREEDOMS.get(module.TASK, 6), len(active)) - 1] for v in values])


_FREEDOMS = {
    "pose": 6, "position": 3, "position-direction": 5, "position-yaw": 4, "position-pitch": 4,
    "rotation": 3, "direction": 2,
}  # fmt: skip


def _task_rows(task: str, axis: str, J: Array, T: Array) -> Array:
    """The rows that the task reads; all of them for a task not known here."""
    z = T[:3, "xyz".index(axis)]
    direction = J[3:] - np.outer(z, z @ J[3:])
    chosen = {
        "position": J[:3],
        "position-direction": np.vstack([J[:3], direction]),
        "position-yaw": np.vstack([J[:3], J[5:]]),
        "position-pitch": np.vstack([J[:3], np.cross(J[3:].T, z).T[2:]]),
        "rotation": J[3:],
        "direction": direction,
    }
    return np.asarray(chosen.get(task, J))
