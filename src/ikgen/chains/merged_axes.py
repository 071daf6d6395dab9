"""Neighbouring axes of one joint that together are one axis: linkages whose parts turn back, such as the
parallelogram that keeps a remote centre, and slides that share a travel.

With `u` the direction that all axes of a linkage have, and `s_i` the sum of the multipliers up to the
i-th, a point behind them goes to `sum_i Rot(u, s_i q) t_i`: where each of the `s_i` is 0 or their last,
`s`, that is `b + Rot(u, s q) a`, a turn about an axis that is moved by `b`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ikgen.kinematics.fixed_order import dot, length, product
from ikgen.kinematics.rigid import axis_motion, read_only
from ikgen.model.arrays import Array
from ikgen.model.chain import PRISMATIC, ChainAxis
from ikgen.model.gear_ratio import is_whole

__all__ = ["merged_axes"]

_SAME = 1e-12
"""What is round-off of a direction, of a length (m) and of a sum of multipliers."""


def merged_axes(
    axes: Sequence[ChainAxis], T_last_tip: Array, spans: Sequence[float]
) -> tuple[tuple[ChainAxis, ...], Array]:
    """The axes of a chain and the transform (4, 4) behind them, the same motion with as few axes. `spans`:
    how far (rad or m) the limits of each joint are apart."""
    merged: list[ChainAxis] = []
    T = np.eye(4)  # from where the last merged axis ends to the frame that the file has there
    k = 0
    while k < len(axes):
        axis = replace(axes[k], T_prev_axis=read_only(product(T, axes[k].T_prev_axis)))
        one, T, used = _longest(axis, axes[k + 1 :], spans[axis.driver])
        merged.append(one)
        k += used
    return tuple(merged), read_only(product(T, T_last_tip))


def _longest(
    first: ChainAxis, others: Sequence[ChainAxis], span: float
) -> tuple[ChainAxis, Array, int]:
    """An axis with as many of the next ones as are one with it: that one, the transform behind it, and how
    many they are."""
    best = first, np.eye(4), 1
    motion = _Slide(first) if first.kind == PRISMATIC else _Turn(first, span)
    for used, axis in enumerate(others, start=2):
        if axis.driver != first.driver or axis.kind != first.kind or not motion.goes_on(axis):
            break
        one = motion.as_one()
        if one is not None:
            best = *one, used
    return best


class _Slide:
    """Slides of one joint behind each other: whatever their directions, one."""

    def __init__(self, first: ChainAxis) -> None:
        self._first = first
        self._T = axis_motion(False, first.axis, first.offset)
        self._moved = first.multiplier * first.axis

    def goes_on(self, axis: ChainAxis) -> bool:
        self._T = product(self._T, axis.T_prev_axis)
        along = product(self._T[:3, :3], axis.axis)
        self._moved = self._moved + axis.multiplier * along
        self._T = product(self._T, axis_motion(False, axis.axis, axis.offset))
        return True

    def as_one(self) -> tuple[ChainAxis, Array] | None:
        far = length(self._moved)
        if far <= _SAME:
            return None
        along = read_only(self._moved / far)
        return replace(self._first, axis=along, multiplier=float(far), offset=0.0), self._T


@dataclass(slots=True)
class _Turn:
    """Turns of one joint about parallel axes behind each other: one where all of them turn it back by
    nothing or as far as the last. Its whole turn has to turn each of them round, or to be more than the
    limits' `span` (rad): values that it does not tell apart are different configurations else."""

    first: ChainAxis
    span: float
    turn: float = 0.0  # how often q, at the last axis
    each: list[float] = field(default_factory=list)  # how often q, of the axes
    rotation: Array = field(default_factory=lambda: np.eye(4))  # the constant one behind it
    moved: list[tuple[float, Array]] = field(default_factory=list)  # what turns how often

    def __post_init__(self) -> None:
        self._turn(self.first, 1.0)

    def _turn(self, axis: ChainAxis, sign: float) -> None:
        self.turn += sign * axis.multiplier
        self.each.append(axis.multiplier)
        about = axis_motion(True, self.first.axis, sign * axis.offset)
        self.rotation = product(about, self.rotation)

    def goes_on(self, axis: ChainAxis) -> bool:
        self.moved.append((self.turn, product(self.rotation[:3, :3], axis.T_prev_axis[:3, 3])))
        between = np.eye(4)
        between[:3, :3] = axis.T_prev_axis[:3, :3]
        self.rotation = product(self.rotation, between)
        along = product(self.rotation[:3, :3], axis.axis)
        sign = 1.0 if dot(along, self.first.axis) > 0.0 else -1.0
        if length(along - sign * self.first.axis) > _SAME:
            return False
        self._turn(axis, sign)
        return True

    def as_one(self) -> tuple[ChainAxis, Array] | None:
        before, behind = np.eye(4), self.rotation.copy()
        for turn, moved in self.moved:
            along = dot(moved, self.first.axis) * self.first.axis
            across = moved - along
            before[:3, 3] += along
            if abs(turn) <= _SAME:
                before[:3, 3] += across
            elif abs(turn - self.turn) <= _SAME:
                behind[:3, 3] += across
            elif length(across) > _SAME:
                return None
        if abs(self.turn) <= _SAME:
            return None
        whole = all(is_whole(x / self.turn) for x in self.each)
        if not whole and self.span * abs(self.turn) > 2.0 * np.pi + _SAME:
            return None
        T = read_only(product(self.first.T_prev_axis, before))
        return replace(self.first, T_prev_axis=T, multiplier=self.turn, offset=0.0), behind
