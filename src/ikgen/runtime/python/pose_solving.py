"""All solutions of one pose, the closed form's inner loop on floats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.array_types import Array, Row
from ikgen.runtime.python.chain_kinematics import forward
from ikgen.runtime.python.held_parameters import aims, held_of, row_rank_loss
from ikgen.runtime.python.joint_arguments import held_values, seed_values
from ikgen.runtime.python.meeting_rows import Starts, repeats, rows_nearby
from ikgen.runtime.python.pose_arguments import one_pose
from ikgen.runtime.python.pose_faults import nearest_pose, pose_fault
from ikgen.runtime.python.projection import nearest_row, off_by
from ikgen.runtime.python.row_branches import branch_names
from ikgen.runtime.python.row_placement import is_new, place_rows
from ikgen.runtime.python.solutions import Solutions, Status, no_solutions
from ikgen.runtime.python.solved_arm import Arm, Candidate, Found, Together

__all__ = ["solve_pose"]


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
    found, real = ([], False) if T is None else _fitting(arm, T, near, held, limits)
    if project and T is not None and not found:
        found = _projected(arm, T, near, held, limits)
    if not found:
        if T is None:
            reason = pose_fault(arm.task, lines, arm.policy)
            return no_solutions(len(arm.lower), Status.INVALID, reason)
        status = Status.LIMITS if real else Status.UNREACHABLE
        return no_solutions(len(arm.lower), status, _held_reason(arm, held, real))
    if near is not None:
        origin = near
        found.sort(key=lambda item: sum((a - b) * (a - b) for a, b in zip(item[0], origin)))
    found = found[: arm.most]
    q = np.array([row for row, _ in found]) + 0.0
    flags = np.array([flag for _, flag in found], dtype=bool)
    off = off_by(arm.task, forward(arm.chain, q), np.array(T)) if project else None
    names = partial(branch_names, arm)
    return Solutions(q, Status.OK, flags, names=names, projected=off)


def _held_reason(arm: Arm, held: Row, real: bool) -> str:
    """What holding joints has to do with it; nothing where none is held."""
    if not held:
        return ""
    values = ", ".join(f"{name} = {x:.6g}" for name, x in zip(arm.free_joints, held))
    what = "all solutions are outside the limits" if real else "no solution"
    tells = (
        "self_motion(pose) has the values that do" if len(held) == 1 else "search(pose) tries them"
    )
    return f"{what} with {values} held; other values may reach the pose: {tells}"


def _projected(
    arm: Arm, T: list[list[float]], near: Row | None, held: Row, limits: bool
) -> list[Found]:
    """Solutions of the nearest pose that the arm can take."""
    row = nearest_row(arm, np.array(T), _start(arm, near, held, 0.0), limits)
    pose: list[list[float]] = forward(arm.chain, row).tolist()
    held = tuple(held_of(arm, np.array(row)).tolist())
    found, _ = _fitting(arm, pose, near, held, limits)
    if len(found) < arm.most and is_new(arm, row, found):
        found += place_rows(arm, [(row, False)], near, limits)
    return found


class _Rows(NamedTuple):
    """Distinct solutions, whether the pose left a joint free, and the closed form led anywhere then."""

    kept: list[Found]
    free: bool
    led: bool


def _fitting(
    arm: Arm, T: list[list[float]], near: Row | None, held: Row, limits: bool
) -> tuple[list[Found], bool]:
    """Solutions on the right turns, and whether there were any before limits.

    Where the pose leaves a joint free and its given value leads nowhere, other values are tried.
    """
    out: list[Found] = []
    real = False
    for tries in (range(1), range(1, arm.policy.tries)):
        starts = [_start(arm, near, held, n * arm.policy.try_step) for n in tries]
        for start, rows in zip(starts, _rows(arm, T, starts, held)):
            if near is not None and not rows.free and any(flag for _, flag in rows.kept):
                _add(arm, T, _from_seed(arm, T, start, held), rows.kept)
            real = real or bool(rows.kept)
            placed = place_rows(arm, rows.kept, near, limits)
            if out:
                _add(arm, T, placed, out)
            else:
                out = placed
            if not out and near is not None:
                out = place_rows(arm, _from_seed(arm, T, start, held), near, limits)
            if not rows.free:
                return out, real
            if out and (rows.led if arm.rounded else any(flag for _, flag in out)):
                return out, real
    return out, real


def _from_seed(arm: Arm, T: list[list[float]], start: Row, held: Row) -> list[Found]:
    """What Newton steps from given values lead to."""
    return [row for _, row in _refined(arm, [(start, True)], T, held, [-1])[0]]


def _add(arm: Arm, T: list[list[float]], rows: list[Found], kept: list[Found]) -> None:
    """Adds those of the rows that differ from all that are there."""
    for row, singular in rows:
        if is_new(arm, row, kept) and not (singular and repeats(arm, T, row, kept)):
            kept.append((row, singular))


def _start(arm: Arm, near: Row | None, held: Row, turn: float) -> Row:
    """Values for joints that the pose leaves free, those of revolute ones turned; held ones as they are."""
    q = list(near) if near is not None else [0.0] * len(arm.lower)
    if turn:
        q = [x + turn if revolute else x for x, revolute in zip(q, arm.chain.revolute)]
    for j, value in zip(arm.free, held):
        q[j] = value
    return tuple(q)


def _rows(arm: Arm, T: list[list[float]], starts: list[Row], held: Row) -> list[_Rows]:
    """For each start, the solutions (radians between -pi and pi).

    Newton steps are taken by all rough rows together: their price is that of the calls.
    """
    kept: list[list[Found]] = [[] for _ in starts]
    fine: list[tuple[int, Found]] = []
    given: list[tuple[int, Found]] = []
    rough: list[tuple[int, Found]] = []
    free, led = [], []
    for i, q0 in enumerate(starts):
        answers, hit = arm.branches(T, q0, held)
        if arm.together and len(starts) == 1 and not hit:
            certain = _certain_rows(arm, arm.together, answers, T, held)
            if certain is not None:
                return [_Rows(certain, False, False)]
        free.append(hit)
        led.append(hit and any(flag for _, flag, _ in answers))
        if hit:
            given.append((i, (q0, True)))
        for row, flag, bent in answers:
            (rough if bent else fine).append((i, (row, flag)))
    stepped = given + rough
    own = [row for _, row in stepped]
    source = [-1] * len(given) + [0] * len(rough)
    beside: list[Found] = []
    looks = len(starts) == 1 and len(arm.beside) > 0
    if looks and (free[0] or arm.policy.beside_reach >= arm.policy.anywhere):
        beside = _rows_beside(arm, T, starts[0], held)
    steps, close = _refined(arm, own + beside, T, held, source + [1] * len(beside))
    if close and looks and not beside:
        beside = _rows_beside(arm, T, starts[0], held)
        steps, _ = _refined(arm, own + beside, T, held, source + [1] * len(beside))
    stepped += [(0, row) for row in beside]
    for i, (row, singular) in [(stepped[k][0], found) for k, found in steps] + fine:
        if is_new(arm, row, kept[i]) and not (singular and repeats(arm, T, row, kept[i])):
            kept[i].append((row, singular))
    return [_Rows(*item) for item in zip(kept, free, led)]


def _rows_beside(arm: Arm, T: list[list[float]], start: Row, held: Row) -> list[Found]:
    """The closed form's rows of poses beside."""
    poses: list[list[list[float]]] = (np.array(T) @ arm.beside).tolist()
    return [(row, False) for pose in poses for row, _, _ in arm.branches(pose, start, held)[0]]


