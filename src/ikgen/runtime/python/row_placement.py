"""Rows on the whole turns that limits and seed ask for, and without repetitions: for floats and arrays."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor, inf, pi

import numpy as np

from ikgen.runtime.python.array_types import Array, Flags, Row
from ikgen.runtime.python.solved_arm import Arm, Found

__all__ = ["distinct", "in_order", "is_new", "place_rows", "place_rows_batch"]

_TURN = 2.0 * pi


def is_new(arm: Arm, row: Row, kept: Sequence[Found]) -> bool:
    """Whether the row differs from all kept ones, whole turns aside; long slides count relative to their
    length."""
    near, revolute = arm.policy.coincident, arm.chain.revolute[::-1]
    for other, _ in kept:
        for a, b, turns in zip(
            reversed(row), reversed(other), revolute
        ):  # the last ones differ most
            gap = abs(a - b)
            if gap <= near:
                continue
            if abs((gap + pi) % _TURN - pi) > near if turns else gap > near * abs(a):
                break
        else:
            return False
    return True


def distinct(arm: Arm, q: Array, valid: Flags) -> Flags:
    """Which rows (N, M, dof) are valid and differ from all earlier valid ones, whole turns aside; long
    slides count relative to their length."""
    near = arm.policy.coincident
    later, earlier = np.tril_indices(q.shape[1], -1)
    same = valid.T[later] & valid.T[earlier]
    for j in reversed(range(q.shape[2])):  # the last joints differ between most rows
        value = q[:, :, j].T
        gap = np.abs(value[later] - value[earlier])
        bound = near if arm.chain.revolute[j] else near * np.abs(value[later])
        far = np.abs(gap - _TURN) if arm.chain.revolute[j] else gap
        same &= (gap <= near) | (far <= bound)
        if not same.any():
            return valid
    valid, some = valid.copy(), same.any(axis=1)
    for i, k, equal in zip(later[some].tolist(), earlier[some].tolist(), same[some]):
        valid[:, i] &= ~(equal & valid[:, k])
    return valid


def place_rows(arm: Arm, rows: list[Found], near: Row | None, limits: bool) -> list[Found]:
    """The rows on the right turns; those that no turn brings inside the limits are dropped."""
    placed = [(_place(arm, row, near, limits), flag) for row, flag in rows]
    return [(row, flag) for row, flag in placed if row is not None]


def _place(arm: Arm, row: Row, near: Row | None, limits: bool) -> Row | None:
    out = []
    for j, (q, turning, low, high) in enumerate(zip(row, arm.turning, arm.lower, arm.upper)):
        shift = 0.0
        if turning:
            if q <= -pi:
                q += _TURN
            elif q > pi:
                q -= _TURN
            if near is not None:
                shift = _TURN * round((near[j] - q) / _TURN)
        if limits and not low <= q + shift <= high:
            least, most = low - arm.policy.limit_tolerance, high + arm.policy.limit_tolerance
            if turning and q + shift < least:
                shift = _TURN * ceil((least - q) / _TURN)
            if turning and q + shift > most:
                shift = _TURN * floor((most - q) / _TURN)
            if not least <= q + shift <= most:
                return None
            out.append(min(max(q + shift, low), high))
        else:
            out.append(q + shift)
    return tuple(out)


def in_order(arm: Arm, rows: list[Found], near: Row | None) -> list[Found]:
    """The rows, no more than the arm has, nearest to a seed first."""
    if near is not None:
        rows = sorted(rows, key=lambda item: sum((a - b) * (a - b) for a, b in zip(item[0], near)))
    return rows[: arm.most]


def place_rows_batch(arm: Arm, q: Array, near: Array | None, limits: bool) -> tuple[Array, Flags]:
    """Rows (N, M, dof) on the right turns, in place, and which of them lie inside the limits."""
    inside = np.ones(q.shape[:2], dtype=bool)
    for j, (turning, low, high) in enumerate(zip(arm.turning, arm.lower, arm.upper)):
        value = q[..., j]
        least, most = low - arm.policy.limit_tolerance, high + arm.policy.limit_tolerance
        if turning:
            value = np.where(value <= -pi, value + _TURN, value)
            value = np.where(value > pi, value - _TURN, value)
            turns: Array = np.zeros(1)
            if near is not None:
                turns = np.round((near[:, None, j] - value) / _TURN)
            if limits and least > -inf:
                turns = np.maximum(turns, np.ceil((least - value) / _TURN))
            if limits and most < inf:
                turns = np.minimum(turns, np.floor((most - value) / _TURN))
            value = value + _TURN * turns
        if limits:
            inside &= (value >= least) & (value <= most)
            value = np.minimum(np.maximum(value, low), high)
        q[..., j] = value
    return q, inside
