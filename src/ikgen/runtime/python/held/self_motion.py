"""Where a held joint may be: intervals of its value over which a branch stays inside the limits."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.held.branch_ends import BranchEnd, branch_end, find_ends
from ikgen.runtime.python.held.branch_tracks import Tracks, tracked
from ikgen.runtime.python.held.held_joint import HeldJoint, held_range, pose_lines, rows_at
from ikgen.runtime.python.held.lone_value import lone_row
from ikgen.runtime.python.rows.row_links import differences, origins
from ikgen.runtime.python.solving.pose_solving import solve_pose

__all__ = ["Interval", "Piece", "pieces_of", "self_motion_of"]

_FEW = 4  # least cells
# Times the rows of a pose: ends of more that are narrower are left where they were seen, and of more pieces
# only the widest are kept.
_SLIVERS, _MOST = 2, 16


@dataclass(frozen=True)
class Interval:
    """For every value from `low` to `high` of the held joint `solve` has a row of the branch inside the
    limits: `branch` is the closed form's, as in `Solutions.branch`. Where a quartic or the general 6R
    elimination gives the rows it counts the continuous motions, of which limits leave parts."""

    low: float
    high: float
    branch: int


@dataclass(frozen=True)
class Piece:
    """An interval, and the samples (index, row) that lie in it, ascending."""

    low: BranchEnd | float
    high: BranchEnd | float
    branch: int
    samples: tuple[tuple[int, int], ...]

    def width(self) -> float:
        """At most."""
        low, high = (x if isinstance(x, float) else x.outer for x in (self.low, self.high))
        return high - low

    def reach(self) -> tuple[float, float]:
        """Between which values its branch may go on: as far as its ends are known, and on where it goes as
        far as the joint was looked at."""
        low = -inf if isinstance(self.low, float) else self.low.surely
        high = inf if isinstance(self.high, float) else self.high.surely
        return low, high

    def interval(self) -> Interval:
        """With the ends found."""
        low, high = (x if isinstance(x, float) else x.inner for x in (self.low, self.high))
        return Interval(low, high, self.branch)


def self_motion_of(joint: HeldJoint, pose: Any, limits: bool) -> tuple[Interval, ...]:
    """The intervals of a pose (4, 4), by branch and value; none for what is no pose."""
    T = pose_lines(joint.arm, pose)
    if T is None:
        return ()
    tracks = tracked(joint, T, *held_range(joint.arm, T, limits), limits)
    found = tuple(piece.interval() for piece in pieces_of(joint, T, tracks, limits))
    return found or _lone_interval(joint, T, limits)


def _lone_interval(joint: HeldJoint, T: Array, limits: bool) -> tuple[Interval, ...]:
    """One without width, where one value alone of the held joint reaches a pose."""
    arm = joint.arm
    q = lone_row(arm, T, limits) if arm.free else None
    if q is None or not len(found := solve_pose(arm, T, None, q, limits)):
        return ()
    (value,) = q[list(arm.free)].tolist()
    rows, branch = rows_at(joint, T, np.array([value])), 0
    if joint.guarded and rows.real.any():
        gap = np.abs(differences(arm, rows.q[0], found.q[0])).max(axis=1)
        branch = int(np.where(rows.real[0], gap, inf).argmin()) % (len(gap) // joint.poses)
    return (Interval(value, value, branch),)


def pieces_of(joint: HeldJoint, T: Array, tracks: Tracks, limits: bool) -> list[Piece]:
    """The intervals with their samples, ends found, by branch and value."""
    pieces = list(_pieces(joint, tracks))
    if len(pieces) > (most := _MOST * joint.arm.most):
        widest = sorted(range(len(pieces)), key=lambda k: -pieces[k].width())[:most]
        pieces = [pieces[k] for k in sorted(widest)]
    wide = [piece for piece in pieces if piece.width() > _FEW * tracks.least]
    looked = pieces if len(pieces) - len(wide) <= _SLIVERS * joint.arm.most else wide
    ends = [x for piece in looked for x in (piece.low, piece.high) if isinstance(x, BranchEnd)]
    find_ends(joint, T, ends, limits)
    if joint.guarded:  # a row stays on its branch: in its column, or in that of a pose beside
        count = tracks.rows.real.shape[1] // joint.poses
        numbers = [piece.samples[0][1] % count for piece in pieces]
    else:
        motions = list(dict.fromkeys(piece.branch for piece in pieces))
        numbers = [motions.index(piece.branch) for piece in pieces]
    found = [replace(piece, branch=number) for piece, number in zip(pieces, numbers)]
    return sorted(found, key=lambda piece: (piece.branch, piece.samples[0][0]))


def _pieces(joint: HeldJoint, tracks: Tracks) -> Iterator[Piece]:
    """Runs of rows inside the limits along each track, with ends that are still to be found."""
    before, last = origins(tracks.links), len(tracks.rows.held) - 1
    starts = tracks.rows.real.copy()
    starts[1:] &= before < 0
    for branch, (at, row) in enumerate(np.argwhere(starts).tolist()):
        run: list[tuple[int, int]] = []
        while row >= 0:
            following = int(tracks.links[at, row]) if at < last else -1
            if tracks.inside[at, row]:
                run.append((at, row))
                if following < 0 or not tracks.inside[at + 1, following]:
                    yield _piece(joint, tracks, branch, run, before, following)
                    run = []
            at, row = at + 1, following


def _piece(
    joint: HeldJoint,
    tracks: Tracks,
    branch: int,
    run: list[tuple[int, int]],
    before: Index,
    following: int,
) -> Piece:
    (first, row), last = run[0], run[-1][0]
    held, count = tracks.rows.held, len(tracks.rows.held)
    low: BranchEnd | float = float(held[0])
    high: BranchEnd | float = float(held[-1])
    if first:
        beyond = first - 1, int(before[first - 1, row])
        low = branch_end(joint, tracks, before, run[0], beyond)
    if last < count - 1:
        high = branch_end(joint, tracks, before, run[-1], (last + 1, following))
    return Piece(low, high, branch, tuple(run))
