"""Many poses solved as each is alone, those near singularities in stacks."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.array_types import Array
from ikgen.runtime.python.doubtful_poses import Asked, placed_rows
from ikgen.runtime.python.joint_arguments import held_rows, seed_rows
from ikgen.runtime.python.pose_solving import One, solutions_of, sure_answer
from ikgen.runtime.python.solutions import Solutions, Status, no_solutions
from ikgen.runtime.python.solved_arm import Arm

__all__ = ["solve_each"]

_STACK = 512  # poses


def solve_each(
    arm: Arm, poses: Array, free: Array | None, seed: Array | None, limits: bool
) -> list[Solutions]:
    """What `solve_pose` gives for each of the poses (N, 4, 4), with `free` (N, held joints) and seeds
    (N, dof): poses that leave doubts are stacks of more than one."""
    near = None if seed is None else seed_rows(arm, seed, seed.shape)
    held = held_rows(arm, free, near, len(poses))
    out = [no_solutions(len(arm.lower), Status.INVALID) for _ in poses]
    doubts: list[tuple[int, One]] = []
    for i, pose in enumerate(poses):
        T = arm.task.read(pose.tolist(), arm.policy)
        if T is None:
            continue
        asked = T, None if near is None else tuple(near[i].tolist()), tuple(held[i].tolist())
        sure = sure_answer(arm, asked, limits)
        if sure is None:
            doubts.append((i, asked))
        else:
            out[i] = solutions_of(arm, asked, limits, sure)
    for start in range(0, len(doubts), _STACK):
        part = doubts[start : start + _STACK]
        some = [i for i, _ in part]
        given = np.array([asked[0] for _, asked in part])
        stack = Asked(given, None if near is None else near[some], held[some])
        for (i, asked), answer in zip(part, placed_rows(arm, stack, limits)):
            out[i] = solutions_of(arm, asked, limits, answer)
    return out
