"""Values of what is held that alone reach a pose, which no sample meets: of an arm that is stretched, say,
or whose joints stand on several limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.held.solution_search import with_seeds_row
from ikgen.runtime.python.rows.row_preference import Preference
from ikgen.runtime.python.rows.solutions import Solutions
from ikgen.runtime.python.solving.projection import chord_costs, descended, nearest_rows

__all__ = ["lone_row", "with_lone_row"]

_START_COUNT = 32
# Of squares, what is left of a pose: that is reached to rounding, reached, reached perhaps if joints went
# on that hardly move it.
_EXACT, _THERE, _ALMOST = 1e-22, 1e-12, 1e-4


def lone_row(arm: Arm, T: Array, limits: bool) -> Array | None:
    """A configuration (dof,) that takes a pose T (4, 4), whatever is held, inside the limits if these hold;
    None where none is found."""
    whole = replace(arm, free=(), moving=tuple(range(len(arm.lower))))
    poses, start = T[None], np.zeros((1, len(arm.lower)))
    q = nearest_rows(whole, poses, start, limits, False, _START_COUNT)
    left = _left(whole, T, q)
    if _EXACT < left < _ALMOST:
        q = descended(whole, poses, q, limits, flat=True)
        left = _left(whole, T, q)
    if _EXACT < left < _ALMOST:
        q = nearest_rows(whole, poses, start, limits, True)
        left = _left(whole, T, q)
    return np.asarray(q[0]) if left < _THERE else None


def _left(arm: Arm, T: Array, q: Array) -> float:
    """How far the row (1, dof) leaves the pose, squared."""
    return float(chord_costs(arm, T, q)[0])


def with_lone_row(
    arm: Arm, T: Array, preference: Preference, limits: bool, found: Solutions
) -> Solutions:
    """What was found or, if that is nothing, the best row at the values of what is held that such a
    configuration has."""
    q = None if len(found) else lone_row(arm, T, limits)
    return found if q is None else with_seeds_row(arm, T, q, preference, limits, found)
