"""Rows on the whole turns that limits and seed ask for, and without repetitions: for floats and arrays."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import ceil, floor, inf, remainder
from operator import lt
from typing import Any

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm, Found
from ikgen.runtime.python.arrays.angles import WHOLE_TURN, without_turns
from ikgen.runtime.python.arrays.array_types import Array, Flags, Row
from ikgen.runtime.python.rows.row_links import differences, neighbouring_rows, slide_scale
from ikgen.runtime.python.rows.row_pairs import pairs

__all__ = [
    "apart",
    "distinct",
    "in_order",
    "is_new",
    "place_rows",
    "place_rows_batch",
    "rows_at_limits",
    "same_rows",
]


def is_new(arm: Arm, row: Row, kept: Sequence[Found]) -> bool:
    """Whether the row differs from all kept ones, whole turns aside; long slides count relative to their
    length."""
    near, period = arm.policy.coincident, arm.period[::-1]
    for other, _ in kept:
        for a, b, turn in zip(reversed(row), reversed(other), period):  # the last ones differ most
            gap = abs(a - b)
            if gap <= near:
                continue
            if abs(remainder(gap, turn)) > near if turn else gap > near * abs(a):
                break
        else:
            return False
    return True


def same_rows(arm: Arm, a: Array, b: Array) -> Flags:
    """Which rows a (k, dof) are the rows b (k, dof), by what `is_new` goes by."""
    bound = np.where(np.array(arm.period) > 0.0, 1.0, slide_scale(a))
    gap = np.abs(differences(arm, a, b))
    return np.asarray((gap <= arm.policy.coincident * bound).all(axis=1))


def apart(arm: Arm, q: Array) -> bool:
    """Whether all rows (k, dof) of revolute joints differ, whole turns aside; False also where slides have
    to tell. A number of each, whole turns of which are whole turns of the joints, tells most of them."""
    if not all(arm.period):
        return False
    period = np.array(arm.period)
    weight = np.arange(1.0, q.shape[1] + 1.0) * (WHOLE_TURN / period)
    turns = sorted((q @ weight % WHOLE_TURN).tolist())
    enough = 2.0 * arm.policy.coincident * float(weight.sum())
    if all(
        b - a > enough for a, b in zip(turns, [*turns[1:], *(x + WHOLE_TURN for x in turns[:1])])
    ):
        return True
    later, earlier = pairs(len(q))
    gap = without_turns(q[later] - q[earlier], period)
    most = np.maximum.reduce(np.abs(gap), axis=1, initial=0.0)
    return bool((most > arm.policy.coincident).all())


def distinct(arm: Arm, q: Array, valid: Flags) -> Flags:
    """Which rows (N, M, dof) are valid and differ from all earlier valid ones, by what `is_new` goes by."""
    near = arm.policy.coincident
    later, earlier = pairs(q.shape[1])
    same = valid.T[later] & valid.T[earlier]
    for j in reversed(range(q.shape[2])):  # the last joints differ between most rows
        value = q[:, :, j].T
        gap = np.abs(value[later] - value[earlier])
        if arm.period[j]:
            same &= (gap <= near) | (np.abs(gap - arm.period[j]) <= near)
        else:
            same &= gap <= near * slide_scale(value[later])
        if not same.any():
            return valid
    valid, some = valid.copy("K"), same.any(axis=1)
    for i, k, equal in zip(later[some].tolist(), earlier[some].tolist(), same[some]):
        valid[:, i] &= ~(equal & valid[:, k])
    return valid


def place_rows(arm: Arm, rows: list[Found], near: Row | None, limits: bool) -> list[Found]:
    """The rows on the right turns; those that no turn brings inside the limits are dropped."""
    return rows_at_limits(arm, rows, near, limits)[0]


def rows_at_limits(
    arm: Arm, rows: list[Found], near: Row | None, limits: bool
) -> tuple[list[Found], list[tuple[Found, Row]]]:
    """`place_rows`, and of the dropped rows those hardly outside: as they were, and on the limits."""
    inside, close = [], []
    least, most = _one_turn(arm.lower, arm.upper, arm.placing, limits)
    for row, flag in rows:
        if near is None and all(map(lt, least, row)) and all(map(lt, row, most)):
            inside.append((row, flag))
            continue
        placed, beyond = _place(arm, row, near, limits)
        if placed is not None and beyond:
            close.append(((row, flag), placed))
        elif placed is not None:
            inside.append((placed, flag))
    return inside, close


@cache
def _one_turn(low: Row, high: Row, period: Row, limits: bool) -> tuple[Row, Row]:
    """Between which values of the joints rows are on their turns, and inside the limits."""
    if not limits:
        low, high = (-inf,) * len(low), (inf,) * len(low)
    least = tuple(max(x, -0.5 * turn) if turn else x for x, turn in zip(low, period))
    return least, tuple(min(x, 0.5 * turn) if turn else x for x, turn in zip(high, period))


def _place(arm: Arm, row: Row, near: Row | None, limits: bool) -> tuple[Row | None, bool]:
    """The row on its turns, None where it is far outside; and whether it had to be moved to limits by more
    than round-off."""
    out, beyond = [], False
    for j, (q, turn, low, high) in enumerate(zip(row, arm.placing, arm.lower, arm.upper)):
        shift = 0.0
        if turn:
            if q <= -0.5 * turn:
                q += turn
            elif q > 0.5 * turn:
                q -= turn
            if near is not None:
                shift = turn * round((near[j] - q) / turn)
        if limits and not low <= q + shift <= high:
            least, most = low - arm.policy.limit_tolerance, high + arm.policy.limit_tolerance
            if turn and q + shift < least:
                shift = turn * ceil((least - q) / turn)
            if turn and q + shift > most:
                shift = turn * floor((most - q) / turn)
            if not least <= q + shift <= most:
                to_low, to_high = low - q, high - q
                if turn:
                    to_low, to_high = remainder(to_low, turn), remainder(to_high, turn)
                if min(abs(to_low), abs(to_high)) > arm.policy.limit_reach:
                    return None, True
                q, shift, beyond = low if abs(to_low) < abs(to_high) else high, 0.0, True
            out.append(min(max(q + shift, low), high))
        else:
            out.append(q + shift)
    return tuple(out), beyond


def in_order(arm: Arm, rows: list[Found], near: Row | None) -> list[Found]:
    """The rows, nearest to a seed first: of a continuum at most `crowd` that are alike, and where there are
    more than the arm has, those of none."""
    if near is not None:
        rows = sorted(rows, key=lambda item: sum((a - b) * (a - b) for a, b in zip(item[0], near)))
    if any(singular for _, singular in rows):
        rows = _thinned(arm, rows)
        room = arm.most - sum(not singular for _, singular in rows)
        places = np.cumsum([singular for _, singular in rows])
        rows = [one for one, place in zip(rows, places) if not one[1] or place <= room]
    return rows[: arm.most]


def _thinned(arm: Arm, rows: list[Found]) -> list[Found]:
    """Without rows of a continuum that are alike to `crowd` others before them."""
    kept: list[Found] = []
    for row, singular in rows:
        others = [other for other, flag in kept if flag] if singular else []
        near = neighbouring_rows(arm, np.array(others).reshape(-1, len(row)), np.array(row))
        if near.sum() < arm.policy.crowd:
            kept.append((row, singular))
    return kept


def place_rows_batch(
    arm: Arm, q: Array, near: Array | None, limits: bool
) -> tuple[Array, Flags, Flags]:
    """Rows (N, M, dof) on the right turns, in place, which of them lie inside the limits, and which may be
    hardly outside."""
    inside, close = np.ones((2, *q.shape[1::-1]), dtype=bool).transpose(0, 2, 1)  # as q in memory
    least, most = _one_turn(arm.lower, arm.upper, arm.placing, limits)
    for j in range(q.shape[2]):
        some: tuple[Any, ...] = (slice(None), slice(None))
        if near is None:
            some = np.nonzero(~((least[j] < q[..., j]) & (q[..., j] < most[j])))
        seed, place = None if near is None else near[:, None, j], (*some, j)
        q[place], fits, beyond = _placed_values(arm, j, q[place], seed, limits)
        inside[some] &= fits
        close[some] &= beyond
    return q, inside, close & ~inside


def _placed_values(
    arm: Arm, j: int, value: Array, near: Array | None, limits: bool
) -> tuple[Array, Flags, Flags]:
    """Values (...) of a joint on the right turns; which lie inside the limits, and which there or hardly
    outside."""
    turn, low, high, reach = arm.placing[j], arm.lower[j], arm.upper[j], arm.policy.limit_reach
    if not limits:
        low, high = -inf, inf
    least, most = low - arm.policy.limit_tolerance, high + arm.policy.limit_tolerance
    if turn:
        value = np.where(value <= -0.5 * turn, value + turn, value)
        value = np.where(value > 0.5 * turn, value - turn, value)
        turns: Array = np.zeros(1)
        if near is not None:
            turns = np.round((near - value) / turn)
        if least > -inf:
            turns = np.maximum(turns, np.ceil((least - value) / turn))
        if most < inf:
            turns = np.minimum(turns, np.floor((most - value) / turn))
        value = value + turn * turns
    beyond = (value > low - reach) & (value < high + reach)
    if turn:
        beyond |= value + turn < high + reach
    fits = (value >= least) & (value <= most)
    return np.minimum(np.maximum(value, low), high), fits, beyond
