"""Better rows of a pose at other values of what is held."""

from __future__ import annotations

from functools import partial
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

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

__all__ = [
    "LEAST_STEP",
    "NEAR",
    "Reach",
    "Start",
    "improved_rows",
    "solutions_of",
    "tried_rows",
    "with_seeds_row",
]


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


Start = tuple[float, Array, float, tuple[float, float], Reach]
"""A value of the held joint, a row there, the first step of the value, between which values its branch goes
on, and how far it is followed."""

_STEPS = 40
_SHORTER = 0.4
_EQUAL = 1e-12  # costs that differ by less are as good
LEAST_STEP = 1e-10  # rad or m
NEAR = 0.5  # rad or m that a row may be from the one that a step began at
_BESIDE = 0.05  # rad or m that a row beside a fold may be from the one before
_ASKED = 1e-3  # rad or m: the shortest way for which the closed form is asked


def improved_rows(
    arm: Arm, T: Array, starts: list[Start], preference: Preference, limits: bool
) -> tuple[Array, Array]:
    """From each start the best row (n, dof) that shorter and shorter steps of the one held value find on
    its branch, and its cost (n,)."""
    held = np.array([[s[0]] for s in starts])
    rows = np.array([s[1] for s in starts])
    step = np.array([s[2] for s in starts])
    ends = np.array([s[3] for s in starts])
    reach = Reach(*map(np.array, zip(*(s[4] for s in starts))))
    low = np.maximum(ends[:, 0], reach.ends[:, 0])
    high = np.minimum(ends[:, 1], reach.ends[:, 1])
    _, cost, _ = preference_costs(arm, preference, rows[:, None], limits)
    best = cost[:, 0]
    for _ in range(_STEPS):
        going = np.flatnonzero(step > LEAST_STEP)
        if not len(going):
            break
        now = held[going], rows[going], best[going]
        ways = np.stack([step[going], -step[going]])[:, :, None]
        trials = np.clip(now[0] + ways, low[going, None], high[going, None])
        moved = _improved(arm, T, preference, limits, now, trials, some_of(reach, going))
        held[going], rows[going], best[going] = now
        step[going[~moved]] *= _SHORTER
    return rows, best


def _improved(
    arm: Arm,
    T: Array,
    preference: Preference,
    limits: bool,
    now: tuple[Array, Array, Array],
    trials: Array,
    reach: Reach | None = None,
) -> Flags:
    """Takes, in place, the first of each row's trials (s, n, held values) that is better; which were.
    `reach`: of each row."""
    held, rows, best = now
    trials, row, cost = tried_rows(arm, T, preference, limits, held, rows, trials, reach)
    good = cost < best
    better = good.any(axis=0)
    which = good.argmax(axis=0)[better], np.flatnonzero(better)
    held[better], rows[better], best[better] = trials[which], row[which], cost[which]
    return np.asarray(better)


def tried_rows(
    arm: Arm,
    T: Array,
    preference: Preference,
    limits: bool,
    held: Array,
    rows: Array,
    trials: Array,
    reach: Reach | None = None,
) -> tuple[Array, Array, Array]:
    """For rows (n, dof) at values (n, held) trials (s, n, held) inside the limits, the rows (s, n, dof) of
    the same branches there, and their costs (s, n), infinite where there is none."""
    if limits and arm.free:
        low, high = np.array(arm.lower)[list(arm.free)], np.array(arm.upper)[list(arm.free)]
        trials = np.clip(trials, low, high)
    count, trial = len(trials), trials.reshape(-1, held.shape[1])
    row, near = np.tile(rows, (count, 1)), np.zeros(len(trial), dtype=bool)
    goes = (trials != held).any(axis=2).reshape(-1)  # not so at the end of a branch, or a limit
    poses = np.broadcast_to(T, (int(goes.sum()), 4, 4))
    begin = row[goes]
    if reach is not None:
        which = np.tile(np.arange(len(rows)), count)[goes]
        begin = some_of(reach, which).ahead(arm, held[which, 0], begin, trial[goes, 0])
    row[goes], near[goes] = _next_rows(arm, poses, begin, trial[goes])
    _, cost, inside = preference_costs(arm, preference, row[:, None], limits)
    cost = np.where(near & inside[:, 0], cost[:, 0], inf)
    return trials, row.reshape(count, *rows.shape), cost.reshape(count, -1)


