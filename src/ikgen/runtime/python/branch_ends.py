"""Where a branch ends, or leaves the limits, between two values of the held joint."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite

import numpy as np

from ikgen.runtime.python.array_types import Array, Index
from ikgen.runtime.python.branch_tracks import Tracks
from ikgen.runtime.python.held_joint import HeldJoint, Rows, rows_at
from ikgen.runtime.python.limit_margins import outside
from ikgen.runtime.python.row_links import differences
from ikgen.runtime.python.solved_arm import Arm

__all__ = ["BranchEnd", "branch_end", "find_ends"]

_ENOUGH = 1e-10  # of an end
_STEPS = 60
_HALVE = 6  # each such step, whatever is expected
_KNOWN = 4  # values by which an end is expected
_REACH = 1.0  # rad or m that a row may be from where its branch was last seen
_Known = tuple[float, float]


@dataclass
class BranchEnd:
    """A value of the held joint at which the row `lane`, `q`, is inside, and one at which it is not.

    `known`: values of the held joint near by, each with what is negative inside, positive outside and
    smooth between, the nearest last. `one_sided`: that is known inside alone; `guess`: where the end was
    expected before; `stays`: in its lane, however near others come."""

    inner: float
    outer: float
    q: Array
    lane: int
    known: list[_Known]
    at_fold: bool
    one_sided: bool
    guess: float
    stays: bool


def branch_end(
    joint: HeldJoint,
    tracks: Tracks,
    before: Index,
    inside: tuple[int, int],
    beyond: tuple[int, int],
) -> BranchEnd:
    """Between a sample (index, row) inside and the next one, whose row is outside the limits, or which
    has none (-1). `before`: the rows that go on as each."""
    rows, off = tracks.rows, tracks.off
    (at, row), (to, other) = inside, beyond
    at_fold = other < 0
    one_sided = at_fold and not joint.margins_tell
    behind = _followed(tracks, before, at, row, 2 * at - to)
    ahead = _followed(tracks, before, to, other, 2 * to - at)
    samples = (ahead, behind, beyond, inside)
    if one_sided:
        known = [(k, -_separation(joint.arm, rows, k, r)) for k, r in (behind, inside) if r >= 0]
    elif at_fold:
        last = len(rows.held) - 1
        near = [k for k, _ in samples if 0 <= k <= last]
        known = [(k, -float(rows.folds[k, row].min(initial=inf))) for k in near]
    else:
        known = [(k, float(off[k, r])) for k, r in samples if r >= 0]
    values = [(float(rows.held[k]), value) for k, value in known if isfinite(value)]
    a, b = float(rows.held[at]), float(rows.held[to])
    stays = joint.guarded if at_fold else joint.margins_tell and other == row
    return BranchEnd(a, b, rows.q[at, row], row, values, at_fold, one_sided, a, stays)


def _followed(tracks: Tracks, before: Index, at: int, row: int, to: int) -> tuple[int, int]:
    """The sample `to` beside `at`, and the row there that is the same branch's; -1 without one."""
    if row < 0 or not 0 <= to < len(tracks.rows.held):
        return to, -1
    return to, int(tracks.links[at, row] if to > at else before[to, row])


def _separation(arm: Arm, rows: Rows, at: int, row: int) -> float:
    """The squared distance of a row from the nearest other: linear in the held joint's value where the
    two meet."""
    gap = np.abs(differences(arm, rows.q[at, row], rows.q[at])).max(axis=1)
    gap = np.where(rows.real[at], gap, inf)
    gap[row] = inf
    return float(gap.min()) ** 2


def find_ends(joint: HeldJoint, T: Array, ends: list[BranchEnd], limits: bool) -> None:
    """By inverse interpolation (Brent 1973, section 4.2, of up to four values), and by halving where that
    leads out of the bracket or is slow."""
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
            seen = bool(gap[k, row] < _REACH)
            here = float(off[k, row]) - joint.arm.policy.limit_tolerance
            value = here if seen else None
            if e.one_sided:
                value = -_separation(joint.arm, rows, k, row) if seen else None
            elif e.at_fold:
                value = -float(rows.folds[k, row if seen else e.lane].min(initial=inf))
            _narrow(e, float(held[k]), seen, here, value)
            if seen and here <= 0.0:
                e.q, e.lane = rows.q[k, row], row


def _trial(end: BranchEnd, step: int) -> float:
    """Where to look next."""
    width = end.outer - end.inner
    share = 0.5
    if step % _HALVE != _HALVE - 1:
        for first in range(max(len(end.known) - _KNOWN, 0), len(end.known) - 1):
            guess = _interpolated(end.known[first:])
            if 0.0 < (guess - end.inner) / width < 1.0:
                share = _shifted(end, guess, step) if end.one_sided else (guess - end.inner) / width
                break
    least = 0.4 * _ENOUGH / abs(width)
    return end.inner + min(max(share, least), 1.0 - least) * width


def _shifted(end: BranchEnd, guess: float, step: int) -> float:
    """The share of the bracket to one side and the other of an end that is expected from inside alone, by
    how much that has changed."""
    width = end.outer - end.inner
    change = max(abs(guess - end.guess) / abs(width), 0.4 * _ENOUGH / abs(width))
    end.guess = guess
    share = (guess - end.inner) / width
    shift = min(change, 0.5 * share) if step % 2 else -min(change, 0.5 * (1.0 - share))
    return share - shift


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
        end.at_fold = end.one_sided = False
        end.known = []
        value = off
    if value is None or not isfinite(value):
        return
    rest = [one for one in end.known if one[0] != far]  # the other side of the bracket goes last
    kept = [one for one in end.known if one[0] == far]
    end.known = [*rest, (held, value), *kept][-_KNOWN:]
