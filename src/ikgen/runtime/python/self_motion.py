"""Where a held joint may be: intervals of its value over which a branch stays inside the limits."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from ikgen.runtime.python.array_types import Array
from ikgen.runtime.python.branch_tracks import Tracks, tracked
from ikgen.runtime.python.held_joint import HeldJoint, held_range, pose_lines, rows_at
from ikgen.runtime.python.limit_margins import outside
from ikgen.runtime.python.row_links import Links, differences, origins

__all__ = ["Interval", "Piece", "pieces_of", "self_motion_of"]

_ENOUGH = 1e-12  # of an end
_STEPS = 60
_REACH = 1.0  # rad or m that a row may be from where its branch was last seen


@dataclass(frozen=True)
class Interval:
    """For every value from `low` to `high` of the held joint `solve` has a row of the branch inside the
    limits. Intervals of one `branch` are parts of one continuous motion."""

    low: float
    high: float
    branch: int


@dataclass
class _End:
    """A value of the held joint at which the row `lane`, `q`, is inside, and one at which it is not,
    with what is negative inside and positive outside at both (None: unknown)."""

    inner: float
    outer: float
    q: Array
    lane: int
    values: list[float | None]
    at_fold: bool
    moved: int = -1


@dataclass(frozen=True)
class Piece:
    """An interval, and the samples (index, row) that lie in it, ascending."""

    low: _End | float
    high: _End | float
    branch: int
    samples: tuple[tuple[int, int], ...]

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
    return tuple(piece.interval() for piece in pieces_of(joint, T, tracks, limits))


def pieces_of(joint: HeldJoint, T: Array, tracks: Tracks, limits: bool) -> list[Piece]:
    """The intervals with their samples, ends found; branches are counted from 0 in their order."""
    pieces = list(_pieces(tracks))
    ends = [x for piece in pieces for x in (piece.low, piece.high) if isinstance(x, _End)]
    _find(joint, T, ends, limits)
    number = {old: new for new, old in enumerate(dict.fromkeys(p.branch for p in pieces))}
    return [Piece(p.low, p.high, number[p.branch], p.samples) for p in pieces]


def _pieces(tracks: Tracks) -> Iterator[Piece]:
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
                    yield _piece(tracks, branch, run, before, following)
                    run = []
            at, row = at + 1, following


def _piece(
    tracks: Tracks, branch: int, run: list[tuple[int, int]], before: Links, following: int
) -> Piece:
    (first, row), (last, end) = run[0], run[-1]
    held, count = tracks.rows.held, len(tracks.rows.held)
    low: _End | float = float(held[0])
    high: _End | float = float(held[-1])
    if first:
        low = _end(tracks, first, row, first - 1, int(before[first - 1, row]))
    if last < count - 1:
        high = _end(tracks, last, end, last + 1, following)
    return Piece(low, high, branch, tuple(run))


def _end(tracks: Tracks, at: int, row: int, beyond: int, other: int) -> _End:
    """Between a sample inside and the next one: its row is outside the limits, or there is none (-1)."""
    rows, off = tracks.rows, tracks.off
    inner, outer = float(rows.held[at]), float(rows.held[beyond])
    values: list[float | None] = [None, None]
    if other >= 0:
        values = [float(off[at, row]), float(off[beyond, other])]
    elif np.isfinite(rows.folds[at, row]).any():
        values = [-float(rows.folds[k, row].min()) for k in (at, beyond)]
    return _End(inner, outer, rows.q[at, row], row, values, other < 0)


def _find(joint: HeldJoint, T: Array, ends: list[_End], limits: bool) -> None:
    """False position with halved values (Dowell, Jarratt 1971: the Illinois method), and halving where
    no value is known or it is slow."""
    for step in range(_STEPS):
        going = [e for e in ends if abs(e.outer - e.inner) > _ENOUGH]
        if not going:
            return
        held = np.array([_trial(e, step) for e in going])
        rows = rows_at(joint, T, held)
        off = outside(joint.arm, rows.q, limits)
        last = np.array([e.q for e in going])
        gap = np.abs(differences(joint.arm, last[:, None], rows.q)).max(axis=2)
        gap = np.where(rows.real, gap, inf)
        for k, e in enumerate(going):
            row = e.lane if e.at_fold and joint.guarded else int(gap[k].argmin())
            seen = bool(gap[k, row] < _REACH)
            fold = -float(rows.folds[k, row if seen else e.lane].min(initial=inf))
            here = float(off[k, row]) - joint.arm.policy.limit_tolerance
            _narrow(e, float(held[k]), seen, here, fold)
            if seen and here <= 0.0:
                e.q, e.lane = rows.q[k, row], row


def _trial(end: _End, step: int) -> float:
    a, b = end.values
    if a is None or b is None or not a <= 0.0 < b or step % 4 == 3:
        return 0.5 * (end.inner + end.outer)
    share = a / (a - b)
    least = 0.4 * _ENOUGH / abs(end.outer - end.inner)
    return end.inner + min(max(share, least), 1.0 - least) * (end.outer - end.inner)


def _narrow(end: _End, held: float, seen: bool, off: float, fold: float) -> None:
    """Takes what was found at a value between: whether there is a row of the branch, how far that is
    outside the limits, and how far its lane is from real rows."""
    good = seen and off <= 0.0
    if good:
        end.inner = held
    else:
        end.outer = held
    if end.at_fold and seen and not good:  # a limit comes before the fold
        end.at_fold, end.values = False, [None, None]
    value = fold if end.at_fold else off if seen else None
    side = 0 if good else 1
    end.values[side] = None if value is None or value in (inf, -inf) else value
    other = end.values[1 - side]
    if end.moved == side and other is not None:
        end.values[1 - side] = 0.5 * other
    end.moved = side