def _certain_rows(
    arm: Arm, together: Together, answers: list[Candidate], T: list[list[float]], held: Row
) -> list[Found] | None:
    """The rows refined all at once; None where that leaves a doubt."""
    if not answers or any(flag for _, flag, _ in answers):
        anywhere = arm.policy.beside_reach >= arm.policy.anywhere
        return None if answers or anywhere else []
    start = np.array([row for row, _, _ in answers])
    q, arrived, missed = together(arm, start, _aim(arm, T, held))
    if not (arrived | missed).all():
        return None
    kept: list[Found] = []
    for row in q[arrived].tolist():
        if not is_new(arm, row, kept):  # another may lie there
            return None
        kept.append((tuple(row), False))
    return kept


def _aim(arm: Arm, T: list[list[float]], held: Row) -> Array:
    """The pose and what is held: (1, ...)."""
    return aims(arm, np.array([T]), np.array([held]))


def _refined(
    arm: Arm, rows: list[Found], T: list[list[float]], held: Row, source: list[int]
) -> tuple[list[tuple[int, Found]], bool]:
    """What Newton steps from the rows lead to, with the row's number: one solution, those that meet near a
    singularity, or none; and whether others may start from none. source (k,) as in `Starts`."""
    if not rows:
        return [], False
    target = np.repeat(_aim(arm, T, held), len(rows), axis=0)
    start, marked = np.array([row for row, _ in rows]), np.array([flag for _, flag in rows])
    starts = Starts(start, target, np.zeros(len(rows), dtype=np.intp), marked, np.array(source))
    owner, q, close = rows_nearby(arm, starts)
    loss = row_rank_loss(arm, q)
    flat, continuum = arm.policy.rank_loss, arm.policy.continuum_rank_loss
    singular = (marked[owner] & (loss < continuum)) | (loss < flat)
    found = zip(owner.tolist(), q.tolist(), singular.tolist())
    return [(i, (tuple(row), flag)) for i, row, flag in found], bool(close.any())
