"""All solutions of poses near singularities, and of those that leave joints free: of many poses at once, as
the price of Newton steps is that of the calls."""

from __future__ import annotations

from itertools import product

import numpy as np

from ikgen.runtime.python.arm.held_parameters import aims
from ikgen.runtime.python.arm.solved_arm import Arm, Found
from ikgen.runtime.python.arrays.array_tuples import joined, some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.newton.flat_steps import flat_steps
from ikgen.runtime.python.rows.row_placement import is_new, place_rows
from ikgen.runtime.python.singular.limit_curves import rows_along
from ikgen.runtime.python.singular.limit_rows import rows_inside
from ikgen.runtime.python.singular.meeting_rows import (
    Leads,
    Starts,
    both,
    leads_of,
    repeats,
    rows_nearby,
    that_differ,
)
from ikgen.runtime.python.singular.near_surface import on_surfaces
from ikgen.runtime.python.solving.asked_poses import Answer, Asked
from ikgen.runtime.python.solving.closed_form_rows import ClosedForm, closed_form, rows_beside
from ikgen.runtime.python.solving.projection import chord_costs, descended, nearest_rows

__all__ = ["placed_rows", "seeded_rows", "unplaced_rows"]


_Rows = tuple[list[Found], bool, bool]
"""Distinct solutions of a pose, whether it left a joint free, and the closed form led anywhere then."""


def placed_rows(arm: Arm, asked: Asked, limits: bool) -> list[Answer]:
    """Of each pose. Where it leaves a joint free and the given value leads nowhere, others are tried, and
    in the end the nearest pose's row; so too where limits leave none, but a continuum may go on inside, and
    where all that the closed form has is singular and leads to none."""
    out = [Answer() for _ in asked.T]
    left = np.arange(len(out))
    eliminated = arm.branches is None  # no joint has a value of its own then
    more = [] if eliminated else [range(1, arm.policy.tries)]
    for tries in (range(1), *more):
        if not len(left):
            break
        which = np.repeat(left, len(tries))
        some = asked.at(which)
        turn = np.tile(tries, len(left))
        start = some.starts(arm, turn * arm.policy.try_step)
        rows = _rows(arm, some, start, turn)
        seeded = _seeded(arm, some, start, rows, limits) if asked.near is not None else {}
        going = np.ones(len(out), dtype=bool)
        for k, i in enumerate(which.tolist()):
            if going[i]:
                going[i] = _goes_on(arm, some, k, rows[k], seeded.get(k, []), limits, out[i])
        left = left[going[left]]
    if not (arm.rounded or eliminated) and len(left):
        _take_hidden(arm, asked, left, limits, out)
    doubtful = set(left.tolist())
    doubtful |= {i for i, x in enumerate(out) if x.loose or (x.led and not x.real)}
    lost = sorted(i for i in doubtful if not out[i].rows)
    if lost:
        _take_nearest(arm, asked, np.array(lost), limits, out)
    lost = [i for i in lost if out[i].loose and not out[i].rows]
    if lost and arm.around is not None:
        _take_along(arm, asked, lost, limits, out)
    return out


def _take_along(arm: Arm, asked: Asked, some: list[int], limits: bool, out: list[Answer]) -> None:
    """Adds rows inside the limits of the continua that some of the poses' rows are of."""
    pose = np.array([i for i in some for _ in out[i].loose])
    aim = aims(arm, asked.T, asked.held)[pose]
    q = np.array([row for i in some for row, _ in out[i].loose])
    for k, row in zip(*rows_along(arm, q, aim)):
        i, found = pose[k], [(tuple(row.tolist()), True)]
        rows = rows_inside(arm, aim[k : k + 1], found, asked.seed(i), limits)
        _add(arm, asked.T[i], rows, out[i].rows)


