"""The best rows of a pose over all values of the held joints."""

from __future__ import annotations

from functools import partial
from math import inf
from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.held_parameters import aims, held_of
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.newton.arm_newton import refined
from ikgen.runtime.python.newton.joint_refinement import refine_few
from ikgen.runtime.python.rows.row_branches import branch_names
from ikgen.runtime.python.rows.row_links import differences
from ikgen.runtime.python.rows.row_preference import Preference, preference_costs
from ikgen.runtime.python.rows.solutions import Solutions, Status, no_solutions
from ikgen.runtime.python.singular.fold_pair import approach
from ikgen.runtime.python.solving.batch_solving import rows_batch
from ikgen.runtime.python.solving.pose_solving import solve_pose

__all__ = ["Reach", "Start", "best_rows"]


class Reach(NamedTuple):
    """Below and above a row, of each: a value (..., 2) of the one held joint between which a minimum is
    looked for, the branch's row there (..., 2, dof), and whether it meets another there (..., 2)."""

    ends: Array
    rows: Array
    folds: Array

    def ahead(self, arm: Arm, held: Array, rows: Array, trial: Array) -> Array:
        """The branch's rows at values `trial` (n,), nearly, from `rows` (n, dof) at values `held` (n,):
        beside folds they go as the root of the value."""
        which = np.arange(len(held)), (trial > held).astype(np.intp)
        begin, end = self._way(held), self._way(self.ends[which])
        with np.errstate(all="ignore"):
            share = np.where(end != begin, (self._way(trial) - begin) / (end - begin), 0.0)
        return np.asarray(rows + share[:, None] * differences(arm, rows, self.rows[which]))

    def _way(self, at: Array) -> Array:
        """What rows are even in, nearly, at values (n,)."""
        below, above = (
            np.maximum(x, 0.0) ** 0.5 for x in (at - self.ends[:, 0], self.ends[:, 1] - at)
        )
        first, last = self.folds.T
        one = np.where(first, below, np.where(last, -above, at))
        return np.where(first & last, np.arctan2(below, above), one)


Start = tuple[tuple[float, ...], Array, tuple[float, ...], int, tuple[float, float], Reach | None]
"""Values of the held joints, a row there, the first steps of each value, the number of its group, between
which values its branch goes on, and how far it is followed where one joint is held."""

_HALVINGS = 40
_LEAST_STEP = 1e-10  # rad or m
_NEAR = 0.5  # rad or m that a row may be from the one that a step began at
_BESIDE = 0.05  # the same of a row beside a fold


def best_rows(
    arm: Arm, T: Array, starts: list[Start], preference: Preference, limits: bool
) -> Solutions:
    """From each start the best row that a compass search (Hooke, Jeeves 1961) of the held values finds
    on its branch; of each group the best, best first, at most as many as `solve` gives."""
    held = np.array([s[0] for s in starts])
    rows = np.array([s[1] for s in starts])
    step = np.array([s[2] for s in starts])
    ends = np.array([s[4] for s in starts])
    reach = Reach(*map(np.array, zip(*(s[5] for s in starts)))) if starts[0][5] else None
    if reach is not None:
        ends = np.stack(
            [np.maximum(ends[:, 0], reach.ends[:, 0]), np.minimum(ends[:, 1], reach.ends[:, 1])],
            axis=1,
        )
    _, cost, _ = preference_costs(arm, preference, rows[:, None], limits)
    best = cost[:, 0]
    for _ in range(_HALVINGS):
        going = np.flatnonzero(step.max(axis=1) > _LEAST_STEP)
        if not len(going):
            break
        moved = np.zeros(len(going), dtype=bool)
        now = held[going], rows[going], best[going]
        for k in range(held.shape[1]):
            trials = np.stack([now[0], now[0]])
            trials[:, :, k] += np.outer((1.0, -1.0), step[going, k])
            trials = np.clip(trials, ends[going, :1], ends[going, 1:])
            part = None if reach is None else some_of(reach, going)
            moved |= _improved(arm, T, preference, limits, now, trials, part)
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
    trials: Array,
    reach: Reach | None = None,
) -> Flags:
    """Takes, in place, the first of each row's trials (s, n, held joints) that is better; which were.
    `reach`: of each row."""
    held, rows, best = now
    if limits and arm.free:
        low, high = np.array(arm.lower)[list(arm.free)], np.array(arm.upper)[list(arm.free)]
        trials = np.clip(trials, low, high)
    count, trial = len(trials), trials.reshape(-1, held.shape[1])
    row, near = np.tile(rows, (count, 1)), np.zeros(len(trial), dtype=bool)
    goes = (trials != held).any(axis=2).reshape(-1)  # not so at the end of a branch, or a limit
    poses = np.broadcast_to(T, (int(goes.sum()), 4, 4))
    begin = row[goes]
    if reach is not None:
        which = np.tile(np.arange(len(best)), count)[goes]
        begin = some_of(reach, which).ahead(arm, held[which, 0], begin, trial[goes, 0])
    row[goes], near[goes] = _next_rows(arm, poses, begin, trial[goes])
    _, cost, inside = preference_costs(arm, preference, row[:, None], limits)
    good = (near & inside[:, 0]).reshape(count, -1) & (cost.reshape(count, -1) < best)
    better = good.any(axis=0)
    which = (good.argmax(axis=0) * len(best) + np.arange(len(best)))[better]
    held[better], rows[better], best[better] = trial[which], row[which], cost[which, 0]
    return np.asarray(better)


def _next_rows(arm: Arm, T: Array, rows: Array, held: Array) -> tuple[Array, Flags]:
    """The rows (n, dof) at held values (n, held) that are next to `rows` (n, dof), and which are near: by
    Newton steps where these tell, beside folds by steps to both sides, by the closed form elsewhere."""
    start, aim = rows.copy(), aims(arm, T, held)
    start[:, list(arm.free)] = held[:, : len(arm.free)]
    with np.errstate(all="ignore"):
        row, arrived, _, strained = refine_few(arm, start, aim)
        near = arrived & ~strained
        left = np.flatnonzero(~near)
        if len(left):
            row[left], near[left] = _beside_fold(arm, start[left], aim[left])
            left = left[~near[left]]
    if len(left):
        q, real = rows_batch(arm, T[left], held[left])
        gap = np.abs(differences(arm, rows[left, None], q)).max(axis=2)
        gap = np.where(real, gap, inf)
        which, nearest = np.arange(len(left)), gap.argmin(axis=1)
        row[left], near[left] = q[which, nearest], gap[which, nearest] < _NEAR
    return row, near


def _beside_fold(arm: Arm, start: Array, aim: Array) -> tuple[Array, Flags]:
    """The nearer (n, dof) of the two rows that steps from `start` (n, dof) towards `aim` lead to, and which
    are so near that no other row is next to it."""
    twice = np.repeat(np.arange(len(start)), 2)
    first, towards, side = start[twice], aim[twice], np.tile([1.0, -1.0], len(start))
    q, error, _, _ = refined(arm, approach(arm, first, towards, side), towards)
    gap = np.abs(differences(arm, first, q)).max(axis=1)
    gap = np.where(error < arm.policy.exact, gap, inf).reshape(-1, 2)
    nearest = 2 * np.arange(len(start)) + gap.argmin(axis=1)
    return q[nearest], gap.min(axis=1) < _BESIDE


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
