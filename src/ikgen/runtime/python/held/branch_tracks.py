"""Rows of a pose over the values of a held joint, followed from one value to the next.

Cells between samples are halved until nothing can happen in them unseen, by second differences of joint
values and of what is under square roots.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from ikgen.runtime.python.arm.limit_margins import bounded_joints, offsets, outside
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.held.held_joint import HeldJoint, Rows, merged_rows, rows_at
from ikgen.runtime.python.rows.row_links import differences, linked_rows, origins

__all__ = ["Tracks", "tracked"]

_CELLS = 64  # cells to begin with
_UNGUARDED_CELLS = 512  # cells to begin with where nothing tells of folds between samples
_FIXED = (
    1e-9  # rad or m: a joint with no more range is pinned, and has one cell, which is not halved
)
_SAFETY = 4.0  # bounds of what second differences tell are taken that many times
_SMOOTH = 0.05  # rad or m by which a row may bend between samples
_ROUND_OFF = 1e-12  # rad or m, of joint values
_LEAST = 1e-5  # share of the range: cells that narrow are not halved
_NARROW = 1e-3  # share of the range: cells that narrow are not halved where rows begin or end
# Times the rows of a pose: so many narrower cells are halved. Where rounding leaves rows at some values and
# none at others, as with a stretched elbow, there is always more to see.
_FINE = 64


@dataclass(frozen=True)
class Tracks:
    """Rows and what each goes on as; how far each is outside the limits, `off` (n, m), and whether it is
    real and inside, `inside` (n, m); cells of which width are halved no more, `least`."""

    rows: Rows
    links: Index
    off: Array
    inside: Flags
    least: float


def tracked(joint: HeldJoint, T: Array, low: float, high: float, limits: bool) -> Tracks:
    """Rows over a range, close enough together that each cell between them is understood."""
    arm = joint.arm
    fixed = not high - low > _FIXED
    cells = 1 if fixed else _CELLS if joint.guarded else _UNGUARDED_CELLS
    rows = rows_at(joint, T, np.linspace(low, high, cells + 1))
    left = _FINE * arm.most
    while True:
        following = linked_rows(arm, rows.q, rows.real, joint.guarded)
        held, halved = rows.held, np.zeros(len(following), dtype=bool)
        if not fixed:
            halved = _doubtful(joint, rows, following, limits)
            fine = halved & (np.diff(held) <= _NARROW * (high - low))
            left -= int(fine.sum())
            halved &= ~fine | (left >= 0)
        if not halved.any():
            off = outside(arm, rows.q, limits) - arm.policy.limit_tolerance
            least = (_LEAST if left >= 0 else _NARROW) * (high - low)
            return Tracks(rows, following, off, rows.real & (off <= 0.0), least)
        rows = merged_rows(rows, rows_at(joint, T, 0.5 * (held[1:] + held[:-1])[halved]))


def _doubtful(joint: HeldJoint, rows: Rows, following: Index, limits: bool) -> Flags:
    """Cells (n - 1,) that have to be halved."""
    arm = joint.arm
    width = np.diff(rows.held)
    span = rows.held[-1] - rows.held[0]
    wide, narrow = width > _NARROW * span, width > _LEAST * span
    q, change, bend = _row_bends(arm, rows, following)
    linked = following >= 0
    out = (linked & (bend.max(axis=2) > _SMOOTH)).any(axis=1) & narrow
    if joint.guarded:  # rows that seem to go on as another branch's turn past it quickly
        out |= (linked & (following != np.arange(following.shape[1]))).any(axis=1) & narrow
    dead, crossings = _limit_crossings(arm, q, change, bend, linked, limits)
    out |= (linked & ~dead & (crossings > 1)).any(axis=1) & narrow
    out |= _ending(arm, rows, following, change, limits, wide, narrow)
    anyhow = wide & arm.rounded
    return np.asarray(out | (_hidden_folds(rows, linked & dead, anyhow).any(axis=1) & narrow))


def _row_bends(arm: Arm, rows: Rows, following: Index) -> tuple[Array, Array, Array]:
    """Per cell and row at its lower end: joint values, their change over the cell, and a bound of how
    far they are off the straight line between; (n - 1, m, dof) each."""
    cells, m = following.shape
    at = np.arange(cells)[:, None]
    to = np.where(following >= 0, following, 0)
    change = differences(arm, rows.q[:-1], rows.q[1:][at, to])
    width = np.diff(rows.held)[:, None, None]
    slope = change / width
    # second difference at the upper end of a cell, by its row there
    second = np.full((cells, m, change.shape[2]), np.nan)
    goes_on = following[1:] >= 0
    upper = np.abs(
        slope[1:]
        - np.take_along_axis(slope[:-1], np.maximum(origins(following[:-1]), 0)[:, :, None], 1)
    )
    upper = upper / (width[1:] + width[:-1])
    known = goes_on & (origins(following[:-1]) >= 0)
    lower_bend = np.where(known[:, :, None], upper, np.nan)  # of cell k + 1, at its lower end
    second[1:] = lower_bend
    after = np.full_like(second, np.nan)
    after[:-1] = np.take_along_axis(lower_bend, to[:-1, :, None], 1)
    with np.errstate(all="ignore"):
        worst = np.fmax(second, after)
    bend = np.where(np.isnan(worst), np.abs(change), _SAFETY * worst * width**2 / 4.0)
    return rows.q[:-1], change, bend


def _limit_crossings(
    arm: Arm, q: Array, change: Array, bend: Array, linked: Flags, limits: bool
) -> tuple[Flags, Array]:
    """Per cell and row: whether it is outside the limits all over the cell; how many joints may cross a
    limit in it, more than 1 where one may do so more than once."""
    dead = np.zeros(linked.shape, dtype=bool)
    count = np.zeros(linked.shape)
    for j, middle, half, period in bounded_joints(arm) if limits else ():
        a = offsets(q[..., j], middle, period)
        b = offsets(a + change[..., j], 0.0, period)
        off = bend[..., j] + _ROUND_OFF
        reach = half + arm.policy.limit_tolerance  # of rows that are taken as inside
        left, right = reach - np.abs(a), reach - np.abs(b)
        opposite, far = a * b < 0.0, (period > 0.0) & (np.abs(a) + np.abs(b) > 0.5 * period)
        dead |= (left < -off) & (right < -off) & (~opposite | far)
        sure = (left > off) & (right > off) & ~(opposite & far)
        once = (left * right <= 0.0) & (np.abs(left - right) > 4.0 * off)
        count += np.where(sure, 0, np.where(once, 1, 2))
    return dead, count


def _ending(
    arm: Arm, rows: Rows, following: Index, change: Array, limits: bool, wide: Flags, narrow: Flags
) -> Flags:
    """Cells to be halved for rows of one end that do not go on to the other: the narrower ones where
    rows of both ends don't, or where such a row may cross a limit on its way to the fold."""
    before = origins(following)
    lower, upper = rows.real[:-1] & (following < 0), rows.real[1:] & (before < 0)
    moved = np.abs(change).max(axis=2)
    down, up = np.full((2, *following.shape), inf)
    down[1:] = np.where(
        before[:-1] >= 0, np.take_along_axis(moved[:-1], np.maximum(before[:-1], 0), 1), inf
    )
    up[:-1] = np.where(following[1:] >= 0, moved[1:], inf)
    width = np.diff(rows.held)
    off = np.abs(outside(arm, rows.q, limits))
    near = lower & (off[:-1] < down * _reach(width[1:], width[:-1], 0)[:, None])
    near |= upper & (off[1:] < up * _reach(width[:-1], width[1:], 1)[:, None])
    some = lower.any(axis=1), upper.any(axis=1)
    fine = near.any(axis=1) | (some[0] & some[1])
    return np.asarray((some[0] | some[1]) & wide | fine & narrow)


