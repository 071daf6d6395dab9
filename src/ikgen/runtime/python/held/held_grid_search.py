"""Search over the values of several held joints."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.arrays.row_blocks import in_blocks
from ikgen.runtime.python.held.held_joint import pose_lines
from ikgen.runtime.python.held.lone_value import with_lone_row
from ikgen.runtime.python.held.slide_range import slide_range
from ikgen.runtime.python.held.solution_search import NEAR, solutions_of, with_seeds_row
from ikgen.runtime.python.held.values_descent import descended_rows
from ikgen.runtime.python.rows.row_links import differences, neighbouring_rows
from ikgen.runtime.python.rows.row_preference import Preference, preference_costs, preference_of
from ikgen.runtime.python.rows.solutions import Solutions, no_held_values
from ikgen.runtime.python.solving.batch_solving import rows_batch
from ikgen.runtime.python.solving.pose_solving import solve_pose

__all__ = ["search_grid"]

_POINTS = 10000  # of the grid
_STARTS = 32
_PART = 1024  # points that are solved at once
_EQUAL = 1e-9  # costs that differ by less are as good


def search_grid(
    arm: Arm, pose: Any, seed: ArrayLike | None, prefer: str, limits: bool
) -> Solutions:
    """Rows that are better than those beside them on a grid of the held joints' values, each made better
    by steps of these: best first, and none twice, or the one at the seed's values before them. Raises
    ValueError for bad arguments."""
    preference = preference_of(arm, prefer, seed)
    T = pose_lines(arm, pose)
    if T is None:
        return solve_pose(arm, pose, None, None, limits)  # which says why it is none
    found = _best_rows(arm, T, preference, limits)
    found = with_seeds_row(arm, T, seed, preference, limits, found)
    return with_lone_row(arm, T, preference, limits, found)


def _best_rows(arm: Arm, T: Array, preference: Preference, limits: bool) -> Solutions:
    """Rows of the grid, made better, best first."""
    values, steps = _grid(arm, T, preference[1], limits)

    def rows_at(part: Array) -> tuple[Array, Array, Flags]:
        rows, real = rows_batch(arm, np.broadcast_to(T, (len(part), 4, 4)), part)
        rows, cost, inside = preference_costs(arm, preference, rows, limits)
        return rows, np.where(real & inside, cost, inf), real

    found, costs, real = in_blocks(rows_at, _PART, values)
    away = ((found - np.array(preference[1])) ** 2).sum(axis=2)
    point, row = _lowest(arm, found, costs, away, NEAR + 2.0 * max(steps))
    if not len(point):
        return no_held_values(len(arm.lower), arm.free_joints, bool(real.any()))
    point, row = point[:_STARTS], row[:_STARTS]
    start = values[point], found[point, row], np.tile(steps, (len(point), 1))
    rows, cost = descended_rows(arm, T, *start, preference, limits)
    best = _distinct(arm, rows, np.argsort(cost, kind="stable"))[: arm.most]
    return solutions_of(arm, T, rows[best], preference, limits)


def _lowest(arm: Arm, rows: Array, costs: Array, away: Array, near: float) -> tuple[Index, Index]:
    """Point and row of those of rows (n, m, dof) on a grid, of costs (n, m), that no row which is `near`
    (rad or m) at the points beside along an axis is better than, or as good as and less `away` (n, m) from
    what is wanted; the lowest first."""
    axes = len(arm.free)
    grid = np.arange(len(costs)).reshape((round(len(costs) ** (1.0 / axes)),) * axes)
    lowest = costs < inf
    for axis in range(axes):
        line = np.moveaxis(grid, axis, 0)
        for here, there in ((line[1:], line[:-1]), (line[:-1], line[1:])):
            at, beside = here.reshape(-1), there.reshape(-1)
            k, row = np.nonzero(lowest[at])
            with np.errstate(invalid="ignore"):  # rows that are none
                gap = np.abs(differences(arm, rows[at[k], row][:, None], rows[beside[k]])).max(
                    axis=2
                )
                more = costs[beside[k]] - costs[at[k], row][:, None]
                nearer = away[beside[k]] < away[at[k], row][:, None]
                better = (gap < near) & ((more < -_EQUAL) | (nearer & (more <= _EQUAL)))
            lowest[at[k], row] = ~better.any(axis=1)
    point, row = np.nonzero(lowest)
    order = np.argsort(costs[point, row], kind="stable")
    return point[order], row[order]


def _distinct(arm: Arm, rows: Array, order: Index) -> list[int]:
    """The rows (n, dof), in an order, that are not alike one before them."""
    out: list[int] = []
    for i in order.tolist():
        if not neighbouring_rows(arm, rows[out], rows[i]).any():
            out.append(i)
    return out


def _grid(
    arm: Arm, T: Array, middle: tuple[float, ...], limits: bool
) -> tuple[Array, tuple[float, ...]]:
    """Values of the held joints (n, k), evenly spread over their ranges and those nearest to what is
    wanted, and half the steps between them. A turn, or a metre to either side, is looked at where there
    are no limits; a slide as far as the pose can be reached from."""
    count = max(3, int(_POINTS ** (1.0 / len(arm.free)) + 1e-9))
    axes, steps = [], []
    for j in arm.free:
        low, high = arm.lower[j], arm.upper[j]
        half = 0.5 * arm.period[j]
        if half and not (limits and high - low < inf):
            low, high = -half, half
        low, high = (min(max(x, low), high) for x in slide_range(arm, T, j))
        low = min(high, middle[j]) - 1.0 if low == -inf else low
        high = max(low, middle[j]) + 1.0 if high == inf else high
        axis = np.linspace(low, high, count)
        axis[np.abs(axis - middle[j]).argmin()] = min(max(middle[j], low), high)
        axes.append(axis)
        steps.append(0.5 * (high - low) / (count - 1))
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes)), tuple(steps)
