"""Walks along curves, from all their starts to both sides at once, until two on the same curve meet.

On a curve the other joints take the pose's error away but for one direction (as in `near_continuum`)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import joined, some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.rows.row_links import differences
from ikgen.runtime.python.rows.solution_rows import pairs_within
from ikgen.runtime.python.singular.curve_parts import BEYOND, Parts
from ikgen.runtime.python.singular.curve_samples import sampled
from ikgen.runtime.python.singular.fold_pair import Reduced, unit

__all__ = ["BESIDE", "Walked", "reached", "walked"]

_MOST = 96  # samples to a side of a curve
_ASTRAY = 4  # samples in a row that show that no curve is near
BESIDE = 0.06
"""Rad or m that a curve is off a chord of it at most."""
_SAME_WAY = 0.9
_FACING = 0.7  # cosine of the turn between two samples that meet
_MEETING = 1.1  # steps between them
_SETTLED = 4  # steps behind which a walk is on its curve, if it began beside that
_ON = 1e-6  # rad or m off a curve
_ROUNDS = 3


class Walked(NamedTuple):
    """The `parts` of curves that were passed, and the `ends` behind which too much is left, both under the
    first start of a curve; of the curve of each start (k,) which that is, `same`, the most that is left,
    `worst`, and how many parts end near a curve, `steps`."""

    parts: Parts
    ends: Parts
    same: Index
    worst: Array
    steps: Index


class _Meetings(NamedTuple):
    """Pairs of samples on one curve, by their numbers `one` and `other` (n,); what comes of the one when it
    goes to the other, `there` (n,), and how far `ahead` that is (n,)."""

    one: Index
    other: Index
    there: Reduced
    ahead: Array


def walked(arm: Arm, first: Reduced, T: Array, group: Index) -> Walked:
    """On from samples towards aims T (k, ...) to both sides at once, the fastest joint by
    `policy.try_step` from one to the next, until two of a `group` (k,) meet on a curve, or one comes back
    to where it was."""
    walks = _Walks(arm, first, T, group)
    parts, known, ends, owner, T = [], [], [], walks.begun, walks.T
    b = some_of(walks.origin, owner)
    astray, before = np.zeros(len(owner), dtype=np.intp), b.still
    for step in range(_MOST):
        c, near, sure = sampled(arm, b._replace(q=_ahead(arm, b, before)), T[owner])
        astray = np.where(near, 0, astray + 1)
        left = np.abs(c.left)
        on = left < arm.policy.fold_reach
        place = ((_MOST + 2) * owner + step).astype(float)
        passed = Parts(b, c, owner, place, np.ones(len(owner)))
        ends.append(some_of(passed, ~on & (left < BEYOND * arm.policy.fold_reach)))
        on &= astray < _ASTRAY
        passed, astray = some_of(passed, on), astray[on]
        going, bridges = walks.went_on(passed, (near & sure)[on], step)
        parts += [passed, bridges]
        known += [near[on], np.ones(len(bridges.owner), dtype=bool)]
        before = passed.a.still[going]
        b, owner, astray = some_of(passed.b, going), passed.owner[going], astray[going]
        if not len(owner):
            break
    walks.closed[owner] = True
    return walks.of_curves(joined(*parts), joined(*ends), np.concatenate(known))


class _Walks:
    """From `origin` samples (2 k,) towards aims `T`, to one side and the other of all starts (k,); the
    numbers of those that have `begun`: of starts near each other on one curve the first alone. `closed`
    (2 k,): which are back where they began."""

    def __init__(self, arm: Arm, first: Reduced, T: Array, group: Index) -> None:
        self._arm, self._count = arm, len(T)
        near = _meetings(arm, first, T, group, False)
        self._same = _united(np.arange(len(T)), near.one, near.other)
        back = first._replace(still=-first.still, out=-first.out, left=-first.left)
        self.origin: Reduced = joined(first, back)
        self._settled = self.origin
        self.T, self._group = np.concatenate([T, T]), np.concatenate([group, group])
        self.begun = np.flatnonzero(np.tile(self._same == np.arange(len(T)), 2))
        self.closed, self._worst = np.zeros(2 * len(T), dtype=bool), np.abs(self.origin.left)

    def went_on(self, passed: Parts, sure: Flags, step: int) -> tuple[Flags, Parts]:
        """Which walks (n,) go on behind the last parts (n,), and the parts between those that meet there;
        `sure` (n,): which are on a curve."""
        arm, owner, count, c = self._arm, passed.owner, self._count, passed.b
        self._worst[owner] = np.maximum(self._worst[owner], np.where(sure, np.abs(c.left), 0.0))
        if step == _SETTLED:
            self._settled = Reduced(*(x.copy() for x in self.origin))
            for whole, part in zip(self._settled, c):
                whole[owner] = part
        if step > 1:
            self.closed[owner[_back(arm, some_of(self.origin, owner), passed.a)]] = True
        group = np.where(sure, self._group[owner], -1 - owner)
        met = _meetings(arm, c, self.T[owner], group, True)
        self._same = _united(self._same, owner[met.one] % count, owner[met.other] % count)
        going = ~(self.closed[owner] | self.closed[owner % count])
        going[met.one] = going[met.other] = False
        if step > _SETTLED + 1:
            going &= ~_back(arm, some_of(self._settled, owner), c)
        return going, _bridges(passed, met)

    def of_curves(self, parts: Parts, ends: Parts, near: Flags) -> Walked:
        """What was passed to either side, to the other only where the one did not come back. `near` (n,):
        which parts end near a curve."""
        same, once = self._same, np.ones(2 * self._count, dtype=bool)
        once[self._count :] = ~self.closed[: self._count]
        worst = np.zeros(self._count)
        np.maximum.at(worst, np.tile(same, 2)[once], np.nan_to_num(self._worst[once]))
        near = near[once[parts.owner]]
        parts, ends = (some_of(some, once[some.owner]) for some in (parts, ends))
        parts, ends = (
            some._replace(owner=same[some.owner % self._count]) for some in (parts, ends)
        )
        steps = np.bincount(parts.owner[near], minlength=self._count)
        return Walked(parts, ends, same, worst[same], steps[same])


def _ahead(arm: Arm, b: Reduced, before: Array) -> Array:
    """Rows (n, dof) a step on from samples, as the curve turned from the directions `before` (n, k)."""
    course = 1.5 * b.still - 0.5 * before
    q: Array = b.q.copy()
    q[:, list(arm.moving)] += arm.policy.try_step * course / np.abs(course).max(axis=1)[:, None]
    return q


def _meetings(arm: Arm, at: Reduced, T: Array, group: Index, facing: bool) -> _Meetings:
    """Which samples of a `group` (n,) are by a step from each other on one curve, if `facing` in each
    other's way."""
    one, other = pairs_within(group)
    gap = np.abs(differences(arm, at.q[one], at.q[other])[:, list(arm.moving)]).max(axis=1)
    close = gap < _MEETING * arm.policy.try_step
    one, other = one[close], other[close]
    a, b = some_of(at, one), some_of(at, other)
    turn = (a.still * b.still).sum(axis=1)
    sense = np.where(turn < 0.0, -1.0, 1.0)
    mean, _ = unit(a.still + sense[:, None] * b.still)
    a = a._replace(still=mean)
    _, ahead, beside = _way(arm, a, b.q)
    near = (beside < BESIDE) & ((-turn if facing else np.abs(turn)) > _FACING)
    a, one, other, ahead = some_of(a, near), one[near], other[near], ahead[near]
    if len(one):
        on, a = reached(arm, a, at.q[other], T[one])
        a, one, other, ahead = some_of(a, on), one[on], other[on], ahead[on]
    if len(one):
        there = at.q[one] + differences(arm, at.q[one], at.q[other])  # not whole turns from there
        a = sampled(arm, a._replace(q=there), T[one])[0]
    return _Meetings(one, other, a, ahead)


