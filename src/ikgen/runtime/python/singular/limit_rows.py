"""Rows that are hardly outside the limits: near singularities the pose does not tell that."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm, Found
from ikgen.runtime.python.arrays.array_types import Array, Row
from ikgen.runtime.python.newton.arm_newton import refined
from ikgen.runtime.python.newton.refinement import refine
from ikgen.runtime.python.rows.row_placement import place_rows, rows_at_limits

__all__ = ["rows_inside"]


def rows_inside(
    arm: Arm, aim: Array, rows: list[Found], near: Row | None, limits: bool
) -> list[Found]:
    """`place_rows` towards an aim (1, ...). A row that is hardly outside takes Newton steps first; if it
    stays there its other joints do, and what is outside, all or one joint, is put on the limits."""
    inside, close = rows_at_limits(arm, rows, near, limits)
    for (row, flag), on_limits in close:
        q, error, _, _ = refined(arm, np.array([row]), aim)
        found = [(tuple(q[0].tolist()), flag)] if error[0] < arm.policy.arrived else []
        inside += place_rows(arm, found, near, limits) or _held_there(arm, aim, on_limits, flag)
    return inside


def _held_there(arm: Arm, aim: Array, row: Row, flag: bool) -> list[Found]:
    """The row with its joints on limits left there, all of them or one alone, if the pose is right to
    round-off: how far each is outside depends on how far along a direction that hardly moves it."""
    on = [j for j in arm.moving if row[j] in (arm.lower[j], arm.upper[j])]
    start, policy = np.array([row]), arm.policy
    for held in (on, *([j] for j in on if len(on) > 1)):
        moving = [j for j in arm.moving if j not in held]
        q, error, _, _ = refine(arm.chain, arm.task, moving, start, aim, policy, arm.angle)
        found = [(tuple(q[0].tolist()), flag)] if error[0] < policy.exact else []
        if placed := place_rows(arm, found, row, True):
            return placed
    return []
