"""Solutions on what is a surface of the geometry that was solved, and none of the file's.

Two directions hardly move the pose there, as those of the joints that turn a tool about its own tip. The
others take the pose's error away but for as many directions (as in `near_continuum`); Newton steps of what
is left, along the surface, lead to where that vanishes."""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.newton.arm_newton import linearized
from ikgen.runtime.python.rows.row_links import neighbouring_rows
from ikgen.runtime.python.rows.solution_rows import places
from ikgen.runtime.python.singular.meeting_rows import Leads, Starts

__all__ = ["on_surfaces"]

_WIDE, _PLACES = 4, 4  # starts of a pose around which others are taken, and how many to a turn
_FLAT = 0.15  # of where a continuum is followed: farther off the closed form's rows tell all
_STEPS, _CORRECTIONS, _ROOM = 40, 6, 32
_FAR, _NEAR = 0.4, 1e-7  # rad or m
_DAMPING, _STIFFER, _LEAST = 1e-3, 10.0, 1e-4  # of how much what is left grows, squared
_ROUND_OFF = 1e-30  # of a squared error


class _Samples(NamedTuple):
    """Configurations `q` (k, dof), of surfaces where `on` (k,) is set; what is `left` (k,) of the errors
    there, squared; unit directions `still` (k, 2, n) in the surfaces, how they move the poses, `moves`
    (k, 2), and the errors along that, `along` (k, 2)."""

    q: Array
    on: Flags
    left: Array
    still: Array
    moves: Array
    along: Array


def on_surfaces(arm: Arm, leads: Leads) -> Starts:
    """Next to the solutions on surfaces that the ends of starts lie on, no two of a pose alike. Those that
    stand for a continuum, of one direction, may lie on one as well."""
    (starts, ends), policy = leads[:2], arm.policy
    reach = _FLAT * policy.broken_reach
    near = starts.marked | (ends.sigma < min(reach, policy.fold_reach))
    some = np.flatnonzero(near & (starts.source >= 0))
    if len(arm.moving) > 2 and len(some):
        some = some[np.argsort(starts.pose[some], kind="stable")]
        _, slope = linearized(arm, ends.q[some], starts.T[some])
        _, moves, still = np.linalg.svd(slope, full_matrices=False)
        flat = moves[:, -2] < reach
        some, still = some[flat], still[flat, -2:]
    if len(arm.moving) <= 2 or not len(some):
        return _of(starts, some[:0], ends.q[:0])
    start, q = _places(arm, ends.q[some], still, starts.pose[some])
    start = some[start]
    q, left = _descended(arm, q, starts.T[start])
    arrived = np.flatnonzero(left < policy.arrived**2)
    kept = _unlike(arm, q[arrived], starts.pose[start[arrived]])
    return _of(starts, start[arrived[kept]], q[arrived[kept]])


def _of(starts: Starts, index: Index, q: Array) -> Starts:
    """Rows q (n, dof) as those of the closed form for the poses of some starts (n,)."""
    none = np.zeros(len(index), dtype=np.int64)
    return starts._replace(
        q=q, T=starts.T[index], pose=starts.pose[index], marked=none > 0, source=none, lane=none
    )


def _places(arm: Arm, q: Array, still: Array, pose: Index) -> tuple[Index, Array]:
    """Configurations (n, dof) and the rows (n,) q (k, dof) that they are from: these, and of the first few
    of a pose (k,) others all around, by turns of the two joints that the directions `still` (k, 2, n) in
    the surface move most."""
    moving = np.array(arm.moving)
    turning = np.flatnonzero(np.asarray(arm.period)[moving])
    pairs = np.array(list(combinations(turning.tolist(), 2)), dtype=np.intp).reshape(-1, 2)
    rows = np.where(places(pose) < _WIDE, _PLACES**2 if len(pairs) else 1, 1)
    owner = np.repeat(np.arange(len(q)), rows)
    out = q[owner]
    if len(pairs):
        (a, b), (one, other) = pairs.T, still.transpose(1, 0, 2)
        area = np.abs(one[:, a] * other[:, b] - one[:, b] * other[:, a])
        turned = moving[pairs[area.argmax(axis=1)]][owner]
        steps = np.stack(np.divmod(places(owner), _PLACES), axis=1)
        out[np.arange(len(out))[:, None], turned] += (
            np.asarray(arm.period)[turned] / _PLACES * steps
        )
    return owner, out


