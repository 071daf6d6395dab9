"""All solutions of many poses at once, in arrays."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.held_parameters import aims, row_rank_loss
from ikgen.runtime.python.joint_arguments import held_rows, seed_rows
from ikgen.runtime.python.meeting_rows import Starts, rows_nearby
from ikgen.runtime.python.pose_arguments import poses_in_line
from ikgen.runtime.python.pose_faults import nearest_poses
from ikgen.runtime.python.pose_solving import solve_pose
from ikgen.runtime.python.refinement import refine, steeper
from ikgen.runtime.python.row_blocks import in_blocks
from ikgen.runtime.python.row_placement import distinct, place_rows_batch
from ikgen.runtime.python.solutions import Status
from ikgen.runtime.python.solved_arm import Arm, Together

__all__ = ["branch_axis", "careful_rows", "certain_rows", "rows_batch", "solve_poses"]

_CHUNK = 16384  # poses solved at a time,
_PART = 2048  # and closed forms: their arrays fit into a processor's cache
_Batch = tuple[Array, NDArray[np.int64], NDArray[np.str_]]


def branch_axis(level: int, depth: int) -> Array:
    """+1 and -1 along the axis of a level."""
    shape = [1] * (depth + 1)
    shape[level] = 2
    return np.array([1.0, -1.0]).reshape(shape)


def solve_poses(
    arm: Arm,
    poses: Any,
    free: ArrayLike | Mapping[str, float] | None,
    seed: ArrayLike | None,
    limits: bool,
    orthonormalize: bool = False,
) -> _Batch:
    """Rows (N, most, dof) padded with NaN, counts (N,) and names of Status (N,) for poses (N, 4, 4).

    Raises ValueError for bad arguments.
    """
    T = poses_in_line(poses, arm.task.alone)
    count, dof = len(T), len(arm.lower)
    near: Array | None = None
    if seed is not None:
        near = np.broadcast_to(seed_rows(arm, seed, (dof,), (count, dof)), (count, dof))
    held = held_rows(arm, free, near, count)
    q = np.full((count, arm.most, dof), np.nan)
    number = np.zeros(count, dtype=np.int64)
    status = np.full(count, Status.INVALID.value, dtype="<U11")
    if orthonormalize:
        T = nearest_poses(arm.task, T, arm.policy)
    T, good = arm.task.read_batch(T, arm.policy)
    usable, size = np.flatnonzero(good), _CHUNK
    for start in range(0, len(usable), size):
        part = usable[start : start + size]
        seeds = None if near is None else near[part]
        q[part], number[part], status[part] = _solve_chunk(arm, T[part], held[part], seeds, limits)
    return q, number, status


def _solve_chunk(arm: Arm, T: Array, held: Array, near: Array | None, limits: bool) -> _Batch:
    q, valid, alone = rows_batch(arm, T, held, near)
    real = valid.any(axis=1)
    q, inside = place_rows_batch(arm, q, near, limits)
    valid &= inside
    again = np.flatnonzero(alone | ((near is not None) & ~valid.any(axis=1)))
    distance: Array | Flags = ~valid
    if near is not None:
        with np.errstate(over="ignore"):
            far = float(np.finfo(float).max)
            distance = np.minimum(((q - near[:, None, :]) ** 2).sum(axis=2), far)
            distance = np.where(valid, distance, inf)
    order = np.argsort(distance, axis=1, kind="stable")[:, : arm.most, None]
    number = np.minimum(valid.sum(axis=1), arm.most)
    some = np.take_along_axis(q, order, axis=1)
    q = np.full((len(T), arm.most, q.shape[2]), np.nan)
    q[:, : some.shape[1]] = some
    q[np.arange(arm.most) >= number[:, None]] = np.nan
    status = np.where(number > 0, "OK", np.where(real, "LIMITS", "UNREACHABLE"))
    for i in again:
        seed = None if near is None else near[i]
        one = solve_pose(arm, T[i], held[i].tolist(), seed, limits)
        number[i], status[i], q[i] = len(one), one.status.value, np.nan
        q[i, : len(one)] = one.q
    return q, number, status


def rows_batch(arm: Arm, T: Array, held: Array, near: Array | None) -> tuple[Array, Flags, Flags]:
    """Rows (N, M, dof) on no turn in particular; which are distinct solutions, and which poses (N,) are to
    be solved alone: those with a continuum, and of arms that are not rounded those near a singularity."""
    if arm.together is None:
        q, valid, singular, steep = careful_rows(arm, T, held, near)
        return q, valid, singular.any(axis=1) | ~steep
    q, valid, singular, doubt = certain_rows(arm, arm.together, T, held, near)
    alone: Flags = np.asarray(singular.any(axis=1))
    look = np.flatnonzero(doubt & ~alone)
    if len(look):
        more, real, flat = _nearby_rows(
            arm, T[look], held[look], None if near is None else near[look]
        )
        alone[look] = flat
        width = max(q.shape[1], more.shape[1])
        q, valid = _widened(q, width), _widened(valid, width)
        q[look], valid[look] = _widened(more, width), _widened(real, width)
    return q, valid, alone


def _widened(rows: Any, width: int) -> Any:
    """Rows (N, M, ...) as (N, width, ...), the new ones 0."""
    out = np.zeros((len(rows), width, *rows.shape[2:]), dtype=rows.dtype)
    out[:, : rows.shape[1]] = rows
    return out


def _nearby_rows(arm: Arm, T: Array, held: Array, near: Array | None) -> tuple[Array, Flags, Flags]:
    """Distinct solutions (N, M, dof) that all rows of a rounded arm, and of poses beside, lead to, which
    there are (N, M), and which poses (N,) have a singular one, or want those of poses beside."""
    q, valid = _starts(arm, T, held, near)[:2]
    anywhere = arm.policy.beside_reach >= arm.policy.anywhere
    own = valid.shape[1] // (1 + len(arm.beside)) if anywhere else valid.shape[1]
    pose, column = np.nonzero(valid)
    marked, source = np.zeros(len(pose), dtype=bool), (column >= own).astype(int)
    starts = Starts(q[pose, column], aims(arm, T, held)[pose], pose, marked, source)
    owner, rows, close = rows_nearby(arm, starts)
    order = np.argsort(pose[owner], kind="stable")
    of, rows = pose[owner][order], rows[order]
    flat = np.zeros(len(T), dtype=bool)
    if len(rows):
        loss = row_rank_loss(arm, rows)
        flat[of[loss < arm.policy.rank_loss]] = True
    if not anywhere:
        flat[pose[close]] = True
    place = np.arange(len(of)) - np.searchsorted(of, of)
    q = np.zeros((len(T), int(place.max(initial=-1)) + 1, q.shape[2]))
    valid = np.zeros(q.shape[:2], dtype=bool)
    q[of, place], valid[of, place] = rows, True
    return q, distinct(arm, q, valid), flat


def _closed_form(arm: Arm, T: Array, start: Array, held: Array) -> tuple[Any, ...]:
    """`arm.branches_batch`, a part of the poses at a time."""
    with np.errstate(all="ignore"):
        found: tuple[Any, ...] = in_blocks(arm.branches_batch, _PART, T, start, held)
    return found


def certain_rows(
    arm: Arm, together: Together, T: Array, held: Array, near: Array | None
) -> tuple[Array, Flags, Flags, Flags]:
    """Rows (N, M, dof) of a rounded arm refined all at once, which of them are solutions, which of a
    continuum, and for which poses (N,) that leaves a doubt."""
    start = np.zeros((len(T), len(arm.lower))) if near is None else near
    q, valid, singular, _ = _closed_form(arm, T, start, held)
    q[:, :, list(arm.free)] = held[:, None, : len(arm.free)]
    pose, row = np.nonzero(valid)
    q[pose, row], arrived, missed = together(arm, q[pose, row], aims(arm, T, held)[pose])
    found, doubt = valid.copy(), np.zeros(len(T), dtype=bool)
    found[pose, row] = arrived
    doubt[pose[~(arrived | missed)]] = True
    doubt |= (distinct(arm, q, found) != found).any(axis=1)
    doubt |= singular.any(axis=1) | ~found.any(axis=1)
    return q, found, singular, doubt


def careful_rows(
    arm: Arm, T: Array, held: Array, near: Array | None
) -> tuple[Array, Flags, Flags, Flags]:
    """Rows (N, M, dof) of which each is refined for as long as it takes, near folds with those of poses
    beside; which are distinct solutions, which of a continuum, and which poses (N,) have no refined one
    near a singularity."""
    q, valid, singular, rough = _starts(arm, T, held, near)
    steep = np.ones(len(T), dtype=bool)
    pose, row = np.nonzero(rough & valid)
    if len(pose):
        aim, found = aims(arm, T, held)[pose], q[pose, row]
        done = refine(arm.chain, arm.task, arm.moving, found, aim, arm.policy, arm.angle)
        q[pose, row], valid[pose, row] = done[0], done[1] < arm.policy.arrived
        steep[pose[~steeper(done[3], arm.policy.fold_reach)]] = False
    return q, distinct(arm, q, valid), singular, steep


def _starts(
    arm: Arm, T: Array, held: Array, near: Array | None
) -> tuple[Array, Flags, Flags, Flags]:
    """The closed form's rows (N, M, dof) of poses, and of those beside where they always count; valid and
    rough ones (N, M), and those of a continuum."""
    start = np.zeros((len(T), len(arm.lower))) if near is None else near
    anywhere = arm.policy.beside_reach >= arm.policy.anywhere
    q, valid, singular, rough = _closed_form(arm, T, start, held)
    if len(arm.beside) and anywhere:
        more = [_closed_form(arm, T @ D, start, held) for D in arm.beside]
        q, valid, rough = (
            np.concatenate([first, *(part[k] for part in more)], axis=1)
            for k, first in ((0, q), (1, valid), (3, rough))
        )
    q[:, :, list(arm.free)] = held[:, None, : len(arm.free)]
    return q, valid, singular, rough
