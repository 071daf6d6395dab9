"""All solutions of many poses at once, in arrays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ikgen.runtime.python.arguments.joint_arguments import held_rows, seed_rows
from ikgen.runtime.python.arguments.pose_arguments import poses_in_line
from ikgen.runtime.python.arguments.pose_faults import nearest_poses, too_far
from ikgen.runtime.python.arm.solved_arm import Arm, Found
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.rows.row_placement import in_order, place_rows, place_rows_batch
from ikgen.runtime.python.rows.solution_rows import places
from ikgen.runtime.python.rows.solutions import Status
from ikgen.runtime.python.solving.asked_poses import Asked
from ikgen.runtime.python.solving.closed_form_rows import careful_rows, certain_rows
from ikgen.runtime.python.solving.compensated_rows import compensated_rows
from ikgen.runtime.python.solving.doubtful_poses import placed_rows
from ikgen.runtime.python.solving.doubtful_rows import seeded_rows, unplaced_rows

__all__ = ["branch_axis", "rows_batch", "solve_poses"]

_CHUNK = 16384  # poses solved at a time
_DOUBTS = 512  # poses that leave doubts solved at a time
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
    if not good.all():
        status[~good & too_far(arm.task, T, arm.policy)] = Status.UNREACHABLE.value
    usable, size = np.flatnonzero(good), _CHUNK
    for start in range(0, len(usable), size):
        part = usable[start : start + size]
        seeds = None if near is None else near[part]
        q[part], number[part], status[part] = _solve_chunk(arm, T[part], held[part], seeds, limits)
    return q, number, status


def _solve_chunk(arm: Arm, T: Array, held: Array, near: Array | None, limits: bool) -> _Batch:
    q, valid, doubt = _rows_and_doubts(arm, T, held, near)
    real: Flags = np.asarray(valid.any(axis=1))
    q, inside, close = place_rows_batch(arm, q, near, limits)
    doubt |= (valid & close).any(axis=1)
    valid &= inside
    q, number = _in_first_places(arm, q, valid, near)
    asked = Asked(T, near, held)
    for i, rows, some_real in _doubtful(arm, asked, limits, doubt, real, number):
        found = in_order(arm, rows, asked.seed(i))
        number[i], real[i], q[i] = len(found), some_real, np.nan
        q[i, : len(found)] = np.array([row for row, _ in found]).reshape(-1, q.shape[2]) + 0.0
    status = np.where(number > 0, "OK", np.where(real, "LIMITS", "UNREACHABLE"))
    return q, number, status


def _in_first_places(
    arm: Arm, q: Array, valid: Flags, near: Array | None
) -> tuple[Array, NDArray[np.int64]]:
    """The valid ones of rows (N, M, dof), padded with NaN to (N, most, dof), nearest to seeds first;
    and how many there are (N,)."""
    if near is not None:
        with np.errstate(over="ignore"):
            far = float(np.finfo(float).max)
            distance = np.minimum(((q - near[:, None, :]) ** 2).sum(axis=2), far)
        order = np.argsort(np.where(valid, distance, inf), axis=1, kind="stable")
        q = np.take_along_axis(q, order[:, :, None], axis=1)
        valid = np.take_along_axis(valid, order, axis=1)
    out = np.full((len(q), max(q.shape[1], arm.most), q.shape[2]), np.nan)
    pose, row = np.nonzero(valid)
    out[pose, places(pose)] = q[pose, row] + 0.0
    return out[:, : arm.most], np.minimum(valid.sum(axis=1, dtype=np.int64), arm.most)


def _doubtful(
    arm: Arm, asked: Asked, limits: bool, doubt: Flags, real: Flags, number: Index
) -> Iterator[tuple[int, list[Found], bool]]:
    """Poses, their rows and whether they have any before limits: of those that leave a doubt, and of others
    without a row what their seeds lead to."""
    for some in _parts(doubt):
        for i, answer in zip(some.tolist(), placed_rows(arm, asked.at(some), limits)):
            yield i, answer.rows, answer.real
    for some in _parts(~doubt & (number == 0)) if asked.near is not None else ():
        for i, rows in zip(some.tolist(), seeded_rows(arm, asked.at(some))):
            yield i, place_rows(arm, rows, asked.seed(i), limits), bool(real[i])


def _parts(poses: Flags) -> list[Index]:
    index = np.flatnonzero(poses)
    return [index[i : i + _DOUBTS] for i in range(0, len(index), _DOUBTS)]


def _rows_and_doubts(
    arm: Arm, T: Array, held: Array, near: Array | None
) -> tuple[Array, Flags, Flags]:
    """Rows (N, M, dof) on no turn in particular; which are distinct solutions, and which poses (N,) are
    near a singularity, or leave a joint free."""
    if arm.together is None:
        return careful_rows(arm, T, held, near)
    q, valid, doubt = certain_rows(arm, arm.together, T, held, near)
    for some in _parts(doubt):
        more, found, sure = compensated_rows(arm, T[some], held[some])
        q[some[sure]], valid[some[sure]], doubt[some[sure]] = more[sure], found[sure], False
    return q, valid, doubt


def rows_batch(arm: Arm, T: Array, held: Array) -> tuple[Array, Flags]:
    """Rows (N, M, dof) on no turn in particular, and which are distinct solutions; a rounded arm's with
    those near singularities."""
    q, valid, doubt = _rows_and_doubts(arm, T, held, None)
    if not arm.rounded:
        return q, valid
    wide = np.zeros((len(T), max(arm.most, q.shape[1]), q.shape[2]))
    real = np.zeros(wide.shape[:2], dtype=bool)
    wide[:, : q.shape[1]], real[:, : q.shape[1]] = q, valid & ~doubt[:, None]
    for some in _parts(doubt):
        for i, rows in zip(some.tolist(), unplaced_rows(arm, T[some], held[some])):
            for k, (row, _) in enumerate(rows[: arm.most]):
                wide[i, k], real[i, k] = row, True
    return wide, real
