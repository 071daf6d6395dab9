"""Rows of several poses in one array: without repetitions, and in order."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.rows.row_links import slide_scale
from ikgen.runtime.python.rows.row_pairs import pairs

__all__ = [
    "Turning",
    "distinct_rows",
    "exact_first",
    "first_of_equals",
    "pairs_within",
    "places",
    "rows_of",
    "slides_near",
    "sorted_rows",
]

Turning = tuple[bool, ...]  # which of the six joints turn; the others slide
_FARTHEST = 1e4  # of a slide, in arm lengths
_SAME_KEY = 1e-7  # rad or arm lengths: values that do not decide which row comes first


def rows_of(rows: Array, pose: Index) -> Array:
    """Rows of poses, where they are not the same for all."""
    return rows[pose] if len(rows) > 1 else rows


def slides_near(q: Array, turning: Turning) -> Flags:
    """Which rows (k, 6) have no slide far beyond the arm: there slides become parallel."""
    return np.asarray((np.array(turning) | (np.abs(q) < _FARTHEST)).all(axis=1))


def places(pose: Index) -> Index:
    """The number of each row among those of its pose, pose (k,) in order."""
    first = np.searchsorted(pose, pose)
    return np.asarray(np.arange(len(pose)) - first)


def pairs_within(group: Index) -> tuple[Index, Index]:
    """The members of each pair (n,) of a group (k,), the earlier ones first."""
    order = np.argsort(group, kind="stable")
    in_order = group[order]
    more = np.searchsorted(in_order, in_order, side="right") - np.arange(len(group)) - 1
    one = np.repeat(np.arange(len(group)), more)
    return order[one], order[one + 1 + places(one)]


def first_of_equals(q: Array, pose: Index, turning: Turning, coincident: float) -> Flags:
    """Which rows of q (k, 6) equal no earlier one of their pose, pose (k,) in order; see `is_new`."""
    if not len(q):
        return np.zeros(0, dtype=bool)
    place, first = places(pose), pose[0]
    width = int(place.max()) + 1
    values = np.full((6, width, int(pose[-1] - first) + 1), np.nan)
    values[:, place, pose - first] = q.T
    later, earlier = pairs(width)
    value = values[-1]  # the last differ between most rows
    near = _gaps(value[later], value[earlier], turning[-1]) <= coincident
    k, at = np.nonzero(near)
    later, earlier = later[k], earlier[k]
    for value, turns in zip(values[-2::-1], turning[-2::-1]):
        near = _gaps(value[later, at], value[earlier, at], turns) <= coincident
        later, earlier, at = later[near], earlier[near], at[near]
    if not len(later):
        return np.ones(len(q), dtype=bool)
    repeated = np.zeros(values.shape[1:], dtype=bool)
    repeated[later, at] = True
    keep: Flags = ~repeated[place, pose - first]
    return keep


def _gaps(one: Array, other: Array, turns: bool) -> Array:
    """How far values of a joint are from others (...), of long slides relative to their length."""
    gap: Array = np.abs(one - other)
    around = np.abs(np.pi - np.abs(np.pi - gap))
    return around if turns else gap / slide_scale(other)


def distinct_rows(
    q: Array, pose: Index, turning: Turning, coincident: float
) -> tuple[Array, Index, Index]:
    """The rows of q (k, 6) with their poses (k,), these in order: angles reduced to (-pi, pi], without
    repetitions and slides far beyond the arm; and their indices in q."""
    order = np.argsort(pose, kind="stable")
    order = order[slides_near(q[order], turning)]
    q = np.where(turning, np.pi - np.mod(np.pi - q[order], 2.0 * np.pi), q[order])
    keep = first_of_equals(q, pose[order], turning, coincident)
    return q[keep], pose[order[keep]], order[keep]


def exact_first(
    q: Array, pose: Index, exact: Flags, turning: Turning, coincident: float
) -> tuple[Array, Index, Flags]:
    """`distinct_rows`, of equal ones an exact one where there is any, and which of them are exact (k,)."""
    order = np.lexsort((~exact, pose))
    q, pose, kept = distinct_rows(q[order], pose[order], turning, coincident)
    return q, pose, exact[order[kept]]


def sorted_rows(q: Array, pose: Index, turning: Turning) -> Array:
    """Rows (k, 6) of poses (k,) in order, each pose's in one that does not hang on how they were found;
    turns are cut at -1 rad, where no right angle lies."""
    keys = np.where(turning, np.mod(q + 1.0, 2.0 * np.pi), q)
    rank: Index = pose
    order = np.arange(len(q))
    for key in keys.T:
        order = np.lexsort((key, rank))
        apart = (np.diff(rank[order]) > 0) | (np.diff(key[order]) > _SAME_KEY)
        rank = np.zeros(len(q), dtype=np.intp)
        rank[order[1:]] = np.cumsum(apart)
        if apart.all():
            break
    return np.asarray(q[order])
