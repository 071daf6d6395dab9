"""Search over the values of one held joint."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.held.branch_tracks import Tracks, tracked
from ikgen.runtime.python.held.held_joint import HeldJoint, held_range, pose_lines
from ikgen.runtime.python.held.self_motion import Piece, pieces_of
from ikgen.runtime.python.held.solution_search import Reach, Start, best_rows
from ikgen.runtime.python.rows.row_preference import Preference, preference_costs, preference_of
from ikgen.runtime.python.rows.solutions import Solutions, no_held_values
from ikgen.runtime.python.solving.pose_solving import solve_pose

__all__ = ["search_interval"]


def search_interval(
    joint: HeldJoint, pose: Any, seed: ArrayLike | None, prefer: str, limits: bool
) -> Solutions:
    """The best row of each interval of the held joint's values, best first. Raises ValueError for bad
    arguments."""
    arm = joint.arm
    preference = preference_of(arm, prefer, seed)
    T = pose_lines(arm, pose)
    if T is None:
        return solve_pose(arm, pose, None, None, limits)  # which says why it is none
    tracks = tracked(joint, T, *held_range(arm, T, limits), limits)
    starts = [
        start
        for group, piece in enumerate(pieces_of(joint, T, tracks, limits))
        for start in _starts(tracks, piece, group, preference, joint, limits)
    ]
    if not starts:
        return no_held_values(len(arm.lower), arm.free_joints, bool(tracks.rows.real.any()))
    return best_rows(arm, T, starts, preference, limits)


def _starts(
    tracks: Tracks, piece: Piece, group: int, preference: Preference, joint: HeldJoint, limits: bool
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
            out.append(((value,), row, (0.5 * step,), group, piece.reach(), reach))
    return out
