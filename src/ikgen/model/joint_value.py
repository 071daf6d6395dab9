"""Values of joints as people write them: numbers in rad or m, or with a unit."""

from __future__ import annotations

import math
import numbers
import re

from ikgen.errors import shown

__all__ = [
    "UNITS",
    "JointValue",
    "kind_and_units",
    "parse_joint_value",
    "range_text",
    "value_text",
]

UNITS = {
    "rad": 1.0,
    "deg": math.pi / 180.0,
    "°": math.pi / 180.0,
    "m": 1.0,
    "cm": 0.01,
    "mm": 0.001,
}
"""What a unit is in rad or m."""

_OF_ANGLES = ("rad", "deg", "°")
_WITH_UNIT = re.compile(r"(.*?)\s*(rad|deg|°|mm|cm|m)")


class JointValue(float):
    """A value in rad or m; `unit` is the one that it was `written` with, "" where there was none."""

    unit = ""
    written = ""

    def fits(self, revolute: bool) -> bool:
        """Whether the unit is one of joints that turn, or of those that slide."""
        return not self.unit or revolute == (self.unit in _OF_ANGLES)


def parse_joint_value(value: object) -> JointValue:
    """The value in rad or m of a number, or of a text of a number and perhaps a unit ("45deg").

    Raises ValueError for anything else, and for what is not finite.
    """
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        try:
            number = JointValue(value)
        except OverflowError:
            number = JointValue("inf")
    elif isinstance(value, str):
        number = _of_text(value)
    else:
        raise ValueError(f"a value of type {type(value).__name__} is not a number")
    if not math.isfinite(number):
        raise ValueError(f"{shown(value)} is not a finite number")
    return number


def _of_text(text: str) -> JointValue:
    match = _WITH_UNIT.fullmatch(text.strip())
    digits, unit = match.groups() if match else (text, "")
    try:
        number = float(digits)
    except ValueError:
        raise ValueError(f"{shown(text)} is not a finite number") from None
    # exact for the turns that people mean: 90deg is the nearest number to pi/2
    found = JointValue(
        math.radians(number) if unit in ("deg", "°") else number * UNITS.get(unit, 1)
    )
    found.unit, found.written = unit, text.strip() if unit else ""
    return found


def kind_and_units(revolute: bool) -> tuple[str, str]:
    """What a joint does, and the units of its values, in words."""
    return ("turns", "rad or deg") if revolute else ("slides", "m, cm or mm")


def range_text(low: float, high: float, revolute: bool) -> str:
    """Limits of a joint with their unit."""
    return f"{low:.9g} to {high:.9g} {'rad' if revolute else 'm'}"


def value_text(value: float) -> str:
    """A joint's value as it was written, where that was with a unit; else in rad or m."""
    written = value.written if isinstance(value, JointValue) else ""
    return written.replace(" ", "") or f"{value:.9g}"
