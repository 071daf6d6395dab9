"""The nearest pose that the arm can take, of one that it cannot.

What is least is `|p - p'|^2 / size^2 + chord^2`, the chord that of the rotation, direction or heading that
the task reads (for a turn by x: 2 sin(x / 2)). Damped Gauss-Newton steps inside the limits (Levenberg 1944,
Marquardt 1963), from many starts; those that come nearest in a few steps are followed to the end.
"""

from __future__ import annotations

from math import asin, inf, sqrt

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import forward, tip_and_jacobian
from ikgen.runtime.python.arm.entry_differences import entry_errors, entry_rows
from ikgen.runtime.python.arm.limit_margins import turned_inside
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arm.task_interface import Task
from ikgen.runtime.python.arrays.array_types import Array, Flags, Row

__all__ = ["chord_costs", "descended", "nearest_row", "nearest_rows", "off_by"]

_START_COUNT = 256  # starts that are drawn
_FIRST_STEPS = 12  # steps of each start: where they begin tells little of where they lead
_FEW_STEPS = 4  # steps of each start where a row takes the pose, or none is wanted
_FOLLOWED = 16
_STEP_COUNT = 80
_LEAST_DAMPING, _FIRST_DAMPING, _MOST_DAMPING = 1e-10, 1e-3, 1e10  # damping of a step
_FINEST = 1e-15  # damping of a step along directions in which the pose hardly moves
_LONGEST_STEP = 0.5  # rad or m: step of a joint
_ROUND_OFF = 1e-16  # over what is least: a step that gains less ends the descent
_STANDING = 1e-6  # over what is least and not 0: a step that gains less ends the descent


def nearest_row(arm: Arm, T: Array, start: Row, limits: bool, beyond: Array) -> Row:
    """The joint values whose pose is nearest to T (4, 4), held joints as in `start`. `beyond` (k, dof): the
    rows that take it outside the limits, beside which it may be where no other start leads."""
    bounds = _step_bounds(arm, limits)
    q = _begun(arm, T[None], np.array([start]), bounds, _ROUND_OFF, _FIRST_STEPS, _START_COUNT)
    beside = np.clip(turned_inside(arm, beyond), *bounds)
    beside[:, list(arm.free)] = q[0, list(arm.free)]
    q = np.concatenate([q, beside])
    q = _least_of(1, *_descend_to(arm, T[None].repeat(len(q), axis=0), q, bounds, _ROUND_OFF), 1)
    best: Row = tuple(q[0].tolist())
    return best


def nearest_rows(
    arm: Arm, T: Array, start: Array, limits: bool, flat: bool, starts: int = _START_COUNT
) -> Array:
    """`nearest_row` of poses T (k, 4, 4), each with its start (k, dof) and other `starts`, if `flat` along
    directions too in which the pose hardly moves; hardly of such as no row takes."""
    bounds = _step_bounds(arm, limits)
    begun = _begun(arm, T, start, bounds, _STANDING, _FEW_STEPS, starts)
    aims = np.repeat(T, _FOLLOWED, axis=0)
    q, cost = _descend_to(arm, aims, begun, bounds, _STANDING)
    if flat:
        rows = np.concatenate([q, begun])
        q, cost = _descend_to(arm, np.tile(aims, (2, 1, 1)), rows, bounds, _STANDING, floor=_FINEST)
        q, cost = (x.reshape(2, len(T), _FOLLOWED, -1).swapaxes(0, 1) for x in (q, cost))
    return _least_of(len(T), q.reshape(-1, start.shape[1]), cost.reshape(-1), 1)


