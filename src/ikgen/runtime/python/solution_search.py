"""The best rows of a pose over all values of the held joints."""

from __future__ import annotations

from functools import partial
from math import inf

import numpy as np

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.batch_solving import rows_batch
from ikgen.runtime.python.held_parameters import held_of
from ikgen.runtime.python.pose_solving import solve_pose
from ikgen.runtime.python.row_branches import branch_names
from ikgen.runtime.python.row_links import differences
from ikgen.runtime.python.row_preference import Preference, preference_costs
from ikgen.runtime.python.solutions import Solutions, Status, no_solutions
from ikgen.runtime.python.solved_arm import Arm

__all__ = ["Start", "best_rows"]

Start = tuple[tuple[float, ...], Array, tuple[float, ...], int]
"""Values of the held joints, a row there, the first steps of each value, and the number of its group."""

_HALVINGS = 30
_LEAST_STEP = 1e-10  # rad or m
_NEAR = 0.5  # rad or m that a row may be from the one that a step began at


def best_rows(
    arm: Arm, T: Array, starts: list[Start], preference: Preference, limits: bool
) -> Solutions:
    """From each start the best row that a compass search (Hooke, Jeeves 1961) of the held values finds
    on its branch; of each group the best, best first, at most as many as `solve` gives."""
    held = np.array([s[0] for s in starts])
    rows = np.array([s[1] for s in starts])
    step = np.array([s[2] for s in starts])
    _, cost, _ = preference_costs(arm, preference, rows[:, None], limits)
    best = cost[:, 0]
    for _ in range(_HALVINGS):
        going = np.flatnonzero(step.max(axis=1) > _LEAST_STEP)
        if not len(going):
            break
        moved = np.zeros(len(going), dtype=bool)
        now = held[going], rows[going], best[going]
        for k in range(held.shape[1]):
            for sign in (1.0, -1.0):
                trial = now[0].copy()
                trial[:, k] += sign * step[going, k]
                moved |= _improved(arm, T, preference, limits, now, trial)
        held[going], rows[going], best[going] = now
        step[going[~moved]] *= 0.5 if held.shape[1] > 1 else 0.4
    groups = np.array([s[3] for s in starts])
    out: list[int] = []
    for i in np.argsort(best, kind="stable").tolist():
        if groups[i] not in groups[out] and len(out) < arm.most:
            out.append(i)
    return _solutions(arm, T, preference, limits, held[out], rows[out])


def _improved(
    arm: Arm,
    T: Array,
    preference: Preference,
    limits: bool,
    now: tuple[Array, Array, Array],
    trial: Array,
) -> Flags:
    """Takes trials (n, held joints) that are better, in place; which were."""
    held, rows, best = now
    if limits and arm.free:
        low, high = np.array(arm.lower)[list(arm.free)], np.array(arm.upper)[list(arm.free)]
        trial = np.clip(trial, low, high)
    q, real = rows_batch(arm, np.broadcast_to(T, (len(trial), 4, 4)), trial)
    gap = np.abs(differences(arm, rows[:, None], q)).max(axis=2)
    gap = np.where(real, gap, inf)
    which, nearest = np.arange(len(trial)), gap.argmin(axis=1)
    row = q[which, nearest]
    _, cost, inside = preference_costs(arm, preference, row[:, None], limits)
    better = (gap[which, nearest] < _NEAR) & inside[:, 0] & (cost[:, 0] < best)
    held[better], rows[better], best[better] = trial[better], row[better], cost[better, 0]
    return np.asarray(better)


def _solutions(
    arm: Arm, T: Array, preference: Preference, limits: bool, held: Array, rows: Array
) -> Solutions:
    """The rows as `solve` gives them for these values, in this order."""
    q, flags = [], []
    placed, _, _ = preference_costs(arm, preference, rows[:, None], limits)
    for values, row in zip(held_of(arm, placed[:, 0]), placed[:, 0]):
        found = solve_pose(arm, T, values.tolist(), row, limits)
        if len(found):
            q.append(found.q[0])
            flags.append(bool(found.singular[0]))
    if not q:
        return no_solutions(len(arm.lower), Status.LIMITS)
    names = partial(branch_names, arm)
    return Solutions(np.array(q), Status.OK, np.array(flags), names=names)
