"""Joint limits as files really state them, made into ranges."""

from __future__ import annotations

import math

from ikgen.importers.urdf.attribute_values import BadValueError
from ikgen.model.joint_tree import JointType, Limits

__all__ = ["FARTHEST", "UNLIMITED", "joint_limits"]

UNLIMITED = Limits(-math.inf, math.inf)

# Two turns either way; robots that state more than that mean degrees (or no limit at all).
_DEGREES_ABOVE = 4.0 * math.pi + 1e-6
_NO_LIMIT_FROM = 1e3
_TURN = 2.0 * math.pi
FARTHEST = 1e6
"""Neighbouring doubles are 1e-10 apart here: no joint value beyond this (rad or m) is exact."""


def joint_limits(
    type_: JointType, lower: float | None, upper: float | None
) -> tuple[Limits, tuple[str, ...]]:
    """The range of a joint (rad or m) and what was odd about it.

    URDF's default of an absent bound is 0, which cannot be meant where both are absent or 0: such
    a joint has no limits. URDF gives a continuous joint none, whatever its file states. Raises
    `BadValueError` for a range that begins beyond all values which can be told apart.
    """
    if not type_.moves_on_one_axis or type_ is JointType.CONTINUOUS:
        return UNLIMITED, ()
    if lower is None and upper is None:
        return UNLIMITED, ("no lower and upper limit: taken as unlimited",)
    low, high = lower or 0.0, upper or 0.0
    if low == high == 0.0:
        return UNLIMITED, ("lower = upper = 0: taken as unlimited",)
    notes = []
    if lower is None or upper is None:
        missing = "lower" if lower is None else "upper"
        notes.append(f"no {missing} limit: taken as 0, the default of URDF")
    if low > high:
        notes.append(f"lower limit {low:g} is above the upper limit {high:g}: swapped")
        low, high = high, low
    if low > FARTHEST - _TURN or high < -FARTHEST + _TURN:  # a turn inside has to be there
        raise BadValueError(
            f"limits {low:g} to {high:g} hold no value that can be told from its neighbours",
            "write limits in rad or m",
        )
    if low == high:
        notes.append(f"lower = upper = {low:g}: the joint cannot move")
    widest = max(abs(low), abs(high))
    if type_ is not JointType.PRISMATIC and _DEGREES_ABOVE < widest < _NO_LIMIT_FROM:
        notes.append(f"limits {low:g} to {high:g} rad look like degrees: kept as they are")
    return Limits(low, high), tuple(notes)
