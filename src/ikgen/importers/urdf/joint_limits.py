"""Joint limits as files really state them, made into ranges."""

from __future__ import annotations

import math

from ikgen.importers.urdf.attribute_values import BadValueError
from ikgen.model.joint_tree import JointType, Limits
from ikgen.model.oddity import Oddity, OddityKind

__all__ = ["DEGREES_ABOVE", "FARTHEST", "PINNED", "UNLIMITED", "joint_limits", "turning_limits"]

UNLIMITED = Limits(-math.inf, math.inf)

DEGREES_ABOVE = 4.0 * math.pi + 1e-6
"""Two turns either way (rad): files that state more than that mean degrees, or no limit at all."""

_TURNS = 16.0 * math.pi
"""Eight turns either way (rad): wrists that turn several times stay below."""

_ROUND = 0.5
"""What limits in degrees are multiples of, and those of such wrists in rad hardly are."""

_NO_LIMIT = 1e3
"""A limit (rad) from which on it stands for none: files write 999999, and 159 turns reach every angle."""

PINNED = "it cannot move, so it is locked there unless it is held (--free) or coupled"
"""What becomes of a joint whose limits leave one value."""

_TURN = 2.0 * math.pi
_FREELY = 2.0 * _TURN
"""How far (rad) a joint turns beyond the limit that it has where the other stands for none."""

FARTHEST = 1e6
"""Neighbouring doubles are 1e-10 apart here: no joint value beyond this (rad or m) is exact."""


def joint_limits(
    type_: JointType, lower: float | None, upper: float | None, name: str
) -> tuple[Limits, tuple[Oddity, ...]]:
    """The range of the joint `name` (rad or m) and what was odd about it.

    URDF's default of an absent bound is 0, which cannot be meant where both are absent or 0: such
    a joint has no limits. URDF gives a continuous joint none, whatever its file states, and a revolute
    one that may turn 159 times to either side has none that matter. Raises `BadValueError` for a range that
    begins beyond all values which can be told apart.
    """
    if not type_.moves_on_one_axis or type_ is JointType.CONTINUOUS:
        return UNLIMITED, ()
    if lower is None and upper is None:
        return UNLIMITED, (Oddity("no lower and upper limit: taken as unlimited"),)
    low, high = lower or 0.0, upper or 0.0
    if low == high == 0.0:
        text = f"lower = upper = 0: taken as unlimited; --lock {name}=0 if it cannot move"
        return UNLIMITED, (Oddity(text, name, OddityKind.LOCKABLE),)
    notes = []
    if lower is None or upper is None:
        missing = "lower" if lower is None else "upper"
        notes.append(Oddity(f"no {missing} limit: taken as 0, the default of URDF"))
    if low > high:
        text = f"lower limit {low:g} is above the upper limit {high:g}: swapped"
        notes.append(Oddity(text))
        low, high = high, low
    if low > FARTHEST - _TURN or high < -FARTHEST + _TURN:  # a turn inside has to be there
        raise BadValueError(
            f"limits {low:g} to {high:g} hold no value that can be told from its neighbours",
            "write limits in rad or m",
        )
    if low == high:
        notes.append(Oddity(f"lower = upper = {low:g}: {PINNED}", name, OddityKind.LOCKABLE))
    if type_ is JointType.PRISMATIC:
        return Limits(low, high), tuple(notes)
    limits, odd = turning_limits(low, high)
    return limits, (*notes, *odd)


def turning_limits(low: float, high: float) -> tuple[Limits, tuple[Oddity, ...]]:
    """The range of a revolute joint (rad) whose limits are stated so, and what was odd about it."""
    if low <= -_NO_LIMIT and high >= _NO_LIMIT:
        return UNLIMITED, ()
    if high - low > 2.0 * _NO_LIMIT:
        return _one_sided(low, high)
    if _like_degrees(low, high):
        note = f"limits {low:g} to {high:g} rad look like degrees: kept as they are"
        return Limits(low, high), (Oddity(note),)
    return Limits(low, high), ()


def _one_sided(low: float, high: float) -> tuple[Limits, tuple[Oddity, ...]]:
    """The range where one limit is so far away that it stands for none: two turns from the other, or 0, in
    which every angle lies."""
    above = high > -low
    kept = Limits(low, max(low, 0.0) + _FREELY) if above else Limits(min(high, 0.0) - _FREELY, high)
    far, end = ("upper", kept.upper) if above else ("lower", kept.lower)
    words = f"{far} limit {high if above else low:g} rad stands for none: taken as {end:g}"
    return kept, (Oddity(words),)


def _like_degrees(low: float, high: float) -> bool:
    """Whether limits are beyond two turns, and so round or so far that they can hardly be in rad."""
    farthest = max(abs(low), abs(high))
    rounded = low % _ROUND == 0.0 == high % _ROUND
    return farthest > _TURNS or (farthest > DEGREES_ABOVE and rounded)