def _take_hidden(arm: Arm, asked: Asked, some: Index, limits: bool, out: list[Answer]) -> None:
    """Adds rows that take some of the poses, next to rows of the closed form that take none behind a joint
    that it left free: where it left two and the pose leaves one, their values have to go together."""
    which, q = _hidden_rows(arm, asked, some)
    if not len(which):
        return
    rows = descended(arm, asked.T[which], q, limits)
    for i, found in zip(which.tolist(), _led_to_or_along(arm, asked.at(which), rows)):
        out[i].real = out[i].real or bool(found)
        aim = aims(arm, asked.T[i : i + 1], asked.held[i : i + 1])
        _add(arm, asked.T[i], rows_inside(arm, aim, found, asked.seed(i), limits), out[i].rows)


def _led_to_or_along(arm: Arm, asked: Asked, rows: Array) -> list[list[Found]]:
    """Of each pose what Newton steps from its row lead to, or else the solutions on a curve through it that
    is a continuum of the arm's but for a little that is left."""
    led = _led_to(arm, asked, rows)
    some = np.flatnonzero([not one for one in led])
    if not len(some):
        return led
    if arm.around is None:
        there, error = flat_steps(arm.chain, arm.task, arm.moving, rows[some], asked.T[some])
        some, there = some[error < arm.policy.arrived], there[error < arm.policy.arrived]
        for k, found in zip(some.tolist(), _led_to(arm, asked.at(some), there)):
            led[k] = found
        return led
    aim, broken = aims(arm, asked.T, asked.held)[some], np.ones(len(some), dtype=bool)
    _, owner, q, sigma = arm.around(arm, rows[some], aim, broken)
    flags = (sigma < arm.policy.continuum_below).tolist()
    for k, row in zip(some[owner].tolist(), zip(map(tuple, q.tolist()), flags)):
        led[k].append(row)
    return led


def _hidden_rows(arm: Arm, asked: Asked, some: Index) -> tuple[Index, Array]:
    """Whose they are (k,), and the rows (k, dof): of each branch with the value whose pose is nearest."""
    each = arm.policy.tries
    poses = asked.at(np.repeat(some, each))
    start = poses.starts(arm, np.tile(range(each), len(some)) * arm.policy.try_step)
    closed = closed_form(arm, poses.T, start, poses.held)
    hidden = closed.singular & ~closed.valid & np.isfinite(closed.q).all(axis=2)
    k, lane = np.nonzero(hidden)
    costs = np.full(hidden.shape, np.inf)
    costs[k, lane] = chord_costs(arm, poses.T[k], closed.q[k, lane])
    q = closed.q.reshape(len(some), each, *closed.q.shape[1:])
    cost = costs.reshape(len(some), each, -1)
    pose, lane = np.nonzero(np.isfinite(cost).any(axis=1))
    return some[pose], q[pose, cost.argmin(axis=1)[pose, lane], lane]


def _take_nearest(arm: Arm, asked: Asked, some: Index, limits: bool, out: list[Answer]) -> None:
    """Adds rows that take some of the poses, inside the limits if one of these was found."""
    for inside, flat in product(dict.fromkeys((limits, False)), (False, True)):
        left = asked.at(some)
        rows = nearest_rows(arm, left.T, left.starts(arm), inside, flat)
        for i, found in zip(some.tolist(), _led_to_or_along(arm, left, rows)):
            aim = aims(arm, asked.T[i : i + 1], asked.held[i : i + 1])
            out[i].real = out[i].real or bool(found)
            out[i].rows = rows_inside(arm, aim, found, asked.seed(i), limits)
        some = some[[not out[i].rows for i in some.tolist()]]
        if not len(some):
            break


def _goes_on(
    arm: Arm,
    asked: Asked,
    k: int,
    rows: _Rows,
    seeded: list[Found],
    limits: bool,
    answer: Answer,
) -> bool:
    """Adds rows to an answer, and says whether other values have to be tried."""
    (kept, free, led), T, near = rows, asked.T[k], asked.seed(k)
    if not free and any(flag for _, flag in kept):
        _add(arm, T, seeded, kept)
    answer.real, answer.led = answer.real or bool(kept), answer.led or led
    answer.loose = [one for one in kept if one[1]] or answer.loose
    aim = aims(arm, asked.T[k : k + 1], asked.held[k : k + 1])
    _add(arm, T, rows_inside(arm, aim, kept, near, limits), answer.rows)
    if not answer.rows:
        answer.rows = rows_inside(arm, aim, seeded, near, limits)
    led = led if arm.rounded else any(flag for _, flag in answer.rows)
    return free and not (answer.rows and led)