def _bridges(passed: Parts, met: _Meetings) -> Parts:
    """The parts between samples that meet, if they have not passed each other."""
    some = met.ahead > 0.0
    last: Parts = some_of(passed, met.one[some])
    return last._replace(a=last.b, b=some_of(met.there, some), place=last.place + 1.0)


def _united(same: Index, one: Index, other: Index) -> Index:
    """The first starts of curves (k,) where pairs of starts are on one each."""
    for a, b in zip(one.tolist(), other.tolist()):
        low, high = sorted((same[a], same[b]))
        same = np.where(same == high, low, same)
    return same


def _back(arm: Arm, a: Reduced, b: Reduced) -> Flags:
    """Whether curves are at samples of them again, and not at other parts that are near."""
    way, _, beside = _way(arm, a, b.q)
    near = np.abs(way).max(axis=1) < 0.75 * arm.policy.try_step
    same = (a.still * b.still).sum(axis=1) > _SAME_WAY
    return np.asarray((beside < BESIDE) & near & same)


def reached(arm: Arm, at: Reduced, q: Array, T: Array) -> tuple[Flags, Reduced]:
    """Which rows q (n, dof) lie on the curves of samples beside them, towards aims T (n, ...); the samples
    of these that are nearest."""
    out, going, moving = np.zeros(len(q), dtype=bool), np.arange(len(q)), list(arm.moving)
    for last in range(_ROUNDS):
        here = some_of(at, going)
        _, ahead, beside = _way(arm, here, q[going])
        out[going[beside < _ON]] = True
        on = (beside >= _ON) & (beside < ahead**2)
        going, here = going[on], some_of(here, on)
        if not len(going) or last == _ROUNDS - 1:
            break
        here.q[:, moving] += ahead[on, None] * here.still
        here = sampled(arm, here, T[going])[0]
        for whole, part in zip(at, here):
            whole[going] = part
    return out, at


def _way(arm: Arm, at: Reduced, q: Array) -> tuple[Array, Array, Array]:
    """The ways (k, n) from samples to rows q (k, dof), how far they go along the still direction (k,), and
    how far beside that at most (k,)."""
    way = differences(arm, at.q, q)[:, list(arm.moving)]
    along = (way * at.still).sum(axis=1)
    return way, along, np.abs(way - along[:, None] * at.still).max(axis=1)