def _reach(own: Array, beside: Array, where: int) -> Array:
    """How far a row may move at most on its way to a fold in a cell of width `own`, over its change in
    the cell beside it, as the square root of the distance from the fold; 1 for the cell without one
    beside it."""
    share = _SAFETY * np.sqrt(own * (own + beside)) / beside
    return np.concatenate([share, [1.0]] if where else [[1.0], share])


def _hidden_folds(rows: Rows, dead: Flags, anyhow: Flags) -> Flags:
    """Per cell and row: two rows may come and go between its ends, or go and come; in some cells (n - 1,)
    also where it is not what `folds` tells that keeps them away, as of rounded arms."""
    f, width = rows.folds, np.diff(rows.held)[:, None, None]
    if not f.shape[2]:
        return np.zeros(dead.shape, dtype=bool)
    with np.errstate(all="ignore"):
        slope = np.diff(f, axis=0) / width
        second = np.abs(np.diff(slope, axis=0)) / (width[1:] + width[:-1])
        second = np.nan_to_num(second, nan=0.0, posinf=0.0)
    bend = np.zeros_like(slope)
    bend[1:] = second
    bend[:-1] = np.fmax(bend[:-1], second)
    bend *= _SAFETY * width**2 / 4.0
    least, most = np.fmin(f[:-1], f[1:]) - bend, np.fmax(f[:-1], f[1:]) + bend
    none = ~rows.real[:-1] & ~rows.real[1:]
    some = ((f[:-1] <= 0.0) | (f[1:] <= 0.0)).any(axis=2) | anyhow[:, None]
    missing = none & (most > 0.0).all(axis=2) & some
    both = rows.real[:-1] & rows.real[1:]
    return missing | (both & ~dead & (least < 0.0).any(axis=2))
