"""What Newton steps from the closed form's rows lead to near singularities, where solutions meet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.arm.solved_arm import Arm, Found
from ikgen.runtime.python.arrays.array_tuples import joined, some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index, Row
from ikgen.runtime.python.newton.arm_newton import linearized, refined
from ikgen.runtime.python.newton.refinement import least_singular
from ikgen.runtime.python.rows.row_links import differences, neighbouring_rows
from ikgen.runtime.python.rows.row_placement import distinct, same_rows
from ikgen.runtime.python.rows.solution_rows import pairs_within, places
from ikgen.runtime.python.singular.curve_parts import look_between
from ikgen.runtime.python.singular.curve_samples import SOLVED, samples_beside
from ikgen.runtime.python.singular.fold_pair import approach

__all__ = [
    "Ends",
    "Leads",
    "Led",
    "Starts",
    "both",
    "ends_of",
    "leads_of",
    "repeats",
    "rows_nearby",
    "that_differ",
]

_SKEW = 2.0  # of the way to the other solution of two: farther there may be more
_BESIDE = 0.1  # rad or m: farther apart closed forms have them all
_CONTINUUM = (
    1e-10  # smallest singular value that what takes a pose to 1e-9 all along leaves at most
)


class Starts(NamedTuple):
    """Where Newton steps start: rows `q` (k, dof) towards aims `T` (k, ...), which rows are of the same
    pose, `pose` (k,), which the closed form `marked` (k,) as of a continuum, and the `source` (k,) of each:
    given (-1), the closed form for the pose (0), or for one beside (1, 2, ...), on branch `lane` (k,)."""

    q: Array
    T: Array
    pose: Index
    marked: Flags
    source: NDArray[np.int64]
    lane: Index


class Ends(NamedTuple):
    """Where Newton steps end: rows `q` (k, dof), their `error` and the smallest singular value `sigma` of
    the derivatives (k,)."""

    q: Array
    error: Array
    sigma: Array


class Led(NamedTuple):
    """Solutions `q` (n, dof), the starts `owner` (n,) that led to them, and the smallest singular values
    `sigma` (n,) there."""

    owner: Index
    q: Array
    sigma: Array


class Leads(NamedTuple):
    """Starts and their ends, with an infinite error where a start stands for a continuum of the solved
    geometry, what is found `around` that, and of which starts (k,) that is `known`."""

    starts: Starts
    ends: Ends
    around: Led
    known: Flags


def both(one: Leads, other: Leads) -> Leads:
    """What two found, one after the other."""
    owner = other.around.owner + len(one.starts.q)
    out: Leads = joined(one, other._replace(around=other.around._replace(owner=owner)))
    return out


def ends_of(arm: Arm, q: Array, T: Array) -> Ends:
    """Where steps from rows q (k, dof) towards aims T end."""
    q, error, _, slope = refined(arm, q, T)
    return Ends(q, error, least_singular(slope))


def leads_of(arm: Arm, starts: Starts, known: Flags, near: bool = False) -> Leads:
    """What starts lead to. A continuum that the closed form has, where it marked a row, is followed all
    around where the file's arm may not have it, once for each branch of a pose; `known` (poses, branches):
    which were, and are then. Starts on none are no longer marked. With `near`, continua that the pose's own
    rows may lie on near singularities are followed as well."""
    broken = starts.marked & (starts.source >= 0)
    if not arm.rounded and broken.any():
        led = ends_of(arm, starts.q[broken], starts.T[broken])
        lost = (led.error >= arm.policy.exact) | _collapsed(arm, some_of(starts, broken), led)
        broken[broken] = lost
    nowhere = np.full(len(starts.q), np.inf)
    ends = Ends(starts.q.copy(), nowhere, nowhere.copy())
    _run(arm, starts, ends, ~broken)
    own, at = starts.source == 0, (starts.pose, starts.lane)
    lie = own & ~starts.marked & near
    lie &= ends.sigma < min(arm.policy.broken_reach, arm.policy.fold_reach)
    one, on = _found_around(arm, starts, ends, (broken & own & ~known[at]) | lie, lie)
    known[starts.pose[on & ~lie], starts.lane[on & ~lie]] = True
    other, also = _found_around(arm, starts, ends, broken & ~own & ~known[at], lie)
    known[starts.pose[also], starts.lane[also]] = True
    around = broken & known[at]
    _run(arm, starts, ends, broken & ~around)
    starts = starts._replace(marked=starts.marked & (around | ~broken))
    return Leads(starts, ends, joined(one, other), around | (on & lie))


def _collapsed(arm: Arm, starts: Starts, led: Ends) -> Flags:
    """To which of the ends (k,) of marked starts another of their pose has come too from aside, which is
    alone there: the direction that they began with is lost, and the solution that one of them was near may
    lie far away."""
    pose, way = starts.pose, np.abs(differences(arm, starts.q, led.q)).max(axis=1)
    a, b = pairs_within(pose)
    alone = (led.error < arm.policy.arrived) & (led.sigma > _CONTINUUM)
    some = alone[a] & alone[b]
    a, b = a[some], b[some]
    same = neighbouring_rows(arm, led.q[a], led.q[b])
    same &= np.maximum(way[a], way[b]) > arm.policy.neighbouring  # not where two branches meet
    out = np.zeros(len(pose), dtype=bool)
    out[a[same]] = out[b[same]] = True
    return out


def _run(arm: Arm, starts: Starts, ends: Ends, some: Flags) -> None:
    """Enters where steps from some of the starts end."""
    for whole, part in zip(ends, ends_of(arm, starts.q[some], starts.T[some])):
        whole[some] = part


def _found_around(
    arm: Arm, starts: Starts, ends: Ends, some: Flags, lie: Flags
) -> tuple[Led, Flags]:
    """The solutions around continua that some starts (k,) stand for, or that rows `lie` (k,) on which they
    lead to, once for each branch of a pose; which starts these are from. Where a branch's first start is on
    none, its others are tried."""
    left, on = np.flatnonzero(some), np.zeros(len(some), dtype=bool)
    found = Led(left[:0], starts.q[:0], ends.sigma[:0])
    branch = starts.pose * (1 + starts.lane.max(initial=0)) + starts.lane
    for others in (False, True):
        if arm.around is None or not len(left):
            break
        index = left if others else _first_of(branch, left)
        q = np.where(lie[index, None], ends.q[index], starts.q[index])
        curve, owner, rows, sigma = arm.around(arm, q, starts.T[index], lie[index])
        on[_first_of(branch, index[curve])] = True
        found = joined(found, Led(index[owner], rows, sigma))
        left = np.setdiff1d(left[~np.isin(branch[left], branch[on])], index)
    return found, on


def _first_of(branch: Index, some: Index) -> Index:
    """The first start of each `branch` (k,) among some, in order."""
    return np.sort(some[np.unique(branch[some], return_index=True)[1]])


def rows_nearby(arm: Arm, leads: Leads) -> Led:
    """The solutions that starts lead to, those that are sure first. Where two may meet near a singularity
    both are found. What is given leads only to its own."""
    starts, T, (q, error, sigma) = leads.starts, leads.starts.T, (x.copy() for x in leads.ends)
    near = (starts.source >= 0) & ~starts.marked & (sigma < arm.policy.fold_reach)
    settled = error < np.where(near, arm.policy.converged, arm.policy.arrived)
    fresh = _fresh(arm, q, starts, near, near & ~settled)
    settled &= fresh
    near &= fresh & ~leads.known
    sure = np.flatnonzero(settled)
    first = _in_order(Led(sure, q[sure], sigma[sure]), leads.around)
    if not near.any():
        return first
    owner, pairs = _approached(arm, q, T, np.flatnonzero(near), error < arm.policy.arrived)
    pairs, left, there = ends_of(arm, pairs, T[owner])
    exact = left < arm.policy.exact
    for k, i in zip(np.flatnonzero(~exact).tolist(), owner[~exact].tolist()):
        if left[k] < error[i]:
            q[i], error[i], sigma[i] = pairs[k], left[k], there[k]
    alone = np.flatnonzero(near & (error < arm.policy.arrived))
    alone = np.setdiff1d(alone, [*owner[exact], *sure])
    more = _in_order(
        Led(owner[exact], pairs[exact], there[exact]), Led(alone, q[alone], sigma[alone])
    )
    found: Led = joined(first, more)
    return found


def _approached(arm: Arm, q: Array, T: Array, near: Index, right: Flags) -> tuple[Index, Array]:
    """Where approaches to both sides of some rows of q (k, dof) end (n, dof), and whose these are (n,).
    Where one from a solution, `right` (k,), goes much farther than the second order says, also what it may
    have passed."""
    owner = np.repeat(near, 2)
    start = q[owner]
    ends, lead = approach(arm, start, T[owner], np.tile([1.0, -1.0], len(near)))
    way = np.abs(differences(arm, start, ends)).max(axis=1)
    far = right[owner] & (way < _BESIDE) & (way > _SKEW * lead + arm.policy.coincident)
    if not far.any():
        return owner, ends
    whose, passed = look_between(arm, start[far], ends[far], T[owner[far]])
    return np.append(owner, owner[far][whose]), np.concatenate([ends, passed])


def _in_order(one: Led, other: Led) -> Led:
    found = joined(one, other)
    order = np.argsort(found.owner, kind="stable")
    return Led(*(x[order] for x in found))


def _fresh(arm: Arm, q: Array, starts: Starts, near: Flags, stalled: Flags) -> Flags:
    """Which rows (k, dof) are not of a pose beside, and led to the same as an earlier one of their pose or
    stalled by one that is near another solution."""
    if not len(arm.beside):
        return np.ones(len(q), dtype=bool)
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
        fresh[k] = not neighbouring_rows(arm, others, q[k]).any()
    return fresh


def repeats(arm: Arm, aim: Array, row: Row, kept: Sequence[Found]) -> bool:
    """Whether nothing tells a singular row towards an aim from one kept nearby."""
    others = [other for other, singular in kept if singular]
    if not others:
        return False
    rows = np.broadcast_to(np.array(row), (len(others), len(row)))
    return bool(
        _untold(arm, np.broadcast_to(aim, (len(others), *aim.shape)), rows, np.array(others)).any()
    )


def _untold(arm: Arm, T: Array, a: Array, b: Array) -> Flags:
    """Which singular rows a (k, dof) towards aims T (k, ...) nothing tells from others nearby, b (k, dof):
    the pose is theirs between them too, on the straight way or on a curve beside that."""
    near, out = neighbouring_rows(arm, a, b), np.zeros(len(a), dtype=bool)
    if not near.any():
        return out
    a, T = a[near], T[near]
    middle = a + 0.5 * differences(arm, a, b[near])
    off = np.abs(linearized(arm, middle, T)[0]).max(axis=1)
    untold: Flags = off < arm.policy.halfway
    some = np.flatnonzero(~untold & (off < arm.policy.arrived))
    if len(some):
        untold[some] = np.abs(samples_beside(arm, middle[some], T[some]).left) < SOLVED
    out[near] = untold
    return out


def that_differ(arm: Arm, T: Array, pose: Index, q: Array, singular: Flags) -> Index:
    """Which rows q (k, dof) towards aims T[pose] (k, ...) differ from all that are taken before them, in
    order: those of a pose that the first of them is not, and of these again."""
    left, taken = np.arange(len(q)), [np.zeros(0, dtype=np.intp)]
    while len(left):
        _, first, whose = np.unique(pose[left], return_index=True, return_inverse=True)
        taken.append(left[first])
        left, first = np.delete(left, first), left[first][np.delete(whose, first)]
        new = ~same_rows(arm, q[left], q[first])
        flat = np.flatnonzero(new & singular[left] & singular[first])
        new[flat] = ~_untold(arm, T[pose[left[flat]]], q[left[flat]], q[first[flat]])
        left = left[new]
    return np.sort(np.concatenate(taken))