def _begun(
    arm: Arm,
    T: Array,
    start: Array,
    bounds: tuple[Array, Array],
    enough: float,
    steps: int,
    starts: int,
) -> Array:
    """Where, of each pose, the steps are of those of its starts that come nearest to it."""
    q = np.concatenate([_starts(arm, row, bounds, starts) for row in start])
    ends = _descend_to(arm, np.repeat(T, len(q) // len(T), axis=0), q, bounds, enough, steps)
    return _least_of(len(T), *ends, _FOLLOWED)


def _least_of(poses: int, q: Array, cost: Array, count: int) -> Array:
    """The rows q (n, dof) with the least cost (n,), in that order, of as many of each of some poses."""
    best = np.argsort(cost.reshape(poses, -1), axis=1, kind="stable")[:, :count]
    rows = np.take_along_axis(q.reshape(poses, -1, q.shape[1]), best[:, :, None], axis=1)
    return rows.reshape(-1, q.shape[1])


def _starts(arm: Arm, start: Array, bounds: tuple[Array, Array], count: int) -> Array:
    """Configurations (1 + count, dof): the one that is given (dof,), and others, held joints as there."""
    q = np.vstack([np.clip(start, *bounds), _even_starts(arm, *bounds, count)])
    q[:, list(arm.free)] = start[list(arm.free)]
    return q


def chord_costs(arm: Arm, T: Array, q: Array) -> Array:
    """What is least (k,), of rows q (k, dof) for one pose T (4, 4), or for each its own (k, 4, 4)."""
    return np.asarray((_chord_errors(arm.task, forward(arm.chain, q), T) ** 2).sum(axis=1))


def descended(arm: Arm, T: Array, q: Array, limits: bool, flat: bool = False) -> Array:
    """The joint values (k, dof) at which steps from q (k, dof) towards poses T (k, 4, 4) end, if they take
    these, if `flat` along directions too in which the pose hardly moves."""
    bounds = _step_bounds(arm, limits)
    floor = _FINEST if flat else _LEAST_DAMPING
    return _descend_to(arm, T, np.clip(q, *bounds), bounds, _STANDING, floor=floor)[0]


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
    """Weight of each entry: a turn by x moves the nine of a rotation by sqrt(8) sin(x / 2)."""
    turn = sqrt(0.5) if len(task.unit) == 3 else 1.0
    return np.array([1.0 / task.size if c == 3 else turn for _, c in task.entries])


def _chord_errors(task: Task, pose: Array, T: Array) -> Array:
    """What poses (k, 4, 4) are off T (4, 4) or (k, 4, 4): (k, entries)."""
    return entry_errors(task.entries, _chord_weight(task), pose, np.broadcast_to(T, pose.shape))


def _step_bounds(arm: Arm, limits: bool) -> tuple[Array, Array]:
    """Where steps are clipped to."""
    low, high = np.array(arm.lower), np.array(arm.upper)
    return (low, high) if limits else (np.full(len(low), -inf), np.full(len(low), inf))


def _even_starts(arm: Arm, low: Array, high: Array, count: int) -> Array:
    """Configurations (count, dof) that fill the limits evenly: Kronecker's sequence by powers of the root
    of `x^(dof + 1) = x + 1` (Roberts 2018)."""
    dof = len(low)
    root = 2.0
    for _ in range(40):
        root = (1.0 + root) ** (1.0 / (dof + 1))
    steps = (1.0 / root) ** np.arange(1, dof + 1)
    part = (0.5 + np.arange(1, count + 1)[:, None] * steps) % 1.0
    period = np.array(arm.period)
    half = np.where(period > 0.0, 0.5 * period, arm.task.size)
    centre = np.clip(0.0, low + half, np.maximum(high - half, low + half))
    least, most = np.maximum(low, centre - half), np.minimum(high, centre + half)
    return np.asarray(least + part * (most - least))


def _descend_to(
    arm: Arm,
    T: Array,
    q: Array,
    bounds: tuple[Array, Array],
    enough: float,
    steps: int = _STEP_COUNT,
    floor: float = _LEAST_DAMPING,
) -> tuple[Array, Array]:
    """The rows (k, dof) at the ends of so many steps towards poses T (k, 4, 4), and what is least there
    (k,). They end where one that is hardly damped gains a share of that which is not `enough`."""
    moving, weight = list(arm.moving), _chord_weight(arm.task)
    low, high = (bound[moving] for bound in bounds)

    def state(q: Array, T: Array) -> tuple[Array, ...]:
        pose, J = tip_and_jacobian(arm.chain, q)
        error = _chord_errors(arm.task, pose, T)
        slope = entry_rows(arm.task.entries, weight, pose, J)[:, :, moving]
        return q, error, slope, (error**2).sum(axis=1)

    ends, costs, going = q.copy(), np.full(len(q), inf), np.arange(len(q))
    at, damping = state(q, T), np.full(len(q), _FIRST_DAMPING)
    for _ in range(steps):
        q, error, slope, cost = at
        trial = q.copy()
        trial[:, moving], gain = _clipped_step(q[:, moving], slope, error, damping, (low, high))
        there = state(trial, T)
        better = there[-1] < cost
        at = tuple(np.where(_beside(better, new), new, old) for new, old in zip(there, at))
        ends[going], costs[going] = at[0], at[-1]
        on = (gain > enough * cost) | (damping > _FIRST_DAMPING)
        damping = np.clip(damping * np.where(better, 0.2, 8.0), floor, _MOST_DAMPING)
        on &= damping < _MOST_DAMPING
        if not on.any():
            break
        going, damping, T = going[on], damping[on], T[on]
        at = tuple(x[on] for x in at)
    return ends, costs


def _beside(flags: Flags, values: Array) -> Flags:
    """Flags (k,) with as many axes as values (k, ...)."""
    return flags.reshape(-1, *(1,) * (values.ndim - 1))


def _clipped_step(
    q: Array, slope: Array, error: Array, damping: Array, bounds: tuple[Array, Array]
) -> tuple[Array, Array]:
    """The rows (k, n) after one step, in which joints at a limit that it would pass stay, and what linear
    equations have it gain (k,)."""
    push = np.einsum("kmj,km->kj", slope, error)
    stuck = ((q <= bounds[0]) & (push < 0.0)) | ((q >= bounds[1]) & (push > 0.0))
    slope, push = np.where(stuck[:, None], 0.0, slope), np.where(stuck, 0.0, push)
    normal = np.einsum("kmi,kmj->kij", slope, slope) + damping[:, None, None] * np.eye(q.shape[1])
    step = np.linalg.solve(normal, push[:, :, None])[:, :, 0]
    gain = np.einsum("kj,kj->k", push, step)
    return np.clip(q + np.clip(step, -_LONGEST_STEP, _LONGEST_STEP), *bounds), gain
