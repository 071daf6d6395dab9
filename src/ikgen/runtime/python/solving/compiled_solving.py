"""The functions of an arm whose solver is compiled: arguments of any form, and what its answers mean."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from functools import partial
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ikgen.runtime.python.arguments.joint_arguments import (
    held_rows,
    held_values,
    seed_rows,
    seed_values,
)
from ikgen.runtime.python.arguments.pose_arguments import one_pose, poses_in_line
from ikgen.runtime.python.arguments.pose_faults import nearest_pose, nearest_poses, pose_fault
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index, Row
from ikgen.runtime.python.rows.compiled_rows import (
    STATUSES,
    BranchNames,
    Found,
    found_nothing,
    found_rows,
)
from ikgen.runtime.python.rows.row_preference import preference_of
from ikgen.runtime.python.rows.solutions import Solutions, Status, no_held_values, no_solutions
from ikgen.runtime.python.solving.path_following import Path
from ikgen.runtime.python.solving.pose_solving import held_reason

__all__ = [
    "CompiledBatch",
    "Solver",
    "compiled_batch",
    "compiled_follow",
    "compiled_search",
    "compiled_solve",
]

CompiledBatch = tuple[Array, NDArray[np.int64], NDArray[np.str_]]


class Solver(Protocol):
    """Compiled functions: poses (4, 4) or (N, 4, 4); rows `held` (n, held joints) and `seed` (n, dof) of as
    many poses, of all alike (n = 1), or of none (n = 0, which leaves them to the solver)."""

    def solve(
        self, pose: object, held: object, seed: object, limits: object, project: object
    ) -> Found | None:
        """None where an argument is no plain array of the right shape, or a seed is not finite."""

    def solve_batch(
        self, poses: Array, held: Array, seed: Array, limits: bool
    ) -> tuple[Array, NDArray[np.int64], Index]:
        """Rows (N, most, dof) padded with NaN, counts (N,), and indices (N,) of `STATUSES`."""

    def search(self, pose: Array, seed: Array, prefer: str, limits: bool) -> Found:
        """The rows that are best."""

    def follow(self, poses: Array, start: Array, limits: bool) -> tuple[Array, int, int, Flags]:
        """Rows (N, dof) padded with NaN, how many were reached, an index of `STATUSES`, flags (N,)."""


def compiled_solve(
    arm: Arm,
    solver: Solver,
    names: BranchNames,
    found: Found | None,
    pose: Any,
    free: Sequence[float] | Mapping[str, float] | None,
    seed: ArrayLike | None,
    limits: bool,
    project: bool,
    orthonormalize: bool,
) -> Solutions:
    """As `solve_pose`; `found`: what the solver made of the arguments as they are, where it took them.
    Raises ValueError for bad arguments."""
    if found is None:
        T, near = one_pose(pose, arm.task.alone), seed_values(arm, seed)
        held = None if free is None else held_values(arm, free, near)
        if orthonormalize:
            T = np.array(nearest_pose(arm.task, T.tolist(), arm.policy))
        found = solver.solve(T, held, near, limits, project)
        assert found is not None
        if len(found):
            return found_rows(found, names, project)
        pose = T
    status = STATUSES[found.status]
    if status is Status.INVALID:
        return _no_pose(arm, found, pose)
    if not arm.free_joints:
        return found_nothing(found, status, str)
    if free is not None or seed is not None:
        free, seed = copy(free), copy(seed)  # theirs may change
    return found_nothing(found, status, partial(_reason, arm, free, seed, status is Status.LIMITS))


def _reason(
    arm: Arm,
    free: Sequence[float] | Mapping[str, float] | None,
    seed: ArrayLike | None,
    real: bool,
) -> str:
    return held_reason(arm, held_values(arm, free, seed_values(arm, seed)), real)


def _no_pose(arm: Arm, found: Found, T: Array) -> Solutions:
    reason = pose_fault(arm.task, np.asarray(T).tolist(), arm.policy)
    return found_nothing(found, Status.INVALID, lambda: reason)


def compiled_batch(
    arm: Arm,
    solver: Solver,
    poses: Any,
    free: ArrayLike | Mapping[str, float] | None,
    seed: ArrayLike | None,
    limits: bool,
    orthonormalize: bool,
) -> CompiledBatch:
    """As `solve_poses`. Raises ValueError for bad arguments."""
    T, dof = poses_in_line(poses, arm.task.alone), len(arm.lower)
    count = len(T)
    near, held = np.empty((0, dof)), np.empty((0, len(arm.free_joints)))
    if seed is not None:
        near = np.atleast_2d(seed_rows(arm, seed, (dof,), (count, dof)))
    if free is not None:
        seeds = None if seed is None else np.broadcast_to(near, (count, dof))
        held = held_rows(arm, free, seeds, count)
        held = held[:1] if (held == held[:1]).all() else held
    if orthonormalize:
        T = nearest_poses(arm.task, T, arm.policy)
    q, number, codes = solver.solve_batch(T, held, near, bool(limits))
    return q, number, np.array([status.value for status in STATUSES])[codes]


def compiled_search(
    arm: Arm,
    solver: Solver,
    names: BranchNames,
    pose: Any,
    seed: ArrayLike | None,
    prefer: str,
    limits: bool,
) -> Solutions:
    """As the searches of Python. Raises ValueError for bad arguments."""
    preference_of(arm, prefer, seed)
    T, near = one_pose(pose, arm.task.alone), seed_values(arm, seed)
    found = solver.search(T, _rows_of(near, len(arm.lower)), prefer, bool(limits))
    if len(found):
        return found_rows(found, names, False)
    status = STATUSES[found.status]
    if status is Status.INVALID:
        return _no_pose(arm, found, T)
    if arm.free_joints:
        return no_held_values(len(arm.lower), arm.free_joints, status is Status.LIMITS)
    return no_solutions(len(arm.lower), status)


def compiled_follow(arm: Arm, solver: Solver, poses: Any, start: ArrayLike, limits: bool) -> Path:
    """As `follow_poses`. Raises ValueError for bad arguments."""
    T = poses_in_line(poses, arm.task.alone)
    row = seed_rows(arm, start, (len(arm.lower),), name="start")
    q, reached, status, singular = solver.follow(T, row, bool(limits))
    return Path(q, reached, STATUSES[status], singular)


def _rows_of(row: Row | None, dof: int) -> Array:
    return np.array(() if row is None else row).reshape(-1, dof)
