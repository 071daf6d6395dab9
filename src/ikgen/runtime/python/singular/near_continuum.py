"""Solutions on what is a continuum of the geometry that was solved, and none of the file's.

Along it the other joints take the pose's error away but for one direction (Lyapunov and Schmidt's
reduction; Golubitsky & Schaeffer 1985, I.3): a solution is where what is left changes its sign, or
touches 0."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import joined, some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.newton.arm_newton import refined
from ikgen.runtime.python.newton.refinement import least_singular
from ikgen.runtime.python.rows.row_links import differences
from ikgen.runtime.python.rows.solution_rows import places
from ikgen.runtime.python.singular.curve_crossings import Crossings, crossings_of
from ikgen.runtime.python.singular.curve_parts import Parts, between, look, look_between
from ikgen.runtime.python.singular.curve_samples import samples_beside
from ikgen.runtime.python.singular.curve_walks import BESIDE, Walked, reached, walked

__all__ = ["LEAST", "Traced", "followed", "on_curves", "rows_around", "trace"]

LEAST = 4
"""Samples of what is a curve."""
_OVER = 0.05  # of a part
_FINE = 8  # parts of one in which what is left turns


class Traced(NamedTuple):
    """Which starts (k,) lie on a `curve` of the solved geometry, and which of these are `broken` (k,), none
    of the file's arm; the starts `owner` (n,) of solutions, nearly, `q` (n, dof) on broken ones."""

    curve: Flags
    broken: Flags
    owner: Index
    q: Array


def rows_around(arm: Arm, q: Array, T: Array, broken: Flags) -> tuple[Flags, Index, Array, Array]:
    """Which rows q (k, dof) towards aims T (k, ...) stand for a continuum of the solved geometry; from
    which (n,) the solutions (n, dof) all around are, or one where the file's arm has the continuum too, or
    those on others that cross what is too short for one, and the smallest singular values (n,) there.
    `broken` (k,): from which only of such that the file's arm has not, and no others than those that are
    right to round-off."""
    with np.errstate(all="ignore"):
        traced = trace(arm, q, T)
    given = np.flatnonzero(traced.curve & ~broken)
    owner = np.concatenate([traced.owner, given])
    rows, error, _, slope = refined(arm, np.concatenate([traced.q, q[given]]), T[owner])
    exact = error < arm.policy.exact
    best = np.lexsort((error, owner))
    best = best[places(owner[best]) == 0]
    best = best[~np.isin(owner[best], owner[exact]) & (error[best] < arm.policy.arrived)]
    best = best[traced.curve[owner[best]] & ~broken[owner[best]]]
    some = np.concatenate([np.flatnonzero(exact), best])
    some = some[np.argsort(owner[some], kind="stable")]
    curve = np.where(broken, traced.broken, traced.curve)
    return curve, owner[some], rows[some], least_singular(slope[some])


def trace(arm: Arm, q: Array, T: Array) -> Traced:
    """The curves through rows q (k, dof) towards aims T (k, ...), once around, or to both their ends, and
    others that cross those that the file's arm has not; of rows on the same curve one is followed."""
    asked = np.concatenate([q, T.reshape(len(q), -1)], axis=1)
    _, first, again = np.unique(asked, axis=0, return_index=True, return_inverse=True)
    again = again.reshape(-1)
    same, curve, broken, owner, rows = _traced(arm, q[first], T[first])
    again = same[again]
    whose, member = _members(owner, again)
    return Traced(curve[again], broken[again], whose, rows[member])


def _members(group: Index, asked: Index) -> tuple[Index, Index]:
    """Which in `group` (k,), in order, are of those asked for (n,), and of which."""
    begin, end = np.searchsorted(group, asked), np.searchsorted(group, asked, side="right")
    whose = np.repeat(np.arange(len(asked)), end - begin)
    return whose, begin[whose] + places(whose)


def _traced(arm: Arm, q: Array, T: Array) -> tuple[Index, Flags, Flags, Index, Array]:
    """`trace` of rows that differ, behind the first row (k,) on the curve of each."""
    curves = followed(arm, q, T)
    steps, broken = curves.steps, _broken(arm, curves)
    here, last = (some_of(some, broken[some.owner]) for some in curves[:2])
    crossed = some_of(curves.parts, (broken | (steps < LEAST))[curves.parts.owner])
    crossings = crossings_of(arm, crossed, T)
    parts: Parts = joined(here, last, _crossing_parts(arm, crossed, crossings, T))
    owner, found = look(arm, parts, T, steps)
    # where curves only come near each other, what is left turns to the other sense within a part
    near = np.flatnonzero(broken[crossings.owner])
    begin, end = crossings.part[near].swapaxes(0, 1)
    k, between_them = look_between(arm, begin, end, T[crossings.owner[near]], _FINE)
    owner = np.concatenate([owner, crossings.owner[near[k]]])
    found = np.concatenate([found, between_them])
    # beside a crossing samples go astray to the other curve: steps begin there, wherever those led
    owner = np.concatenate([owner, np.repeat(crossings.owner, 2)])
    found = np.concatenate([found, crossings.near.reshape(-1, q.shape[1])])
    order = np.argsort(owner, kind="stable")
    return curves.same, steps >= LEAST, broken, owner[order], found[order]


def _broken(arm: Arm, curves: Walked) -> Flags:
    """Which are curves of the solved geometry that the file's arm has not (k,)."""
    curve = curves.steps >= LEAST
    return curve & (curves.worst >= arm.policy.arrived)


def _crossing_parts(arm: Arm, parts: Parts, crossings: Crossings, T: Array) -> Parts:
    """The parts of broken curves that cross curves of some parts."""
    owner, q = crossings.owner, crossings.beside
    none: Parts = some_of(parts, owner[:0])
    if not len(owner):
        return none
    first = samples_beside(arm, q, T[owner])
    fresh = ~on_curves(arm, parts, owner, first.q, T)
    first, owner = some_of(first, fresh), owner[fresh]
    if not len(owner):
        return none
    curves = walked(arm, first, T[owner], owner)
    broken = _broken(arm, curves)
    out: Parts = joined(*(some_of(some, broken[some.owner]) for some in curves[:2]))
    return out._replace(owner=owner[out.owner])


def followed(arm: Arm, q: Array, T: Array) -> Walked:
    """The curves beside rows q (k, dof) towards aims T (k, ...)."""
    asked = np.concatenate([T.reshape(len(T), -1), q[:, list(arm.free)]], axis=1)
    _, pose = np.unique(asked, axis=0, return_inverse=True)
    return walked(arm, samples_beside(arm, q, T), T, pose.reshape(-1))


def on_curves(arm: Arm, parts: Parts, owner: Index, q: Array, T: Array) -> Flags:
    """Which rows q (n, dof) lie on the curves of their starts `owner` (n,), towards aims T (k, ...)."""
    out, moving = np.zeros(len(q), dtype=bool), list(arm.moving)
    order = np.argsort(parts.owner, kind="stable")
    row, part = _members(parts.owner[order], owner)
    part = order[part]
    chord = (parts.b.q - parts.a.q)[part][:, moving]
    way = differences(arm, parts.a.q[part], q[row])[:, moving]
    share = (way * chord).sum(axis=1) / (chord**2).sum(axis=1)
    near = np.abs(way - share[:, None] * chord).max(axis=1) < BESIDE
    near &= (share > -_OVER) & (share < 1.0 + _OVER)
    row, parts = row[near], some_of(parts, part[near])
    on, _ = reached(arm, between(arm, parts, share[near], T), q[row], T[parts.owner])
    out[row[on]] = True
    return out
