"""All solutions of many poses at once, in arrays."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.joint_arguments import held_rows, seed_rows
from ikgen.runtime.python.joint_refinement import refine_together
from ikgen.runtime.python.pose_arguments import poses_in_line
from ikgen.runtime.python.pose_faults import nearest_poses
from ikgen.runtime.python.pose_solving import solve_pose
from ikgen.runtime.python.refinement import refine
from ikgen.runtime.python.row_placement import distinct, place_rows_batch
from ikgen.runtime.python.solutions import Status
from ikgen.runtime.python.solved_arm import Arm

__all__ = ["branch_axis", "careful_rows", "certain_rows", "rows_batch", "solve_poses"]

_CHUNK = 2048  # closed forms solved at a time
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
    q, valid, singular = rows_batch(arm, T, held, near)
    real = valid.any(axis=1)
    q, inside = place_rows_batch(arm, q, near, limits)
    valid &= inside
    again = np.flatnonzero(singular.any(axis=1) | ((near is not None) & ~valid.any(axis=1)))
    distance: Array | Flags = ~valid
    if near is not None:
        with np.errstate(over="ignore"):
            far = float(np.finfo(float).max)
            distance = np.minimum(((q - near[:, None, :]) ** 2).sum(axis=2), far)
            distance = np.where(valid, distance, inf)
    order = np.argsort(distance, axis=1, kind="stable")[:, : arm.most, None]
    number = np.minimum(valid.sum(axis=1), arm.most)
    q = np.take_along_axis(q, order, axis=1)
    q[np.arange(q.shape[1]) >= number[:, None]] = np.nan
    status = np.where(number > 0, "OK", np.where(real, "LIMITS", "UNREACHABLE"))
    for i in again:
        seed = None if near is None else near[i]
        one = solve_pose(arm, T[i], held[i].tolist(), seed, limits)
        number[i], status[i], q[i] = len(one), one.status.value, np.nan
        q[i, : len(one)] = one.q
    return q, number, status


def rows_batch(arm: Arm, T: Array, held: Array, near: Array | None) -> tuple[Array, Flags, Flags]:
    """Rows (N, M, dof) on no turn in particular; which are distinct solutions, which of a continuum."""
    if not arm.rounded:
        return careful_rows(arm, T, held, near)
    q, valid, singular, doubt = certain_rows(arm, T, held, near)
    if doubt.any():
        seeds = None if near is None else near[doubt]
        more, fine, flags = careful_rows(arm, T[doubt], held[doubt], seeds)
        order = np.argsort(~fine, axis=1, kind="stable")[:, : q.shape[1]]
        q[doubt] = np.take_along_axis(more, order[:, :, None], axis=1)
        valid[doubt] = np.take_along_axis(fine, order, axis=1)
        singular = singular.copy()
        singular[doubt] = flags
    return q, valid, singular


def certain_rows(
    arm: Arm, T: Array, held: Array, near: Array | None
) -> tuple[Array, Flags, Flags, Flags]:
    """Rows (N, M, dof) of a rounded arm refined all at once, which of them are solutions, which of a
    continuum, and for which poses (N,) that leaves a doubt."""
    start = np.zeros((len(T), len(arm.lower))) if near is None else near
    with np.errstate(all="ignore"):
        q, valid, singular, _ = arm.branches_batch(T, start, held)
    q[:, :, arm.free] = held[:, None, :]
    pose, row = np.nonzero(valid)
    q[pose, row], arrived, missed = refine_together(arm, q[pose, row], T[pose])
    found, doubt = valid.copy(), np.zeros(len(T), dtype=bool)
    found[pose, row] = arrived
    doubt[pose[~(arrived | missed)]] = True
    doubt |= (distinct(arm, q, found) != found).any(axis=1)
    doubt |= singular.any(axis=1) | ~found.any(axis=1)
    return q, found, singular, doubt


def careful_rows(arm: Arm, T: Array, held: Array, near: Array | None) -> tuple[Array, Flags, Flags]:
    """Rows of which each is refined for as long as it takes, near folds with those of poses beside."""
    start = np.zeros((len(T), len(arm.lower))) if near is None else near
    with np.errstate(all="ignore"):
        q, valid, singular, rough = arm.branches_batch(T, start, held)
        if len(arm.beside):
            more = [arm.branches_batch(T @ D, start, held) for D in arm.beside]
            q, valid, rough = (
                np.concatenate([first, *(part[k] for part in more)], axis=1)
                for k, first in ((0, q), (1, valid), (3, rough))
            )
    q[:, :, arm.free] = held[:, None, :]
    pose, row = np.nonzero(rough & valid)
    if len(pose):
        done = refine(arm.chain, arm.task, arm.moving, q[pose, row], T[pose], arm.policy)
        q[pose, row], valid[pose, row] = done[:2]
    return q, distinct(arm, q, valid), singular
