"""Ratios of joints that are geared to each other, as fractions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

__all__ = ["MOST_PARTS", "common_share", "is_whole"]

MOST_PARTS = 10**7
"""The largest denominator: the cosine and sine of that share of a turn still tell the turn to 1e-9 rad."""

_SAME = 1e-11
"""Relative difference of a ratio and its fraction: a turn of 3 rad is 3e-11 rad off."""

_WHOLE = 1e-10


def common_share(ratios: Sequence[float]) -> int:
    """The least n for which `n * ratio` is whole for all ratios; 1 where none is small enough."""
    parts = 1
    for ratio in ratios:
        fraction = _fraction(ratio)
        if fraction is None:
            return 1
        parts = math.lcm(parts, fraction.denominator)
    return parts if parts <= MOST_PARTS else 1


def is_whole(ratio: float) -> bool:
    """Whether a ratio is a whole number but for rounding."""
    return ratio == 0.0 or (round(ratio) != 0 and abs(ratio / round(ratio) - 1.0) <= _WHOLE)


def _fraction(ratio: float) -> Fraction | None:
    """The simplest fraction that a ratio is but for rounding."""
    for digits in range(8):
        found = Fraction(ratio).limit_denominator(10**digits)
        if abs(float(found) - ratio) <= _SAME * abs(ratio):
            return found
    return None