def _seeded(
    arm: Arm, asked: Asked, start: Array, rows: list[_Rows], limits: bool
) -> dict[int, list[Found]]:
    """What Newton steps from the seeds lead to, where no row is inside the limits, or one is singular."""
    some = [
        k
        for k, (kept, free, _) in enumerate(rows)
        if (not free and any(flag for _, flag in kept))
        or not place_rows(arm, kept, asked.seed(k), limits)
    ]
    return dict(zip(some, _led_to(arm, asked.at(np.array(some, dtype=np.intp)), start[some])))


def seeded_rows(arm: Arm, asked: Asked) -> list[list[Found]]:
    """What Newton steps from the seeds lead to."""
    return _led_to(arm, asked, asked.starts(arm))


def _led_to(arm: Arm, asked: Asked, start: Array) -> list[list[Found]]:
    if not len(start):
        return []
    starts = _given(arm, asked, start, np.arange(len(start)))
    return _meeting(arm, asked, leads_of(arm, starts, np.zeros((len(start), 1), dtype=bool)))


def unplaced_rows(arm: Arm, T: Array, held: Array) -> list[list[Found]]:
    """Distinct solutions of poses T (n, 4, 4), on no turns in particular."""
    asked = Asked(T, None, held)
    rows = _rows(arm, asked, asked.starts(arm), np.zeros(len(T), dtype=int))
    return [kept for kept, _, _ in rows]


def _rows(arm: Arm, asked: Asked, start: Array, turn: Index) -> list[_Rows]:
    """For each pose the solutions (radians between -pi and pi) from its start after some turns (n,): of
    poses beside a rounded arm's, with those of the pose at the first, where they count, and alone at some
    others, as the direction that a vanishing divisor has says little of the file's."""
    first, away, T = not turn.any(), (turn > 0) & (turn <= len(arm.beside)), asked.T.copy()
    T[away] = T[away] @ arm.beside[turn[away] - 1]
    closed = asked.closed.own if asked.closed and first else closed_form(arm, T, start, asked.held)
    free, marked = closed.free | away, closed.valid & (closed.singular | closed.doubt)
    known, rough = np.zeros(closed.valid.shape, dtype=bool), closed.valid & closed.rough
    own = _of_lanes(arm, asked, closed, rough, marked)
    starts = joined(_given(arm, asked, start, np.flatnonzero(free)), own)
    if first and len(arm.beside) and arm.policy.beside_anywhere:
        starts = joined(starts, _beside(arm, asked, start, np.arange(len(start)), closed))
    leads = leads_of(arm, starts, known, near=first and arm.rounded)
    close = (starts.source >= 0) & (leads.ends.sigma < arm.policy.beside_reach) & ~leads.known
    near = free | (np.bincount(starts.pose[close], minlength=len(free)) > 0)
    if first and len(arm.beside) and not arm.policy.beside_anywhere and near.any():
        more = _beside(arm, asked, start, np.flatnonzero(near), closed)
        leads = both(leads, leads_of(arm, more, known))
    if free.any():
        beyond = ~closed.valid & free[:, None] & (first and arm.rounded)
        hidden = closed.singular & ~known & (beyond | _without_rows(arm, free, leads)[:, None])
        hidden &= np.isfinite(closed.q).all(axis=2)
        more = _of_lanes(arm, asked, closed, hidden, hidden)
        leads = both(leads, leads_of(arm, more, known))
    kept = _meeting(arm, asked, leads)
    if first and arm.rounded:
        _add_surfaces(arm, asked, leads, kept)
    for i, k in np.argwhere(closed.valid & ~closed.rough).tolist():
        _add(arm, asked.T[i], [(tuple(closed.q[i, k].tolist()), bool(marked[i, k]))], kept[i])
    return list(zip(kept, free.tolist(), np.logical_or.reduce(marked | known, axis=1).tolist()))


