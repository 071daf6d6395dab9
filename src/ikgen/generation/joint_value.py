"""Values of joints as people write them: numbers in rad or m, or with a unit."""

from __future__ import annotations

import math
import numbers
import re

__all__ = ["UNITS", "joint_value"]

UNITS = {
    "rad": 1.0,
    "deg": math.pi / 180.0,
    "°": math.pi / 180.0,
    "m": 1.0,
    "cm": 0.01,
    "mm": 0.001,
}
"""What a unit is in rad or m."""

_WITH_UNIT = re.compile(r"(.*?)\s*(rad|deg|°|mm|cm|m)")


def joint_value(value: object) -> float:
    """The value in rad or m of a number, or of a text of a number and perhaps a unit ("45deg").

    Raises ValueError for anything else, and for what is not finite.
    """
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        number = float(value)
    elif isinstance(value, str):
        number = _of_text(value)
    else:
        raise ValueError(f"{value!r} is not a number")
    if not math.isfinite(number):
        raise ValueError(f"{value!r} is not a finite number")
    return number


def _of_text(text: str) -> float:
    match = _WITH_UNIT.fullmatch(text.strip())
    digits, unit = match.groups() if match else (text, "rad")
    try:
        number = float(digits)
    except ValueError:
        raise ValueError(f"{text!r} is not a finite number") from None
    # exact for the turns that people mean: 90deg is the nearest number to pi/2
    return math.radians(number) if unit in ("deg", "°") else number * UNITS[unit]
