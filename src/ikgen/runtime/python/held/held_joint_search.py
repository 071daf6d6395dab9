"""Search over the values of one held joint."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.held.branch_tracks import Tracks, tracked
from ikgen.runtime.python.held.held_joint import HeldJoint, held_range, pose_lines
from ikgen.runtime.python.held.lone_value import with_lone_row
from ikgen.runtime.python.held.self_motion import Piece, pieces_of
from ikgen.runtime.python.held.solution_search import (
    Reach,
    Start,
    improved_rows,
    solutions_of,
    with_seeds_row,
)
from ikgen.runtime.python.rows.row_preference import Preference, preference_costs, preference_of
from ikgen.runtime.python.rows.solutions import Solutions, no_held_values
from ikgen.runtime.python.solving.pose_solving import solve_pose

__all__ = ["search_interval"]

_WAITING = 64  # minima that are looked at, the lowest


def search_interval(
    joint: HeldJoint, pose: Any, seed: ArrayLike | None, prefer: str, limits: bool
) -> Solutions:
    """The best row of each interval of the held joint's values, best first, or the one at the seed's value
    before them. Raises ValueError for bad arguments."""
    arm = joint.arm
    preference = preference_of(arm, prefer, seed)
    T = pose_lines(arm, pose)
    if T is None:
        return solve_pose(arm, pose, None, None, limits)  # which says why it is none
    found = _best_rows(joint, T, preference, limits)
    found = with_seeds_row(arm, T, seed, preference, limits, found)
    return with_lone_row(arm, T, preference, limits, found)


def _best_rows(joint: HeldJoint, T: Array, preference: Preference, limits: bool) -> Solutions:
    """Rows of the intervals, best first."""
    arm = joint.arm
    tracks = tracked(joint, T, *held_range(arm, T, limits), limits)
    starts: list[Start] = []
    interval: list[int] = []
    for k, piece in enumerate(pieces_of(joint, T, tracks, limits)):
        starts += _starts(tracks, piece, preference, joint, limits)
        interval += [k] * (len(starts) - len(interval))
    if not starts:
        return no_held_values(len(arm.lower), arm.free_joints, bool(tracks.rows.real.any()))
    given = preference_costs(arm, preference, np.array([[s[1]] for s in starts]), limits)[1][:, 0]
    lowest = np.sort(np.argsort(given, kind="stable")[:_WAITING])
    rows, cost = improved_rows(arm, T, [starts[k] for k in lowest], preference, limits)
    best = _best_of_each(np.array(interval)[lowest], cost)[: arm.most]
    return solutions_of(arm, T, rows[best], preference, limits)


def _best_of_each(group: Index, cost: Array) -> Index:
    """The index of the lowest cost of each group, in the order of their costs."""
    order = np.argsort(cost, kind="stable")
    first = np.unique(group[order], return_index=True)[1]
    return order[np.sort(first)]


def _starts(
    tracks: Tracks, piece: Piece, preference: Preference, joint: HeldJoint, limits: bool
) -> list[Start]:
    """The ends of an interval, and the samples in it that are better than those beside them."""
    held, q = tracks.rows.held, tracks.rows.q
    points = [(float(held[at]), q[at, row], False) for at, row in piece.samples]
    interval = piece.interval()
    for value, end in ((interval.low, piece.low), (interval.high, piece.high)):
        if not isinstance(end, float):
            points.append((value, end.q, end.at_fold))
    points.sort(key=lambda point: point[0])
    values, rows, folds = (np.array(x) for x in zip(*points))
    cost = preference_costs(joint.arm, preference, rows[:, None], limits)[1][:, 0]
    out: list[Start] = []
    for k, (value, row, _) in enumerate(points):
        beside = [i for i in (k - 1, k + 1) if 0 <= i < len(points)]
        if all(cost[k] <= cost[i] for i in beside):
            step = max((abs(points[i][0] - value) for i in beside), default=1e-3)
            ends = [max(k - 1, 0), min(k + 1, len(points) - 1)]
            reach = Reach(values[ends], rows[ends], folds[ends])
            out.append((value, row, 0.5 * step, piece.reach(), reach))
    return out
