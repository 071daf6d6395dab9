"""All solutions of one pose."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arguments.joint_arguments import held_values, seed_values
from ikgen.runtime.python.arguments.pose_arguments import one_pose
from ikgen.runtime.python.arguments.pose_faults import nearest_pose, pose_fault, too_far
from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.arm.held_parameters import aims, held_of
from ikgen.runtime.python.arm.solved_arm import Arm, FormRow, Found, Together
from ikgen.runtime.python.arrays.array_types import Array, Row
from ikgen.runtime.python.newton.arm_newton import refined
from ikgen.runtime.python.newton.chord_steps import chord_steps
from ikgen.runtime.python.newton.refinement import steeper
from ikgen.runtime.python.rows.row_branches import branch_names
from ikgen.runtime.python.rows.row_links import differences
from ikgen.runtime.python.rows.row_placement import (
    apart,
    in_order,
    is_new,
    place_rows,
    rows_at_limits,
)
from ikgen.runtime.python.rows.solutions import Solutions, Status, no_solutions
from ikgen.runtime.python.solving.asked_poses import Answer, Asked
from ikgen.runtime.python.solving.closed_form_rows import all_rows, careful
from ikgen.runtime.python.solving.compensated_rows import compensated_rows
from ikgen.runtime.python.solving.doubtful_poses import placed_rows
from ikgen.runtime.python.solving.doubtful_rows import seeded_rows
from ikgen.runtime.python.solving.projection import nearest_row, off_by

__all__ = ["One", "eliminated_answers", "held_reason", "solutions_of", "solve_pose", "sure_answer"]

# rad or m: a solution of the projected pose this near to the projected row is that row; the minimum is
# flat, so the search stops that far off
_SETTLED = 1e-4

One = tuple[list[list[float]], Row | None, Row]
"""A pose, its seed if there is one, and values of held joints."""


def solve_pose(
    arm: Arm,
    pose: Any,
    free: Sequence[float] | Mapping[str, float] | None,
    seed: ArrayLike | None,
    limits: bool,
    project: bool = False,
    orthonormalize: bool = False,
) -> Solutions:
    """All joint values that bring the tip to `pose`, or with `project` to the nearest pose that the arm
    can take; raises ValueError for bad arguments."""
    lines = one_pose(pose, arm.task.alone).tolist()
    near = seed_values(arm, seed)
    held = held_values(arm, free, near)
    if orthonormalize:
        lines = nearest_pose(arm.task, lines, arm.policy)
    T = arm.task.read(lines, arm.policy)
    if T is None:
        if too_far(arm.task, np.array([lines]), arm.policy)[0]:
            return no_solutions(len(arm.lower), Status.UNREACHABLE, held_reason(arm, held, False))
        reason = pose_fault(arm.task, lines, arm.policy)
        return no_solutions(len(arm.lower), Status.INVALID, reason)
    asked = T, near, held
    return solutions_of(arm, asked, limits, _fitting(arm, asked, limits), project)


def solutions_of(
    arm: Arm, asked: One, limits: bool, answer: Answer, project: bool = False
) -> Solutions:
    """The answer in order, or why there is none; to a pose nearby where it is to `project`."""
    T, near, held = asked
    found = answer.rows
    if project and not found:
        found = _projected(arm, asked, limits, answer)
    if not found:
        status = Status.LIMITS if answer.real else Status.UNREACHABLE
        return no_solutions(len(arm.lower), status, held_reason(arm, held, answer.real))
    found = in_order(arm, found, near)
    q = np.array([row for row, _ in found]) + 0.0
    flags = np.array([flag for _, flag in found], dtype=bool)
    off = off_by(arm.task, forward(arm.chain, q), np.array(T)) if project else None
    names = partial(branch_names, arm)
    return Solutions(q, Status.OK, flags, names=names, projected=off)


def held_reason(arm: Arm, held: Row, real: bool) -> str:
    """What holding joints has to do with it; nothing where none is held."""
    if not held:
        return ""
    values = ", ".join(f"{name} = {x:.6g}" for name, x in zip(arm.free_joints, held))
    what = "all solutions are outside the limits" if real else "no solution"
    tells = (
        "self_motion(pose) has the values that do" if len(held) == 1 else "search(pose) tries them"
    )
    return f"{what} with {values} held; other values may reach the pose: {tells}"


def _projected(arm: Arm, asked: One, limits: bool, answer: Answer) -> list[Found]:
    """Solutions of the nearest pose that the arm can take, of one that is answered without rows."""
    T, near, _ = asked
    start = _asked(asked).starts(arm)[0]
    real = _fitting(arm, asked, False).rows if answer.real else []
    beyond = np.array([q for q, _ in real]).reshape(-1, len(start))
    row = nearest_row(arm, np.array(T), tuple(start.tolist()), limits, beyond)
    pose: list[list[float]] = forward(arm.chain, row).tolist()
    nearest = pose, near, tuple(held_of(arm, np.array(row)).tolist())
    found = _fitting(arm, nearest, limits).rows
    rows = np.array([q for q, _ in found]).reshape(-1, len(row))
    new = np.abs(differences(arm, rows, np.array(row))).max(axis=1) > _SETTLED
    if len(found) < arm.most and new.all():
        found += place_rows(arm, [(row, False)], near, limits)
    return found


def _asked(asked: One) -> Asked:
    T, near, held = asked
    return Asked(np.array([T]), None if near is None else np.array([near]), np.array([held]))


def _fitting(arm: Arm, asked: One, limits: bool) -> Answer:
    if arm.branches is None:
        return eliminated_answers(arm, _asked(asked), limits)[0]
    sure = sure_answer(arm, asked, limits) or _compensated_answer(arm, asked, limits)
    return placed_rows(arm, _asked(asked), limits)[0] if sure is None else sure


def eliminated_answers(arm: Arm, asked: Asked, limits: bool) -> list[Answer]:
    """From an elimination of each pose; where that leaves doubts, they are settled from the same rows."""
    closed = all_rows(arm, asked.T, asked.near, asked.held)
    q, valid, doubt = careful(arm, closed, asked.T, asked.held)
    out: list[Answer | None] = [None] * len(q)
    for k in np.flatnonzero(~doubt).tolist():
        one = asked.T[k].tolist(), asked.seed(k), tuple(asked.held[k].tolist())
        kept = [(tuple(row), False) for row in q[k, valid[k]].tolist()]
        out[k] = _placed_answer(arm, one, kept, limits)
    left = np.array([k for k, answer in enumerate(out) if answer is None], dtype=np.intp)
    some = replace(asked, closed=closed).at(left)
    settled = iter(placed_rows(arm, some, limits) if len(left) else ())
    return [next(settled) if answer is None else answer for answer in out]


def sure_answer(arm: Arm, asked: One, limits: bool) -> Answer | None:
    """From the closed form on floats, where that leaves no doubt."""
    kept = _certain_rows(arm, *asked)
    return None if kept is None else _placed_answer(arm, asked, kept, limits)


def _compensated_answer(arm: Arm, asked: One, limits: bool) -> Answer | None:
    """From compensated poses of a rounded arm, where that leaves no doubt."""
    if not arm.rounded:
        return None
    one = _asked(asked)
    q, found, sure = compensated_rows(arm, one.T, one.held)
    kept = [(tuple(row), False) for row in q[0, found[0]].tolist()]
    return _placed_answer(arm, asked, kept, limits) if sure[0] else None


def _placed_answer(arm: Arm, asked: One, kept: list[Found], limits: bool) -> Answer | None:
    """From distinct rows, where none of them is close to a limit."""
    near = asked[1]
    placed, close = rows_at_limits(arm, kept, near, limits)
    if close:
        return None
    if near is not None and not placed:
        placed = place_rows(arm, seeded_rows(arm, _asked(asked))[0], near, limits)
    return Answer(placed, bool(kept))


def _certain_rows(
    arm: Arm, T: list[list[float]], near: Row | None, held: Row
) -> list[Found] | None:
    """Distinct rows, refined where they need it, those of a rounded arm all at once; None where that leaves
    a doubt."""
    assert arm.branches is not None
    start = list(near) if near is not None else [0.0] * len(arm.lower)
    for j, value in zip(arm.free, held):
        start[j] = value
    answers, doubt = arm.branches(T, tuple(start), held)
    if doubt:
        return None
    rows: list[Row] = [row for row, _ in answers]
    if arm.together is None and any(rough for _, rough in answers):
        regular = _regular_rows(arm, answers, (T, near, held))
        if regular is None:
            return None
        rows = regular
    if arm.together is not None and not rows:
        beside: list[list[list[float]]] = (
            (np.array(T) @ arm.beside).tolist() if arm.policy.beside_anywhere else []
        )
        return None if any(arm.branches(pose, tuple(start), held)[0] for pose in beside) else []
    if arm.together is not None:
        q = _refined_together(arm, arm.together, np.array(rows), (T, near, held))
        if q is None:
            return None
        if apart(arm, q):
            return [(tuple(row), False) for row in q.tolist()]
        rows = list(map(tuple, q.tolist()))
    kept: list[Found] = []
    for row in rows:
        if is_new(arm, row, kept):
            kept.append((row, False))
        elif arm.rounded:  # another may lie there
            return None
    return kept


def _refined_together(arm: Arm, together: Together, q: Array, asked: One) -> Array | None:
    """Rows (k, dof) refined all at once, without those that miss the pose; None where that leaves a
    doubt."""
    T = np.array(asked[0])
    if arm.square:
        ends = chord_steps(arm, q, T)
        if ends is not None:
            return ends
    q, arrived, missed = together(arm, q, aims(arm, T[None], np.array([asked[2]])))
    return q[arrived] if (arrived | missed).all() else None


def _regular_rows(arm: Arm, answers: list[FormRow], asked: One) -> list[Row] | None:
    """Rows of which those that are rough are refined, each for as long as it takes; None where one of these
    is near a singularity."""
    T, _, held = asked
    rough = [row for row, flag in answers if flag]
    aim = aims(arm, np.array([T] * len(rough)), np.array([held] * len(rough)))
    q, error, _, slope = refined(arm, np.array(rough), aim)
    if not steeper(slope, arm.policy.fold_reach).all():
        return None
    ends = iter(zip(q.tolist(), (error < arm.policy.arrived).tolist()))
    rows = []
    for row, flag in answers:
        end, arrived = next(ends) if flag else (row, True)
        if arrived:
            rows.append(tuple(end))
    return rows
