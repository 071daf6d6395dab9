"""Solutions near a singularity, where Newton's method stalls.

The pose is taken to second order along the direction in which it moves least, to first order along the
others (Lyapunov and Schmidt's reduction; Golubitsky & Schaeffer 1985, I.3)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.arm_newton import linearized, refined
from ikgen.runtime.python.array_types import Array, Flags, Index, Row
from ikgen.runtime.python.chain_kinematics import forward
from ikgen.runtime.python.refinement import least_singular, normal_inverse
from ikgen.runtime.python.row_links import differences
from ikgen.runtime.python.row_placement import distinct
from ikgen.runtime.python.solution_rows import places
from ikgen.runtime.python.solved_arm import Arm, Found

__all__ = [
    "Ends",
    "Starts",
    "ends_of",
    "joined",
    "repeats",
    "rows_nearby",
]

_ALONG = 1e-4  # rad or m
_CLOSE = 1e-9
_FAR = 0.3
_STEPS = 8


class Starts(NamedTuple):
    """Where Newton steps start: rows `q` (k, dof) for poses `T` (k, 4, 4), which rows are of the same pose,
    `pose` (k,), which the closed form `marked` (k,) as of a continuum, and the `source` (k,) of each:
    given (-1), the closed form for the pose (0), or for one beside it (1)."""

    q: Array
    T: Array
    pose: Index
    marked: Flags
    source: NDArray[np.int64]


def joined(one: Any, other: Any) -> Any:
    """Two tuples of arrays as one."""
    return type(one)(*map(np.concatenate, zip(one, other)))


class Ends(NamedTuple):
    """Where Newton steps end: rows `q` (k, dof), their `error` and the smallest singular value `loss` of
    the derivatives (k,)."""

    q: Array
    error: Array
    loss: Array


def ends_of(arm: Arm, q: Array, T: Array) -> Ends:
    """Where steps from rows q (k, dof) towards aims T end."""
    q, error, _, slope = refined(arm, q, T)
    return Ends(q, error, least_singular(slope))


def rows_nearby(arm: Arm, starts: Starts, ends: Ends) -> tuple[Index, Array, Array]:
    """Which start (m,) each solution (m, dof) comes from that steps lead to, those that are sure first, and
    the smallest singular values (m,) there.

    Where two may meet near a singularity both are found, and all around a continuum that the closed form
    has, where it marked a row, and the file's arm has not. What is given leads only to its own.
    """
    T, (q, error, loss) = starts.T, (x.copy() for x in ends)
    arrived, own = error < arm.policy.arrived, starts.source >= 0
    broken = starts.marked & (arm.rounded | ~arrived) & own
    near = own & ~starts.marked & (loss < arm.policy.fold_reach)
    settled = ~broken & np.where(near, error < arm.policy.converged, arrived)
    fresh = _fresh(arm, q, starts, near, near & ~settled)
    settled &= fresh
    near &= fresh
    owner, trial = np.flatnonzero(near), q[near]
    if broken.any():
        around, worst = _walk(arm, starts.q[broken], T[broken])
        isolated = np.flatnonzero(broken)[worst >= arm.policy.arrived]
        around = around[:, worst >= arm.policy.arrived]
        owner = np.concatenate([owner, np.repeat(isolated, len(around))])
        trial = np.concatenate([trial, around.transpose(1, 0, 2).reshape(-1, q.shape[1])])
    first, own_rows = np.flatnonzero(settled), q[settled]
    if not len(owner) and not (broken & arrived).any():
        return first, own_rows, loss[first]
    owner, side = np.repeat(owner, 2), np.tile([1.0, -1.0], len(owner))
    pairs = _approach(arm, np.repeat(trial, 2, axis=0), T[owner], side)
    pairs, left, there = ends_of(arm, pairs, T[owner])
    exact = left < arm.policy.exact
    for k, i in zip(np.flatnonzero(~exact).tolist(), owner[~exact].tolist()):
        if left[k] < error[i]:
            q[i], error[i], loss[i] = pairs[k], left[k], there[k]
    alone = np.flatnonzero((near | broken) & (error < arm.policy.arrived))
    alone = np.setdiff1d(alone, [*owner[exact], *first])
    source, rows = np.concatenate([owner[exact], alone]), np.concatenate([pairs[exact], q[alone]])
    order = np.argsort(source, kind="stable")
    rows = np.concatenate([own_rows, rows[order]])
    losses = np.concatenate([loss[first], np.concatenate([there[exact], loss[alone]])[order]])
    return np.concatenate([first, source[order]]), rows, losses


def _fresh(arm: Arm, q: Array, starts: Starts, near: Flags, stalled: Flags) -> Flags:
    """Which rows (k, dof) are not of a pose beside, and led to the same as an earlier one of their pose or
    stalled by one that is near another solution."""
    beside = starts.source > 0
    fresh = ~beside
    own = np.flatnonzero(np.isin(starts.pose, starts.pose[beside]) & (starts.source >= 0))
    if not len(own):
        return fresh
    own = own[np.argsort(starts.pose[own], kind="stable")]
    _, pose = np.unique(starts.pose[own], return_inverse=True)
    place = places(pose)
    rows = np.zeros((int(pose[-1]) + 1, int(place.max()) + 1, q.shape[1]))
    valid = np.zeros(rows.shape[:2], dtype=bool)
    rows[pose, place], valid[pose, place] = q[own], True
    fresh[own] |= distinct(arm, rows, valid)[pose, place]
    for k in np.flatnonzero(fresh & beside & stalled).tolist():
        others = q[:k][(fresh & near & (starts.pose == starts.pose[k]))[:k]]
        fresh[k] = not (np.abs(differences(arm, others, q[k])).max(axis=1) < arm.policy.alike).any()
    return fresh


def repeats(arm: Arm, T: Array, row: Row, kept: Sequence[Found]) -> bool:
    """Whether nothing tells a singular row from one kept nearby: the pose is theirs between them too."""
    others = [other for other, singular in kept if singular]
    gaps = differences(arm, np.array(row), np.array(others)) if others else np.zeros((0, len(row)))
    for gap in gaps[np.abs(gaps).max(axis=1) < arm.policy.alike]:
        middle = forward(arm.chain, np.array(row) + 0.5 * gap)
        if np.abs(arm.task.error(middle[None], T[None])).max() < arm.policy.halfway:
            return True
    return False


def _approach(arm: Arm, q: Array, T: Array, side: Array) -> Array:
    """From q (k, dof) towards the solution on one `side` (k,), 1 or -1, of the place where two may meet, or
    to where they nearly do; T (k, 4, 4)."""
    q, still, going = q.copy(), _generic(arm, len(q)), np.arange(len(q))
    for _ in range(_STEPS):
        q[going], still[going], x, _ = _step(arm, q[going], T[going], side[going], still[going])
        going = going[np.abs(x) > _CLOSE]
        if not len(going):
            break
    return q


def _walk(arm: Arm, q: Array, T: Array) -> tuple[Array, Array]:
    """Configurations (tries, k, dof) from q (k, dof) on, where the pose hardly moves, the fastest
    joint by `policy.try_step` from one to the next, and the largest errors (k,) there."""
    nowhere, moving = np.zeros(len(q)), list(arm.moving)
    q, still, _, _ = _step(arm, q, T, nowhere, _generic(arm, len(q)))
    worst, out = np.zeros(len(q)), []
    for _ in range(arm.policy.tries):
        for _ in range(2):
            q, still, _, error = _step(arm, q, T, nowhere, still)
        worst = np.maximum(worst, error)
        out.append(q)
        q = q.copy()
        q[:, moving] += arm.policy.try_step * still / np.abs(still).max(axis=1)[:, None]
    return np.array(out), worst


def _generic(arm: Arm, count: int) -> Array:
    return np.tile(1.0 + 0.1 * np.arange(len(arm.moving)), (count, 1))


def _step(
    arm: Arm, q: Array, T: Array, side: Array, still: Array
) -> tuple[Array, Array, Array, Array]:
    """q (k, dof) after a step, the unit directions (k, n) in which the pose moves least, in the sense of
    `still`, how far the step goes along them (k,), not at all on side 0, and the errors before (k,)."""
    columns = list(arm.moving)
    error, slope = linearized(arm, q, T)
    still = _still(slope, still, arm.policy.least_damping)
    flow = np.einsum("kej,kj->ke", slope, still)
    there = q.copy()
    there[:, columns] += _ALONG * still
    _, beyond = linearized(arm, there, T)
    bend = np.einsum("kej,kj->ke", beyond - slope, still) / _ALONG
    V = slope - flow[:, :, None] * still[:, None, :]
    Vt = V.transpose(0, 2, 1)
    A = (
        Vt @ V
        + still[:, :, None] * still[:, None, :]
        + arm.policy.least_damping * np.eye(len(columns))
    )
    z = np.stack([error, bend, flow], axis=2)
    across = np.linalg.solve(A, Vt @ z)
    rest, bend, flow = np.moveaxis(z - V @ across, 2, 0)
    x = np.where(side == 0.0, 0.0, _root(side, rest, bend, flow))
    q = q.copy()
    q[:, columns] += np.clip(across[:, :, 0], -_FAR, _FAR) + x[:, None] * still
    return q, still, x, np.abs(error).max(axis=1)


def _still(slope: Array, still: Array, damping: float) -> Array:
    """By inverse iteration, from what it was, which keeps its sense."""
    inverse = normal_inverse(slope, damping)
    for _ in range(4):
        still = (inverse @ still[:, :, None])[:, :, 0]
        still = still / np.linalg.norm(still, axis=1)[:, None]
    return still


def _root(side: Array, rest: Array, bend: Array, flow: Array) -> Array:
    """The root (k,) of s x + k x^2 / 2 = e on this side of the least error, along the direction that the
    others leave."""
    k, s, e = (np.einsum("ke,ke->k", bend, v) for v in (bend, flow, rest))
    w = np.sqrt(np.maximum(s * s + 2.0 * k * e, 0.0))
    p = s + np.copysign(w, s)
    with np.errstate(all="ignore"):
        x = np.where(((s > 0.0) == (side > 0.0)) & (p != 0.0), 2.0 * e / p, -p / k)
    return np.asarray(np.clip(np.nan_to_num(np.where(k > 0.0, x, 0.0)), -_FAR, _FAR))
