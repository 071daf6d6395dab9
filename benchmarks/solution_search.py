"""An independent search for all solutions of a pose: Newton's method from many random starts, on an emitted
module's own forward kinematics and Jacobian alone."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from benchmarks.drawn import revolute

__all__ = ["apart", "searched"]

Array = NDArray[np.float64]

_STARTS = 300
_MOST_ROUNDS = 12
_REPEATS = 2  # rounds without a new solution after which the search ends
_MORE_ROUNDS = 100  # where fewer are found than are known to exist
_STEPS = 40
_CLOSED = 1e-10
_SAME = 1e-5


def apart(q: Array, rows: Array, turning: NDArray[np.bool_]) -> Array:
    """Largest difference (k,) between q (dof,) and rows (k, dof), whole turns aside; long slides relative
    to their length."""
    gap = np.abs(rows - q)
    turned = np.abs(np.pi - np.abs(np.pi - gap % (2.0 * np.pi)))
    return np.asarray(
        np.where(turning, turned, gap / np.maximum(np.abs(q), 1.0)).max(axis=1, initial=0.0)
    )


def searched(
    module: ModuleType, pose: Array, rng: np.random.Generator, reach: float, *, least: int = 0
) -> Array:
    """The distinct solutions (k, dof) that are found; slides start within `reach` (m), some up to a hundred
    times as far. Where fewer than `least` are, more random starts follow."""
    turning = revolute(module)
    found = np.zeros((0, len(turning)))
    quiet = 0
    for done in range(_MORE_ROUNDS):
        if len(found) >= least and (quiet >= _REPEATS or done >= _MOST_ROUNDS):
            break
        known = len(found)
        bound = np.where(turning, np.pi, reach)
        starts = rng.uniform(-bound, bound, (_STARTS, len(turning)))
        farther = 10.0 ** rng.uniform(-1.0, 2.0, (_STARTS // 2, 1))
        starts[::2] *= np.where(turning, 1.0, farther)
        for q in _refined(module, starts, pose):
            if not len(found) or apart(q, found, turning).min() > _SAME:
                found = np.vstack([found, q])
        quiet = quiet + 1 if len(found) == known else 0
    return found


def _refined(module: ModuleType, q: Array, pose: Array) -> Array:
    """Damped steps from q (k, dof); those that arrive at the pose."""
    for _ in range(_STEPS):
        error = _error(module, q, pose)
        worst = np.abs(error).max(axis=1)
        J = module.jacobian(q)
        Jt = np.swapaxes(J, -1, -2)
        damping = 1e-3 * np.minimum(worst, 1.0) ** 2 + 1e-14
        normal = Jt @ J + damping[:, None, None] * np.eye(q.shape[1])
        step = np.linalg.solve(normal, Jt @ error[..., None])[..., 0]
        size = np.abs(step[:, revolute(module)]).max(axis=1, initial=0.0)
        q = q + step * np.minimum(1.0, 0.6 / np.maximum(size, 1e-300))[:, None]
    return np.asarray(q[np.abs(_error(module, q, pose)).max(axis=1) < _CLOSED])


def _error(module: ModuleType, q: Array, pose: Array) -> Array:
    T = module.forward(q)
    R = pose[:3, :3] @ np.swapaxes(T[..., :3, :3], -1, -2)
    axis = np.stack(
        [R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]], -1
    )
    opposite = np.trace(R, axis1=-2, axis2=-1)[..., None] < 0.0
    sizes = np.maximum(np.linalg.norm(axis, axis=-1, keepdims=True), 1e-300)
    turned = np.where(opposite, axis / sizes, 0.5 * axis)
    return np.concatenate([pose[:3, 3] - T[..., :3, 3], turned], axis=-1)
