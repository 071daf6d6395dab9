"""Search over the values of several held joints."""

from __future__ import annotations

from math import inf, pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.arrays.row_blocks import in_blocks
from ikgen.runtime.python.held.held_joint import pose_lines
from ikgen.runtime.python.held.slide_range import slide_range
from ikgen.runtime.python.held.solution_search import Start, best_rows
from ikgen.runtime.python.rows.row_preference import preference_costs, preference_of
from ikgen.runtime.python.rows.solutions import Solutions, no_held_values
from ikgen.runtime.python.solving.batch_solving import rows_batch
from ikgen.runtime.python.solving.pose_solving import solve_pose

__all__ = ["search_grid"]

_POINTS = 4096  # of the grid
_BEGINNINGS = 32
_PART = 1024


def search_grid(
    arm: Arm, pose: Any, seed: ArrayLike | None, prefer: str, limits: bool
) -> Solutions:
    """Good rows over a grid of the held joints' values, each made better by a compass search. Raises
    ValueError for bad arguments."""
    preference = preference_of(arm, prefer, seed)
    T = pose_lines(arm, pose)
    if T is None:
        return solve_pose(arm, pose, None, None, limits)  # which says why it is none
    values, steps = _grid(arm, T, preference[1], limits)

    def rows_at(part: Array) -> tuple[Array, Array, Flags]:
        rows, real = rows_batch(arm, np.broadcast_to(T, (len(part), 4, 4)), part)
        rows, cost, inside = preference_costs(arm, preference, rows, limits)
        return rows, np.where(real & inside, cost, inf), real

    found, costs, real = in_blocks(rows_at, _PART, values)
    starts: list[Start] = []
    for flat in np.argsort(costs, axis=None, kind="stable")[:_BEGINNINGS].tolist():
        point, row = divmod(flat, costs.shape[1])
        if costs[point, row] < inf:
            held = tuple(values[point].tolist())
            starts.append((held, found[point, row], steps, len(starts), (-inf, inf), None))
    if not starts:
        return no_held_values(len(arm.lower), arm.free_joints, bool(real.any()))
    return best_rows(arm, T, starts, preference, limits)


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
        if arm.chain.revolute[j] and not (limits and high - low < inf):
            low, high = -pi, pi
        low, high = (min(max(x, low), high) for x in slide_range(arm, T, j))
        low, high = max(low, middle[j] - 1.0) if low == -inf else low, high
        high = min(high, max(low, middle[j]) + 1.0) if high == inf else high
        axis = np.linspace(low, high, count)
        axis[np.abs(axis - middle[j]).argmin()] = min(max(middle[j], low), high)
        axes.append(axis)
        steps.append(0.5 * (high - low) / (count - 1))
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes)), tuple(steps)
