"""Where a branch ends, or leaves the limits, between two values of the held joint."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite

import numpy as np

from ikgen.runtime.python.arm.limit_margins import outside
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.held.branch_arcs import Arcs
from ikgen.runtime.python.held.branch_tracks import Tracks
from ikgen.runtime.python.held.held_joint import HeldJoint, rows_at
from ikgen.runtime.python.rows.row_links import differences

__all__ = ["BranchEnd", "branch_end", "find_ends"]

_ENOUGH = 1e-10  # rad or m that an end is known to
_FOUND = 1.01e-10  # rad or m from inside to outside of an end that was looked for
_STEPS = 60
_HALVE = 6  # one step in so many halves, whatever is expected
_KNOWN = 4  # values by which an end is expected
_REACH = 1.0  # rad or m that a row may be from where its branch was last seen
_Known = tuple[float, float]


@dataclass
class BranchEnd:
    """A value of the held joint at which the row `lane`, `q`, is inside, and one at which it is not.

    `known`: values of the held joint near by, each with what is negative inside, positive outside and
    smooth between, the nearest last. `stays`: in its lane, however near others come; `reach`: rad or m
    that the row may be from where it was last seen, any where its lane ends: beside folds rows move as far
    as they like. `there`: where margins do not tell, the branch's row at the value `then` beyond, or before
    a fold the one that it meets; None where there is none."""

    inner: float
    outer: float
    q: Array
    lane: int
    known: list[_Known]
    at_fold: bool
    stays: bool
    there: Array | None = None
    then: float = 0.0
    reach: float = _REACH

    @property
    def surely(self) -> float:
        """A value beyond which the row is not, the last at which it is where that was looked for."""
        return self.inner if abs(self.outer - self.inner) <= _FOUND else self.outer


def branch_end(
    joint: HeldJoint,
    tracks: Tracks,
    before: Index,
    inside: tuple[int, int],
    beyond: tuple[int, int],
) -> BranchEnd:
    """Between a sample (index, row) inside and the next one, whose row is outside the limits, or which
    has none (-1). `before`: the rows that go on as each."""
    rows = tracks.rows
    (at, row), (to, other) = inside, beyond
    at_fold, known = other < 0, list[_Known]()
    stays = joint.guarded if at_fold else joint.margins_tell and other == row
    reach = inf if at_fold and joint.margins_tell and not rows.real[to, row] else _REACH
    there, then = None, to
    if joint.margins_tell:
        known = _known(tracks, before, inside, beyond)
    elif at_fold:
        other, then = _met(joint.arm, tracks, before, inside, to), at
    if not joint.margins_tell and other >= 0:
        there = rows.q[then, other]
    a, b, c = (float(rows.held[k]) for k in (at, to, then))
    return BranchEnd(a, b, rows.q[at, row], row, known, at_fold, stays, there, c, reach)


def _known(
    tracks: Tracks, before: Index, inside: tuple[int, int], beyond: tuple[int, int]
) -> list[_Known]:
    """What the samples around an end tell of it."""
    rows, off = tracks.rows, tracks.off
    (at, row), (to, other) = inside, beyond
    behind = _followed(tracks, before, at, row, 2 * at - to)
    ahead = _followed(tracks, before, to, other, 2 * to - at)
    samples = (ahead, behind, beyond, inside)
    if other < 0:
        near = [k for k, _ in samples if 0 <= k < len(rows.held)]
        known = [(k, -float(rows.folds[k, row].min(initial=inf))) for k in near]
    else:
        known = [(k, float(off[k, r])) for k, r in samples if r >= 0]
    return [(float(rows.held[k]), value) for k, value in known if isfinite(value)]


def _followed(tracks: Tracks, before: Index, at: int, row: int, to: int) -> tuple[int, int]:
    """The sample `to` beside `at`, and the row there that is the same branch's; -1 without one."""
    if row < 0 or not 0 <= to < len(tracks.rows.held):
        return to, -1
    return to, int(tracks.links[at, row] if to > at else before[to, row])


def _met(arm: Arm, tracks: Tracks, before: Index, inside: tuple[int, int], to: int) -> int:
    """The nearest of the rows that end beside a row (index, row) towards sample `to`, or of all rows of a
    rounded arm, where it may be found farther; -1 without one."""
    at, row = inside
    rows, links = tracks.rows, tracks.links[at] if to > at else before[to]
    gap = np.abs(differences(arm, rows.q[at, row], rows.q[at])).max(axis=1)
    gap = np.where(rows.real[at] & (arm.rounded | (links < 0)), gap, inf)
    gap[row] = inf
    nearest = int(gap.argmin())
    return nearest if gap[nearest] < inf else -1


