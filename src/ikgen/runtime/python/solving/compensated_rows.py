"""Rows that what the file is off moves far, by the closed form itself: it solves poses displaced by as much
as the file is off at the rows ("compensation": Veitschegger and Wu 1988)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.arm.held_parameters import aims
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.arrays.rigid_motion import inverses
from ikgen.runtime.python.newton.arm_newton import linearized
from ikgen.runtime.python.rows.row_links import differences
from ikgen.runtime.python.rows.row_placement import distinct
from ikgen.runtime.python.singular.fold_pair import approach
from ikgen.runtime.python.singular.meeting_rows import ends_of
from ikgen.runtime.python.solving.closed_form_rows import closed_form

__all__ = ["compensated_rows"]

_ROUNDS = 2
_SHARE = 0.2  # of the least product of two singular values below which rows are strained
_ASIDE = 0.1  # rad or m: what moves rows farther there may lead to others as well
_TOGETHER = 0.3  # rad or m: nearer rows may be of one fold
_REMOTE = 2.0  # singular value over the way from there: a second singularity is farther
_HALTS = 3  # on the way to a fold, its ends included
_NONE = 1e-8  # error (rad, m over the arm's size) that is left where there is no solution


@dataclass
class _Rows:
    """Rows `q` (N, M, dof) of poses T (N, 4, 4), `first` where the closed form has them; which are `real`,
    or are not, behind a direction that has lost digits, and which of these `rough` (N, M); which poses (N,)
    are `beside` a divisor that nearly vanishes; for which it is `sure` that there are no others."""

    T: Array
    held: Array
    q: Array
    first: Array
    real: Flags
    rough: Flags
    beside: Flags
    sure: Flags


def compensated_rows(arm: Arm, T: Array, held: Array) -> tuple[Array, Flags, Flags]:
    """Rows (N, M, dof) of poses T (N, 4, 4) on no turn in particular, which are solutions (N, M), and which
    poses (N,) have no others."""
    rows = _start(arm, T, held)
    for turn in range(_ROUNDS):
        _compensate(arm, rows, turn == 0)
    rows.sure &= ~(rows.beside & rows.rough.any(axis=1))
    _take_pairs(arm, rows)
    found = rows.real & ~rows.rough
    rows.sure &= (distinct(arm, rows.q, found) == found).all(axis=1) & found.any(axis=1)
    return rows.q, found, rows.sure


def _start(arm: Arm, T: Array, held: Array) -> _Rows:
    """The closed form's rows, refined: those are rough that do not stand alone, or that it does not have
    behind a direction that has lost digits."""
    closed = closed_form(arm, T, None, held)
    q, hidden = closed.q, closed.singular & ~closed.valid
    real = closed.valid | (hidden & np.isfinite(q).all(axis=2))
    beside: Flags = np.asarray((closed.singular & closed.valid).any(axis=1))
    others = (hidden & ~real) | (real & closed.doubt)
    sure: Flags = np.asarray(real.any(axis=1) & ~others.any(axis=1))
    rows = _Rows(T, held, q, q.copy(), real, real.copy(), beside, sure)
    _refine(arm, rows, closed.valid & sure[:, None], 0.0)
    rows.real &= sure[:, None]
    rows.rough &= rows.real
    return rows


def _refine(arm: Arm, rows: _Rows, some: Flags, share: float) -> None:
    """Some rows (N, M): those that stand alone are rough no more, those that miss the pose are not real.
    `share`: as `refine_together` takes it."""
    assert arm.together is not None
    pose, lane = np.nonzero(some)
    if not len(pose):
        return
    aim = aims(arm, rows.T, rows.held)[pose]
    q, arrived, missed = arm.together(arm, rows.q[pose, lane], aim, share)
    rows.q[pose, lane] = q
    rows.rough[pose, lane] = ~(arrived | missed)
    rows.real[pose, lane] = ~missed


def _compensate(arm: Arm, rows: _Rows, first: bool) -> None:
    """Takes rough rows from compensated poses. Beside a divisor that nearly vanishes the others have to
    stand alone as well, at first, and rows must not cease to be."""
    rough = rows.rough & rows.sure[:, None]
    if rough.any():
        _displace(arm, rows, rough)
    others = rows.real & ~rows.rough & (rows.beside & first)[:, None]
    before = rows.real.copy()
    _refine(arm, rows, (rows.rough | others) & rows.sure[:, None], _SHARE)
    lost = (others & rows.rough) | (before & ~rows.real & rows.beside[:, None])
    rows.sure &= ~lost.any(axis=1)


def _displace(arm: Arm, rows: _Rows, some: Flags) -> None:
    """Takes some rows (N, M) from compensated poses; those that have none there are real no more."""
    assert arm.solved is not None
    pose, lane = np.nonzero(some)
    start = rows.q[pose, lane]
    turned = forward(arm.solved, start) @ inverses(forward(arm.chain, start))
    there = closed_form(arm, turned @ rows.T[pose], None, rows.held[pose])
    each = np.arange(len(pose))
    q, real = there.q[each, lane], (there.valid | there.singular)[each, lane]
    near = np.abs(differences(arm, start, q)).max(axis=1) < _ASIDE
    near &= real | ~rows.beside[pose]  # else its direction may be lost
    rows.sure[pose[~near]] = False
    rows.q[pose, lane] = q
    rows.real[pose, lane] = rows.rough[pose, lane] = real


def _take_pairs(arm: Arm, rows: _Rows) -> None:
    """The solutions that meet where two rough rows do, far from others: two of them, or none."""
    pose = np.flatnonzero(rows.sure & rows.rough.any(axis=1))
    if not len(pose):
        return
    q, rough = rows.q[pose], rows.rough[pose]
    gaps = np.abs(differences(arm, q[:, :, None], q[:, None])).max(axis=3)
    near = (gaps < _TOGETHER) & rows.real[pose][:, None] & ~np.eye(q.shape[1], dtype=bool)
    other = near.argmax(axis=2)
    fits = (near.sum(axis=2) == 1) & np.take_along_axis(rough, other, axis=1)
    rows.sure[pose] = (fits | ~rough).all(axis=1)
    first = rough & (other > np.arange(q.shape[1])) & rows.sure[pose][:, None]
    place, lane = np.nonzero(first)
    if len(place):
        _take_ends(arm, rows, pose[place], lane, other[place, lane])


def _take_ends(arm: Arm, rows: _Rows, pose: Index, one: Index, other: Index) -> None:
    """Take the ends of pairs of rows of poses (k,), on these lanes."""
    owner, side = np.repeat(pose, 2), np.tile([1.0, -1.0], len(pose))
    lane, aim = np.repeat(one, 2), aims(arm, rows.T, rows.held)[owner]
    start = rows.q[owner, lane]
    fold, _ = approach(arm, start, aim, side)
    way = differences(arm, fold, rows.first[owner, lane])
    moved = np.abs(way).max(axis=1)
    remote, farther = moved < _TOGETHER, _REMOTE * moved / (2 * (_HALTS - 1))
    for i in range(_HALTS):  # is there a second singularity from the fold to the closed form's row?
        _, slope = linearized(arm, fold + i * (way / (_HALTS - 1)), aim)
        remote &= np.linalg.svd(slope, compute_uv=False)[:, -2] > farther
    q, error, sigma = ends_of(arm, fold, aim)
    near = np.abs(differences(arm, start, q)).max(axis=1) < _TOGETHER
    good = near & (error < arm.policy.arrived) & (sigma >= arm.policy.singular_below)
    none = (error > _NONE).reshape(-1, 2).all(axis=1)
    known = (none | good.reshape(-1, 2).all(axis=1)) & remote.reshape(-1, 2).all(axis=1)
    rows.sure[pose[~known]] = False
    for k, lanes in enumerate((one, other)):
        rows.q[pose, lanes], rows.real[pose, lanes], rows.rough[pose, lanes] = q[k::2], ~none, False
