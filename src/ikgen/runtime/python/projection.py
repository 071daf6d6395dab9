"""The nearest pose that the arm can take, of one that it cannot.

What is least is `|p - p'|^2 / size^2 + chord^2`, the chord that of the rotation, direction or heading that
the task reads (for a turn by x: 2 sin(x / 2)). Damped Gauss-Newton steps inside the limits (Levenberg 1944,
Marquardt 1963), from the best of many starts.
"""

from __future__ import annotations

from math import asin, inf, pi, sqrt

import numpy as np

from ikgen.runtime.python.array_types import Array, Row
from ikgen.runtime.python.chain_kinematics import forward, tip_and_jacobian
from ikgen.runtime.python.entry_differences import entry_errors, entry_rows
from ikgen.runtime.python.solved_arm import Arm
from ikgen.runtime.python.task_interface import Task

__all__ = ["chord_costs", "descended", "nearest_row", "off_by"]

_START_COUNT = 128  # drawn; the best of them are followed
_FOLLOWED = 16
_STEP_COUNT = 80
_LEAST_DAMPING, _FIRST_DAMPING, _MOST_DAMPING = 1e-10, 1e-3, 1e10  # damping of a step
_LONGEST_STEP = 0.5  # rad or m: step of a joint


def nearest_row(arm: Arm, T: Array, start: Row, limits: bool) -> Row:
    """The joint values whose pose is nearest to T (4, 4), held joints as in `start`."""
    low, high = _step_bounds(arm, limits)
    q = np.vstack([np.clip(start, low, high), _even_starts(arm, low, high)])
    q[:, list(arm.free)] = [start[j] for j in arm.free]
    cost = chord_costs(arm, T, q)
    q, cost = _descend_to(arm, T, q[np.argsort(cost, kind="stable")[:_FOLLOWED]], (low, high))
    best: Row = tuple(q[int(np.argmin(cost))].tolist())
    return best


def chord_costs(arm: Arm, T: Array, q: Array) -> Array:
    """What is least (k,), of rows q (k, dof) for one pose T (4, 4), or for each its own (k, 4, 4)."""
    return np.asarray((_chord_errors(arm.task, forward(arm.chain, q), T) ** 2).sum(axis=1))


def descended(arm: Arm, T: Array, q: Array, limits: bool) -> Array:
    """The joint values (k, dof) at which steps from q (k, dof) towards poses T (k, 4, 4) end."""
    bounds = _step_bounds(arm, limits)
    return _descend_to(arm, T, np.clip(q, *bounds), bounds)[0]


def off_by(task: Task, pose: Array, T: Array) -> Array:
    """How far poses (k, 4, 4) are from T (4, 4): (k, 2), m and rad."""
    error = _chord_errors(task, pose, T)
    length = np.array([c == 3 for _, c in task.entries])
    off = np.empty((len(pose), 2))
    off[:, 0] = np.sqrt((error[:, length] ** 2).sum(axis=1)) * task.size
    if task.unit:
        chord = np.sqrt((error[:, ~length] ** 2).sum(axis=1))
        off[:, 1] = 2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))
    else:  # single entries are sines of angles to the base's planes
        gaps = [
            np.arcsin(pose[:, r, c].clip(-1.0, 1.0)) - asin(T[r, c])
            for r, c in task.entries
            if c < 3
        ]
        off[:, 1] = np.sqrt(sum(gap**2 for gap in gaps))
    return off


def _chord_weight(task: Task) -> Array:
    """Of each entry: a turn by x moves the nine of a rotation by sqrt(8) sin(x / 2)."""
    turn = sqrt(0.5) if len(task.unit) == 3 else 1.0
    return np.array([1.0 / task.size if c == 3 else turn for _, c in task.entries])


def _chord_errors(task: Task, pose: Array, T: Array) -> Array:
    """What poses (k, 4, 4) are off T (4, 4) or (k, 4, 4): (k, entries)."""
    return entry_errors(task.entries, _chord_weight(task), pose, np.broadcast_to(T, pose.shape))


def _step_bounds(arm: Arm, limits: bool) -> tuple[Array, Array]:
    """Where steps are clipped to."""
    low, high = np.array(arm.lower), np.array(arm.upper)
    return (low, high) if limits else (np.full(len(low), -inf), np.full(len(low), inf))


def _even_starts(arm: Arm, low: Array, high: Array) -> Array:
    """Configurations (n, dof) that fill the limits evenly: Kronecker's sequence by powers of the root of
    `x^(dof + 1) = x + 1` (Roberts 2018)."""
    dof = len(low)
    root = 2.0
    for _ in range(40):
        root = (1.0 + root) ** (1.0 / (dof + 1))
    steps = (1.0 / root) ** np.arange(1, dof + 1)
    part = (0.5 + np.arange(1, _START_COUNT + 1)[:, None] * steps) % 1.0
    half = np.where(arm.chain.revolute, pi, arm.task.size)
    centre = np.clip(0.0, low + half, np.maximum(high - half, low + half))
    least, most = np.maximum(low, centre - half), np.minimum(high, centre + half)
    return np.asarray(least + part * (most - least))


def _descend_to(arm: Arm, T: Array, q: Array, bounds: tuple[Array, Array]) -> tuple[Array, Array]:
    """The rows (k, dof) at the ends of the steps, and what is least there (k,)."""
    moving, damping = list(arm.moving), np.full(len(q), _FIRST_DAMPING)
    low, high = (bound[moving] for bound in bounds)
    pose, J = tip_and_jacobian(arm.chain, q)
    error = _chord_errors(arm.task, pose, T)
    cost = (error**2).sum(axis=1)
    for _ in range(_STEP_COUNT):
        trial = q.copy()
        slope = entry_rows(arm.task.entries, _chord_weight(arm.task), pose, J)[:, :, moving]
        trial[:, moving] = _clipped_step(q[:, moving], slope, error, damping, (low, high))
        new = (trial, *tip_and_jacobian(arm.chain, trial))
        errors = _chord_errors(arm.task, new[1], T)
        costs = (errors**2).sum(axis=1)
        better = costs < cost
        q[better], error[better], cost[better] = trial[better], errors[better], costs[better]
        pose, J = (np.where(better[:, None, None], a, b) for a, b in zip(new[1:], (pose, J)))
        damping = np.clip(damping * np.where(better, 0.2, 8.0), _LEAST_DAMPING, _MOST_DAMPING)
        if damping.min() == _MOST_DAMPING:
            break
    return q, cost


def _clipped_step(
    q: Array, slope: Array, error: Array, damping: Array, bounds: tuple[Array, Array]
) -> Array:
    """The rows (k, n) after one step; joints at a limit that it would pass stay."""
    push = np.einsum("kmj,km->kj", slope, error)
    stuck = ((q <= bounds[0]) & (push < 0.0)) | ((q >= bounds[1]) & (push > 0.0))
    slope = np.where(stuck[:, None], 0.0, slope)
    normal = np.einsum("kmi,kmj->kij", slope, slope) + damping[:, None, None] * np.eye(q.shape[1])
    step = np.linalg.solve(normal, np.where(stuck, 0.0, push)[:, :, None])[:, :, 0]
    return np.asarray(np.clip(q + np.clip(step, -_LONGEST_STEP, _LONGEST_STEP), *bounds))
