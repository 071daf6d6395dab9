"""Curves that cross others, on which all but one direction of the pose's error is taken away: there two
directions hardly move the pose."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.newton.arm_newton import linearized, moved_rows
from ikgen.runtime.python.rows.solution_rows import places
from ikgen.runtime.python.singular.curve_parts import Parts, between
from ikgen.runtime.python.singular.curve_samples import aside
from ikgen.runtime.python.singular.fold_pair import Reduced, flow_and_others, keeps_sense, unit

__all__ = ["Crossings", "crossings_of"]

_CROSSINGS = 4  # crossings of a curve
_HALVES = 4  # by which they are found


class Crossings(NamedTuple):
    """Places where others cross the curves of `owner` (n,): rows `near` (n, 2, dof) to both sides on the
    curve, the samples' of the `part` (n, 2, dof), and one `beside` (n, dof), by a way along the second
    direction that hardly moves the pose."""

    owner: Index
    near: Array
    part: Array
    beside: Array


def crossings_of(arm: Arm, parts: Parts, T: Array) -> Crossings:
    """Where others cross the curves of some parts.

    Where that one is passed, the sense turns round in which the others with the still one for what is left
    move the pose; of arms with fewer joints than equations nothing tells."""
    owner, a, b = parts.owner, parts.a, parts.b
    pairs = np.stack([a.q, a.q], axis=1)[:0]
    none = Crossings(owner[:0], pairs, pairs, a.q[:0])
    if not len(owner) or a.out.shape != a.still.shape:
        return none
    sense = _keeps(arm, a, T[owner])
    crossing = np.flatnonzero(sense != _keeps(arm, b, T[owner]))
    crossing = crossing[np.argsort(owner[crossing], kind="stable")]
    crossing = crossing[places(owner[crossing]) < _CROSSINGS]
    if not len(crossing):
        return none
    parts, sense = some_of(parts, crossing), sense[crossing]
    aim, each = T[parts.owner], np.arange(len(crossing))
    ends = Reduced(*map(np.stack, zip(parts.a, parts.b)))
    for _ in range(_HALVES):
        now = parts._replace(a=some_of(ends, 0), b=some_of(ends, 1))
        middle = between(arm, now, np.full(len(each), 0.5), T)
        side = (_keeps(arm, middle, aim) != sense).astype(np.intp)
        for whole, part in zip(ends, middle):
            whole[side, each] = part
    at = some_of(ends, 0)
    along, _ = unit((parts.b.q - parts.a.q)[:, list(arm.moving)])  # the still direction turns there
    other = np.linalg.svd(_others(arm, at._replace(still=along), aim))[2][:, -2]
    part = np.stack([parts.a.q, parts.b.q], axis=1)
    return Crossings(parts.owner, ends.q.swapaxes(0, 1), part, moved_rows(arm, at.q, aside(other)))


def _keeps(arm: Arm, at: Reduced, T: Array) -> Flags:
    return keeps_sense(_others(arm, at, T), at.still, at.out)


def _others(arm: Arm, at: Reduced, T: Array) -> Array:
    _, slope = linearized(arm, at.q, T)
    return flow_and_others(slope, at.still)[1]