def _add_surfaces(arm: Arm, asked: Asked, leads: Leads, kept: list[list[Found]]) -> None:
    """Adds the solutions on surfaces of the solved geometry that starts lead to."""
    more = leads_of(arm, on_surfaces(arm, leads), np.zeros((len(kept), 1), dtype=bool))
    for T, rows, found in zip(asked.T, kept, _meeting(arm, asked, more)):
        _add(arm, T, found, rows)


def _without_rows(arm: Arm, free: Flags, leads: Leads) -> Flags:
    """Which poses leave a joint free and led nowhere: less than the file is off may be what is missing to
    rows that the closed form has not, or the joint's value lies beyond what others reach."""
    starts, poor = leads.starts, np.array(free, dtype=bool)
    poor[starts.pose[(starts.source >= 0) | (leads.ends.error < arm.policy.arrived)]] = False
    return poor


def _beside(arm: Arm, asked: Asked, start: Array, some: Index, own: ClosedForm) -> Starts:
    """From poses beside some; what leaves a doubt there is marked where one of the pose's `own` does."""
    if asked.closed is not None and arm.policy.beside_anywhere:
        q, valid, marked, doubt = some_of(asked.closed.beside, some)
    else:
        q, valid, marked, doubt = rows_beside(arm, asked.T[some], start[some], asked.held[some])
    marked = marked | doubt & np.any(own.doubt[some], axis=1, keepdims=True)
    pose, row = np.nonzero(valid)
    motion, lane = np.divmod(row, valid.shape[1] // len(arm.beside))
    return _starts(arm, asked, q[pose, row], some[pose], marked[pose, row], 1 + motion, lane)


def _of_lanes(arm: Arm, asked: Asked, closed: ClosedForm, lanes: Flags, marked: Flags) -> Starts:
    """From some of the closed form's rows (N, M), `marked` (N, M)."""
    pose, lane = np.nonzero(lanes)
    source = np.zeros(len(pose), dtype=np.int64)
    return _starts(arm, asked, closed.q[pose, lane], pose, marked[pose, lane], source, lane)


def _given(arm: Arm, asked: Asked, start: Array, pose: Index) -> Starts:
    marked, place = np.ones(len(pose), dtype=bool), np.zeros(len(pose), dtype=np.int64)
    return _starts(arm, asked, start[pose], pose, marked, place - 1, place)


def _starts(
    arm: Arm, asked: Asked, q: Array, pose: Index, marked: Flags, source: Index, lane: Index
) -> Starts:
    aim = aims(arm, asked.T, asked.held)[pose]
    return Starts(q, aim, pose, marked, source, lane)


def _meeting(arm: Arm, asked: Asked, leads: Leads) -> list[list[Found]]:
    """For each pose the distinct rows that Newton steps lead to."""
    out: list[list[Found]] = [[] for _ in asked.T]
    owner, q, sigma = rows_nearby(arm, leads)
    flat, continuum = arm.policy.singular_below, arm.policy.continuum_below
    pose, marked = leads.starts.pose[owner], leads.starts.marked[owner]
    flags = (marked & (sigma < continuum)) | (sigma < flat)
    for k in that_differ(arm, asked.T, pose, q, flags).tolist():
        out[pose[k]].append((tuple(q[k].tolist()), bool(flags[k])))
    return out


def _add(arm: Arm, T: Array, rows: list[Found], kept: list[Found]) -> None:
    """Adds those of the rows that differ from all that are there."""
    for row, singular in rows:
        if is_new(arm, row, kept) and not (singular and repeats(arm, T, row, kept)):
            kept.append((row, singular))