def _settled(arm: Arm, q: Array, T: Array) -> _Samples:
    """The configurations of surfaces beside some (k, dof), by steps across."""
    moving, count = list(arm.moving), len(q)
    n = len(moving)
    pair = np.zeros((count, 2))
    out = _Samples(
        q.copy(), pair[:, 0] > 0.0, pair[:, 0] + np.inf, np.zeros((count, 2, n)), pair, pair.copy()
    )
    going = np.arange(count)
    for _ in range(_CORRECTIONS):
        error, slope = linearized(arm, out.q[going], T[going])
        u, moves, v = np.linalg.svd(slope, full_matrices=False)
        along = np.einsum("kmi,km->ki", u, error)
        rest = error - np.einsum("kmi,ki->km", u[:, :, :-2], along[:, :-2])
        across = np.einsum("ki,kin->kn", along[:, :-2] / moves[:, :-2], v[:, :-2])
        out.q[going[:, None], moving] += np.clip(across, -_FAR, _FAR)
        out.on[going] = on = np.abs(across).max(axis=1) < _NEAR
        out.left[going], out.still[going] = np.einsum("km,km->k", rest, rest), v[:, -2:]
        out.moves[going], out.along[going] = moves[:, -2:], along[:, -2:]
        going = going[~on]
        if not len(going):
            break
    return out


def _descended(arm: Arm, q: Array, T: Array) -> tuple[Array, Array]:
    """Where damped Newton steps along surfaces (Marquardt 1963) lead from rows q (k, dof) until a few leave
    hardly less, and what is left (k,) of the squared errors there: infinite beside none."""
    with np.errstate(all="ignore"):
        now = _settled(arm, q, T)
        now.left[~now.on] = np.inf
        square = (now.moves**2).sum(axis=1)
        damping, going = _DAMPING * square, np.flatnonzero(now.on)
        stalled = np.zeros(len(q), dtype=np.intp)
        for _ in range(_STEPS):
            on = (now.left > _ROUND_OFF) & (stalled < arm.policy.patience)
            going = going[on[going]]
            if not len(going):
                break
            here = some_of(now, going)
            step = here.moves * here.along / (here.moves**2 + damping[going, None])
            length = np.sqrt((step**2).sum(axis=1))
            step *= np.minimum(1.0, _FAR / np.maximum(length, _FAR))[:, None]
            ahead = here.q.copy()
            ahead[:, list(arm.moving)] += np.einsum("ki,kin->kn", step, here.still)
            there = _settled(arm, ahead, T[going])
            better = there.on & (there.left < here.left)
            less = there.on & (there.left < arm.policy.progress**2 * here.left)
            stalled[going] = np.where(less, 0, stalled[going] + 1)
            stiffer = np.maximum(_STIFFER * damping[going], _LEAST * (here.moves**2).sum(axis=1))
            damping[going] = np.where(better, damping[going] / _STIFFER, stiffer)
            for whole, part in zip(now, there):
                whole[going[better]] = part[better]
    return now.q, now.left


def _unlike(arm: Arm, q: Array, pose: Index) -> Index:
    """The rows q (k, dof) that are like no earlier one of their pose (k,)."""
    kept: list[int] = []
    for k, row in enumerate(q):
        others = [i for i in kept if pose[i] == pose[k]]
        if len(others) < _ROOM and not neighbouring_rows(arm, q[others], row).any():
            kept.append(k)
    return np.array(kept, dtype=np.intp)
