"""Many poses solved as each is alone, those near singularities in stacks."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ikgen.runtime.python.arguments.joint_arguments import held_rows, seed_rows
from ikgen.runtime.python.arguments.pose_faults import too_far
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Row
from ikgen.runtime.python.rows.solutions import Solutions, Status, no_solutions
from ikgen.runtime.python.solving.asked_poses import Answer, Asked
from ikgen.runtime.python.solving.doubtful_poses import placed_rows
from ikgen.runtime.python.solving.pose_solving import (
    One,
    eliminated_answers,
    solutions_of,
    sure_answer,
)

__all__ = ["solve_each"]

_STACK = 512  # poses
_Stage = Callable[[Arm, Asked, bool], Sequence[Answer | None]]


def solve_each(
    arm: Arm, poses: Array, free: Array | None, seed: Array | None, limits: bool
) -> list[Solutions]:
    """What each of the poses (N, 4, 4) alone is answered with, with `free` (N, held joints) and seeds (N,
    dof): poses that leave doubts are stacks of more than one. Verification asks so."""
    near = None if seed is None else seed_rows(arm, seed, seed.shape)
    held = held_rows(arm, free, near, len(poses))
    out = [no_solutions(len(arm.lower), Status.INVALID) for _ in poses]
    asked: dict[int, One] = {}
    for i, pose in enumerate(poses):
        T = arm.task.read(pose.tolist(), arm.policy)
        if T is not None:
            seeds = None if near is None else tuple(near[i].tolist())
            asked[i] = T, seeds, tuple(held[i].tolist())
        elif too_far(arm.task, pose[None], arm.policy)[0]:
            out[i] = no_solutions(len(arm.lower), Status.UNREACHABLE)
    answers: dict[int, Answer] = {}
    stages: tuple[_Stage, ...] = (_sure_answers, placed_rows)
    for solve in stages if arm.branches is not None else (eliminated_answers,):
        left = [i for i in asked if i not in answers]
        for start in range(0, len(left), _STACK):
            some = left[start : start + _STACK]
            given = np.array([asked[i][0] for i in some])
            stack = Asked(given, None if near is None else near[some], held[some])
            found = zip(some, solve(arm, stack, limits))
            answers |= {i: answer for i, answer in found if answer is not None}
    for i, answer in answers.items():
        out[i] = solutions_of(arm, asked[i], limits, answer)
    return out


def _sure_answers(arm: Arm, asked: Asked, limits: bool) -> list[Answer | None]:
    """`sure_answer` of each pose."""
    near: list[Row | None] = [asked.seed(k) for k in range(len(asked.T))]
    each = zip(asked.T.tolist(), near, map(tuple, asked.held.tolist()))
    return [sure_answer(arm, one, limits) for one in each]