def find_ends(joint: HeldJoint, T: Array, ends: list[BranchEnd], limits: bool) -> None:
    """Along the curve to the row beyond, or to the one that is met; where margins tell, or there is none,
    by inverse interpolation (Brent 1973, section 4.2, of up to four values), and by halving where that
    leads out of the bracket or is slow."""
    follow_ends(joint, T, [e for e in ends if e.there is not None], limits)
    for step in range(_STEPS):
        going = [e for e in ends if abs(e.outer - e.inner) > _ENOUGH]
        if not going:
            return
        held = np.array([_trial(e, step) for e in going])
        rows = rows_at(joint, T, held)
        off = outside(joint.arm, rows.q, limits)
        last = np.array([e.q for e in going])
        gap = np.abs(differences(joint.arm, last[:, None], rows.q)).max(axis=2)
        gap = np.where(rows.real, gap, inf)
        for k, e in enumerate(going):
            row = e.lane if e.stays else int(gap[k].argmin())
            seen = bool(gap[k, row] < e.reach)
            here = float(off[k, row]) - joint.arm.policy.limit_tolerance
            value = here if seen else None
            if e.at_fold:
                least = -float(rows.folds[k, row if seen else e.lane].min(initial=inf))
                value = least if joint.margins_tell else None
            _narrow(e, float(held[k]), seen, here, value)
            if seen and here <= 0.0:
                e.q, e.lane = rows.q[k, row], row


def follow_ends(joint: HeldJoint, T: Array, ends: list[BranchEnd], limits: bool) -> None:
    """Takes those that are found along the curves to other rows, in their brackets; of a rounded arm, whose
    rows may be missed beside a fold, also as far again beyond."""
    if not ends:
        return
    inner, outer, then = (
        np.array([getattr(e, x) for e in ends]) for x in ("inner", "outer", "then")
    )
    q, there = np.array([e.q for e in ends]), np.array([e.there for e in ends])
    arcs = Arcs(joint.arm, T, limits, q, inner, there, then)
    sense, at_fold = np.sign(outer - inner), np.array([e.at_fold for e in ends])
    end, good = arcs.end, np.ones(len(ends), dtype=bool)
    if at_fold.any():
        fold, found = arcs.folds(sense)
        end = fold.where(at_fold, end)
        beyond = np.abs(outer - inner) if joint.arm.rounded else _ENOUGH
        good = ~at_fold | (found & (sense * (outer - fold.held) > -beyond))
    leaves = end.off > 0.0
    if leaves.any():
        last, found = arcs.limits(arcs.start, end)
        at_fold &= ~leaves
        end, good = last.where(leaves, end), good & (~leaves | found)
    for k in np.flatnonzero(good).tolist():
        ends[k].inner, ends[k].q = float(end.held[k]), end.q[k]
        ends[k].at_fold = bool(at_fold[k])
        ends[k].outer = ends[k].inner + float(sense[k]) * _ENOUGH


def _trial(end: BranchEnd, step: int) -> float:
    """Where to look next."""
    width = end.outer - end.inner
    share = 0.5
    if step % _HALVE != _HALVE - 1:
        for first in range(max(len(end.known) - _KNOWN, 0), len(end.known) - 1):
            guess = _interpolated(end.known[first:])
            if 0.0 < (guess - end.inner) / width < 1.0:
                share = (guess - end.inner) / width
                break
    least = 0.4 * _ENOUGH / abs(width)
    return end.inner + min(max(share, least), 1.0 - least) * width


def _interpolated(known: list[_Known]) -> float:
    """The value of the held joint at which the polynomial through all is 0 (Neville)."""
    at = [x for x, _ in known]
    f = [y for _, y in known]
    for level in range(1, len(at)):
        for k in range(len(at) - level):
            gap = f[k + level] - f[k]
            if gap == 0.0:
                return inf
            at[k] = (at[k] * f[k + level] - at[k + 1] * f[k]) / gap
    return at[0]


def _narrow(end: BranchEnd, held: float, seen: bool, off: float, value: float | None) -> None:
    """Takes what was found at a value between: whether there is a row of the branch, how far that is
    outside the limits, and what is to be 0."""
    good = seen and off <= 0.0
    far = end.outer if good else end.inner
    if good:
        end.inner = held
    else:
        end.outer = held
    if end.at_fold and seen and not good:  # a limit comes before the fold
        end.at_fold = False
        end.known = []
        value = off
    if value is None or not isfinite(value):
        return
    rest = [one for one in end.known if one[0] != far]  # the other side of the bracket goes last
    kept = [one for one in end.known if one[0] == far]
    end.known = [*rest, (held, value), *kept][-_KNOWN:]
