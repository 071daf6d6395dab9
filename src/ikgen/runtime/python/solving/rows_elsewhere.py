"""Rows for poses that the closed form leaves without, or without one of a continuum: behind joints that it
left free, nearest to the pose, along continua."""

from __future__ import annotations

from itertools import product

import numpy as np

from ikgen.runtime.python.arm.limit_margins import turned_inside
from ikgen.runtime.python.arm.solved_arm import Arm, Found
from ikgen.runtime.python.arrays.array_types import Array, Index, Row
from ikgen.runtime.python.newton.flat_steps import flat_steps
from ikgen.runtime.python.newton.refinement import smallest_singular_values
from ikgen.runtime.python.rows.row_placement import place_rows
from ikgen.runtime.python.singular.limit_curves import rows_along
from ikgen.runtime.python.singular.limit_rows import rows_inside
from ikgen.runtime.python.singular.near_continuum import rows_around
from ikgen.runtime.python.solving.asked_poses import Answer, Asked
from ikgen.runtime.python.solving.closed_form_rows import closed_form
from ikgen.runtime.python.solving.doubtful_rows import add_new, led_to
from ikgen.runtime.python.solving.projection import chord_costs, descended, nearest_rows

__all__ = ["take_along", "take_hidden", "take_nearest"]


def take_hidden(arm: Arm, asked: Asked, some: Index, limits: bool, out: list[Answer]) -> None:
    """Adds rows that take some of the poses, next to rows of the closed form that take none behind a joint
    that it left free: where it left two and the pose leaves one, their values have to go together."""
    which, q = _hidden_rows(arm, asked, some)
    if not len(which):
        return
    rows = descended(arm, asked.T[which], q, limits)
    for i, found in zip(which.tolist(), _led_to_or_along(arm, asked.at(which), rows)):
        out[i].real = out[i].real or bool(found)
        _add_inside(arm, asked, i, found, limits, out)


def _hidden_rows(arm: Arm, asked: Asked, some: Index) -> tuple[Index, Array]:
    """Whose they are (k,), and the rows (k, dof): of each branch with the value whose pose is nearest."""
    each = arm.policy.tries
    poses = asked.at(np.repeat(some, each))
    start = poses.starts(arm, np.tile(range(each), len(some)) * arm.policy.try_step)
    closed = closed_form(arm, poses.T, start, poses.held)
    hidden = closed.singular & ~closed.valid & np.isfinite(closed.q).all(axis=2)
    k, lane = np.nonzero(hidden)
    costs = np.full(hidden.shape, np.inf)
    costs[k, lane] = chord_costs(arm, poses.T[k], closed.q[k, lane])
    q = closed.q.reshape(len(some), each, *closed.q.shape[1:])
    cost = costs.reshape(len(some), each, -1)
    pose, lane = np.nonzero(np.isfinite(cost).any(axis=1))
    return some[pose], q[pose, cost.argmin(axis=1)[pose, lane], lane]


def take_nearest(arm: Arm, asked: Asked, some: Index, limits: bool, out: list[Answer]) -> None:
    """Adds rows that take some of the poses, inside the limits if one of these was found."""
    for inside, flat in product(dict.fromkeys((limits, False)), (False, True)):
        left = asked.at(some)
        rows = nearest_rows(arm, left.T, left.starts(arm), inside, flat)
        for i, found in zip(some.tolist(), _led_to_or_along(arm, left, rows)):
            out[i].real = out[i].real or bool(found)
            out[i].rows = _inside(arm, asked, i, found, limits)
        some = some[[not out[i].rows for i in some.tolist()]]
        if not len(some):
            break


def take_along(arm: Arm, asked: Asked, limits: bool, out: list[Answer]) -> None:
    """Adds to answers rows inside the limits of the continua that rows outside are of, if none stands for
    them: on a curve through these, or else, as a surface has many, where steps from them lead."""
    outside = [_outside(arm, one, asked.seed(i), limits) for i, one in enumerate(out)]
    beyond = [(i, row) for i, rows in enumerate(outside) for row in rows]
    if not beyond:
        return
    whose, q = np.array([i for i, _ in beyond]), np.array([row for _, row in beyond])
    stands = [(k, row) for k, i in enumerate(whose) for row, flag in out[i].rows if flag]
    for k, row in zip(*rows_along(arm, q, asked.aim(arm, whose), stands)):
        _add_inside(arm, asked, whose[k], [(tuple(row.tolist()), True)], limits, out)
    lost = np.array([not out[i].stands for i in whose])
    if lost.any():
        some = asked.at(whose[lost])
        rows = descended(arm, some.T, turned_inside(arm, q[lost]), limits)
        for i, found in zip(whose[lost], _led_to_or_along(arm, some, rows)):
            if not out[i].stands:
                _add_inside(arm, asked, i, found, limits, out)


def _outside(arm: Arm, answer: Answer, near: Row | None, limits: bool) -> list[Row]:
    """Its rows of continua outside the limits; where it has others, such as are singular to round-off."""
    rows = [row for row, _ in answer.loose if not place_rows(arm, [(row, True)], near, limits)]
    if not (rows and answer.rows):
        return rows
    sigma = smallest_singular_values(arm.chain, arm.task, arm.moving, np.array(rows))
    return [row for row, x in zip(rows, sigma.tolist()) if x < arm.policy.singular_below]


def _add_inside(
    arm: Arm, asked: Asked, i: int, found: list[Found], limits: bool, out: list[Answer]
) -> None:
    aim = asked.aim(arm, slice(i, i + 1))
    add_new(arm, aim[0], _inside(arm, asked, i, found, limits), out[i].rows)


def _inside(arm: Arm, asked: Asked, i: int, found: list[Found], limits: bool) -> list[Found]:
    """What of the rows of a pose is inside the limits."""
    aim = asked.aim(arm, slice(i, i + 1))
    return rows_inside(arm, aim, found, asked.seed(i), limits)


def _led_to_or_along(arm: Arm, asked: Asked, rows: Array) -> list[list[Found]]:
    """What Newton steps from each pose's row lead to, or else the solutions on a curve through it that
    is a continuum of the arm's but for a little that is left, or what undamped steps lead to; where the
    closed form is an elimination these first, as rows are nearer then."""
    led = led_to(arm, asked, rows)
    for find in (_flat, _along) if arm.branches is None else (_along, _flat):
        some = np.flatnonzero([not one for one in led])
        if not len(some):
            break
        for k, found in zip(some.tolist(), find(arm, asked.at(some), rows[some])):
            led[k] = found
    return led


def _along(arm: Arm, asked: Asked, rows: Array) -> list[list[Found]]:
    """The solutions on curves through each pose's row."""
    found: list[list[Found]] = [[] for _ in rows]
    broken = np.ones(len(rows), dtype=bool)
    _, owner, q, sigma = rows_around(arm, rows, asked.aim(arm), broken)
    flags = (sigma < arm.policy.continuum_below).tolist()
    for k, row in zip(owner.tolist(), zip(map(tuple, q.tolist()), flags)):
        found[k].append(row)
    return found


def _flat(arm: Arm, asked: Asked, rows: Array) -> list[list[Found]]:
    """What undamped steps from each pose's row lead to."""
    found: list[list[Found]] = [[] for _ in rows]
    there, error = flat_steps(arm.chain, arm.task, arm.moving, rows, asked.aim(arm))
    some = np.flatnonzero(error < arm.policy.arrived)
    for k, led in zip(some.tolist(), led_to(arm, asked.at(some), there[some])):
        found[k] = led
    return found
