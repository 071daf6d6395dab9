"""Angles without their whole turns."""

from __future__ import annotations

from math import pi

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["WHOLE_TURN", "without_turns"]

WHOLE_TURN = 2.0 * pi


def without_turns(angles: Array) -> Array:
    """Angles, or gaps between two on the shortest way: from -pi to pi."""
    return np.asarray(angles - WHOLE_TURN * np.round(angles / WHOLE_TURN))
