"""The closed form's rows of many poses, and what Newton steps make of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.held_parameters import aims
from ikgen.runtime.python.arm.solved_arm import Arm, Together
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.arrays.row_blocks import in_blocks
from ikgen.runtime.python.newton.arm_newton import refined
from ikgen.runtime.python.newton.refinement import steeper
from ikgen.runtime.python.rows.row_placement import distinct

__all__ = [
    "AllRows",
    "Beside",
    "ClosedForm",
    "all_rows",
    "careful",
    "careful_rows",
    "certain_rows",
    "closed_form",
    "rows_beside",
]

_PART = 2048  # poses whose arrays fit into a processor's cache


class ClosedForm(NamedTuple):
    """Rows `q` (N, M, dof); which are `valid`, which `singular`, of a continuum, or not valid, but behind
    a joint that the pose leaves free, or one an elimination can't tell of, which are `rough` (N, M), and
    beside which the file's geometry may have others: a `doubt`."""

    q: Array
    valid: Flags
    singular: Flags
    rough: Flags
    doubt: Flags

    @property
    def free(self) -> Flags:
        """Which poses (N,) leave a joint free."""
        return np.asarray(self.singular.any(axis=1))


class Beside(NamedTuple):
    """Rows `q` (N, M, dof) of poses beside, one after the other, which are `valid` (N, M), which
    `marked`, of a continuum, and which leave a `doubt`."""

    q: Array
    valid: Flags
    marked: Flags
    doubt: Flags


class AllRows(NamedTuple):
    """The closed form's rows of poses, and those of poses `beside`: none where they do not always count."""

    own: ClosedForm
    beside: Beside


def closed_form(arm: Arm, T: Array, near: Array | None, held: Array) -> ClosedForm:
    """Rows of the closed form for poses T (N, 4, 4), joints that they leave free at values `near`
    (N, dof)."""
    start = np.zeros((len(T), len(arm.lower))) if near is None else near
    with np.errstate(all="ignore"):
        found = ClosedForm(*in_blocks(arm.branches_batch, _PART, T, start, held))
    if arm.branches is None:
        pose, lane = np.nonzero(np.isnan(found.q).any(axis=2))
        found.q[pose, lane] = start[pose]
        found.singular[pose, lane] = True
    found.q[:, :, list(arm.free)] = held[:, None, : len(arm.free)]
    return found


def all_rows(arm: Arm, T: Array, near: Array | None, held: Array) -> AllRows:
    """All rows for poses T (N, 4, 4), as `closed_form` has them."""
    own = closed_form(arm, T, near, held)
    if len(arm.beside) and arm.policy.beside_anywhere:
        return AllRows(own, rows_beside(arm, T, near, held))
    none = own.valid[:, :0]
    return AllRows(own, Beside(own.q[:, :0], none, none, none))


def rows_beside(arm: Arm, T: Array, near: Array | None, held: Array) -> Beside:
    """The closed form's rows of poses beside T (N, 4, 4)."""
    each = len(arm.beside)
    poses = (T[:, None] @ arm.beside).reshape(-1, 4, 4)
    starts = None if near is None else np.repeat(near, each, axis=0)
    closed = closed_form(arm, poses, starts, np.repeat(held, each, axis=0))
    valid = closed.valid.reshape(len(T), -1)
    marked = closed.singular.reshape(len(T), -1) & valid
    doubt = closed.doubt.reshape(len(T), -1) & valid
    return Beside(closed.q.reshape(len(T), -1, closed.q.shape[2]), valid, marked, doubt)


def certain_rows(
    arm: Arm, together: Together, T: Array, held: Array, near: Array | None
) -> tuple[Array, Flags, Flags]:
    """Rows (N, M, dof) of a rounded arm refined all at once, which of them are solutions, and for which
    poses (N,) that leaves a doubt."""
    closed = closed_form(arm, T, near, held)
    q, valid, doubt = (
        closed.q,
        closed.valid,
        closed.free | (closed.valid & closed.doubt).any(axis=1),
    )
    pose, row = np.nonzero(valid)
    q[pose, row], arrived, missed = together(arm, q[pose, row], aims(arm, T, held)[pose])
    found = valid.copy("K")
    found[pose, row] = arrived
    doubt[pose[~(arrived | missed)]] = True
    doubt |= (distinct(arm, q, found) != found).any(axis=1) | ~found.any(axis=1)
    return q, found, doubt


def careful_rows(arm: Arm, T: Array, held: Array, near: Array | None) -> tuple[Array, Flags, Flags]:
    """Rows (N, M, dof) of which each is refined for as long as it takes, with those of poses beside where
    they always count; which are distinct solutions, and which poses (N,) have rows of a continuum or near
    a singularity."""
    return careful(arm, all_rows(arm, T, near, held), T, held)


def careful(arm: Arm, rows: AllRows, T: Array, held: Array) -> tuple[Array, Flags, Flags]:
    """`careful_rows` of what the closed form has."""
    own, beside = rows
    q = np.concatenate([own.q, beside.q], axis=1)
    valid = np.concatenate([own.valid, beside.valid], axis=1)
    rough, doubt = np.ones_like(valid) if beside.q.shape[1] else own.rough, own.free
    pose, row = np.nonzero(rough & valid)
    if len(pose):
        found, error, _, slope = refined(arm, q[pose, row], aims(arm, T, held)[pose])
        q[pose, row], valid[pose, row] = found, error < arm.policy.arrived
        doubt[pose[~steeper(slope, arm.policy.fold_reach)]] = True
    return q, distinct(arm, q, valid), doubt
