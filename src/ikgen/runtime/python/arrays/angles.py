"""Angles without their whole turns."""

from __future__ import annotations

from math import pi

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["WHOLE_TURN", "within_periods", "without_turns"]

WHOLE_TURN = 2.0 * pi


def without_turns(angles: Array, turn: float | Array = WHOLE_TURN) -> Array:
    """Angles, or gaps between two on the shortest way: from -pi to pi, or within half of another turn."""
    return np.asarray(angles - turn * np.round(angles / turn))


def within_periods(values: Array, period: tuple[float, ...]) -> Array:
    """Joint values (..., dof), or gaps between two, within half a period; those of joints without, of which
    it is 0, as they are."""
    turn = np.array(period)
    return np.where(turn > 0.0, without_turns(values, np.where(turn > 0.0, turn, 1.0)), values)