def _next_rows(arm: Arm, T: Array, rows: Array, held: Array) -> tuple[Array, Flags]:
    """The rows (n, dof) at held values (n, held) that are next to `rows` (n, dof), and which are near: by
    Newton steps where these tell, beside folds by steps to both sides, elsewhere by the closed form. Of
    several held joints it has none for the shortest ways where these have not: that leads out of a fold."""
    start, aim = rows.copy(), aims(arm, T, held)
    start[:, list(arm.free)] = held[:, : len(arm.free)]
    asked = np.full(len(start), True)
    if held.shape[1] > 1:
        asked = np.abs(start - rows).max(axis=1) > _ASKED
    with np.errstate(all="ignore"):
        row, arrived, _, strained = refine_few(arm, start, aim)
        near = arrived & ~strained
        left = np.flatnonzero(~near)
        if len(left):
            row[left], near[left] = _beside_fold(arm, start[left], aim[left])
            left = left[~near[left] & asked[left]]
    if len(left):
        q, real = rows_batch(arm, T[left], held[left])
        gap = np.abs(differences(arm, rows[left, None], q)).max(axis=2)
        gap = np.where(real, gap, inf)
        which, nearest = np.arange(len(left)), gap.argmin(axis=1)
        row[left], near[left] = q[which, nearest], gap[which, nearest] < NEAR
    return row, near


def _beside_fold(arm: Arm, start: Array, aim: Array) -> tuple[Array, Flags]:
    """The nearer (n, dof) of the two rows that steps from `start` (n, dof) towards `aim` lead to, and which
    are so near that no other row is next to it."""
    twice = np.repeat(np.arange(len(start)), 2)
    first, towards, side = start[twice], aim[twice], np.tile([1.0, -1.0], len(start))
    q, error, _, _ = refined(arm, approach(arm, first, towards, side)[0], towards)
    gap = np.abs(differences(arm, first, q)).max(axis=1)
    gap = np.where(error < arm.policy.exact, gap, inf).reshape(-1, 2)
    nearest = 2 * np.arange(len(start)) + gap.argmin(axis=1)
    return q[nearest], gap.min(axis=1) < _BESIDE


def solutions_of(
    arm: Arm, T: Array, rows: Array, preference: Preference, limits: bool
) -> Solutions:
    """Rows (n, dof) as `solve` gives them for their values of what is held, in this order."""
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


def with_seeds_row(
    arm: Arm,
    T: Array,
    seed: ArrayLike | None,
    preference: Preference,
    limits: bool,
    found: Solutions,
) -> Solutions:
    """What was found, behind the best row at the seed's own values of what is held, where that is better:
    between samples lie values that alone reach a pose, as where an arm on a rail points along it."""
    own = None if seed is None else solve_pose(arm, T, None, seed, limits)
    if own is None or not len(own):
        return found
    q, cost, inside = preference_costs(arm, preference, own.q[:, None], limits)
    cost = np.where(inside, cost, inf)[:, 0]
    best = cost.argmin()
    if len(found):
        least = preference_costs(arm, preference, found.q[:1, None], limits)[1][0, 0]
        if not cost[best] < least - _EQUAL * (1.0 + abs(least)):
            return found
    elif not cost[best] < inf:
        return found
    rows = np.concatenate([q[best], found.q])[: arm.most]
    flags = np.concatenate([own.singular[best : best + 1], found.singular])[: arm.most]
    return Solutions(rows, Status.OK, flags, names=own.names)
