"""Solutions of poses near singularities, and of those that leave joints free, by the closed form's rows and
next to these: of many poses at once, as the price of Newton steps is that of the calls."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm, Found
from ikgen.runtime.python.arrays.array_tuples import joined, some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.rows.row_placement import is_new
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
from ikgen.runtime.python.solving.asked_poses import Asked
from ikgen.runtime.python.solving.closed_form_rows import ClosedForm, closed_form, rows_beside

__all__ = ["FoundRows", "add_new", "led_to", "rows_from", "seeded_rows", "unplaced_rows"]

FoundRows = tuple[list[Found], bool, bool]
"""Distinct solutions of a pose, whether it left a joint free, and the closed form led anywhere then."""


def rows_from(arm: Arm, asked: Asked, start: Array, turn: Index) -> list[FoundRows]:
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
    aim = asked.aim(arm)
    for i, k in np.argwhere(closed.valid & ~closed.rough).tolist():
        add_new(arm, aim[i], [(tuple(closed.q[i, k].tolist()), bool(marked[i, k]))], kept[i])
    return list(zip(kept, free.tolist(), np.logical_or.reduce(marked | known, axis=1).tolist()))


def seeded_rows(arm: Arm, asked: Asked) -> list[list[Found]]:
    """What Newton steps from the seeds lead to."""
    return led_to(arm, asked, asked.starts(arm))


def led_to(arm: Arm, asked: Asked, start: Array) -> list[list[Found]]:
    """What Newton steps from the start (n, dof) of each pose lead to."""
    if not len(start):
        return []
    starts = _given(arm, asked, start, np.arange(len(start)))
    return _meeting(arm, asked, leads_of(arm, starts, np.zeros((len(start), 1), dtype=bool)))


def unplaced_rows(arm: Arm, T: Array, held: Array) -> list[list[Found]]:
    """Distinct solutions of poses T (n, 4, 4), on no turns in particular."""
    asked = Asked(T, None, held)
    rows = rows_from(arm, asked, asked.starts(arm), np.zeros(len(T), dtype=int))
    return [kept for kept, _, _ in rows]


def _add_surfaces(arm: Arm, asked: Asked, leads: Leads, kept: list[list[Found]]) -> None:
    """Adds the solutions on surfaces of the solved geometry that starts lead to."""
    more = leads_of(arm, on_surfaces(arm, leads), np.zeros((len(kept), 1), dtype=bool))
    for aim, rows, found in zip(asked.aim(arm), kept, _meeting(arm, asked, more)):
        add_new(arm, aim, found, rows)


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
    own_doubt = own.valid[some] & own.doubt[some]
    marked = marked | doubt & own_doubt.any(axis=1, keepdims=True)
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
    return Starts(q, asked.aim(arm)[pose], pose, marked, source, lane)


def _meeting(arm: Arm, asked: Asked, leads: Leads) -> list[list[Found]]:
    """For each pose the distinct rows that Newton steps lead to."""
    out: list[list[Found]] = [[] for _ in asked.T]
    owner, q, sigma = rows_nearby(arm, leads)
    flat, continuum = arm.policy.singular_below, arm.policy.continuum_below
    pose, marked = leads.starts.pose[owner], leads.starts.marked[owner]
    flags = (marked & (sigma < continuum)) | (sigma < flat)
    for k in that_differ(arm, asked.aim(arm), pose, q, flags).tolist():
        out[pose[k]].append((tuple(q[k].tolist()), bool(flags[k])))
    return out


def add_new(arm: Arm, aim: Array, rows: list[Found], kept: list[Found]) -> None:
    """Adds those of the rows towards an aim (4 or 6, 4) that differ from all that are there."""
    for row, singular in rows:
        if is_new(arm, row, kept) and not (singular and repeats(arm, aim, row, kept)):
            kept.append((row, singular))
