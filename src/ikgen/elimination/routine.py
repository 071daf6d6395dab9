"""The emitted routine itself, for probing: the same code that goes into generated modules."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from ikgen.elimination.loop_frames import over
from ikgen.model.arrays import Array
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.elimination.general_6r import (
    Elimination,
    Plan,
    refined_rows,
    six_joint_rows,
)
from ikgen.runtime.python.elimination.six_joints import six_joints
from ikgen.runtime.python.rows.solution_rows import Turning, distinct_rows

__all__ = [
    "Elimination",
    "Plan",
    "Turning",
    "initial_residuals",
    "runtime_policy",
    "six_joints_batch",
]


def runtime_policy(given: SolvePolicy) -> Policy:
    """The tolerances as the emitted code takes them."""
    stages = tuple((s.steps, s.fine, s.promising) for s in given.refinement)
    names = [field.name for field in fields(Policy) if field.name != "refinement"]
    return Policy(**{name: getattr(given, name) for name in names}, refinement=stages)


def six_joints_batch(frames: Array, plan: Plan, poses: Array) -> list[Array]:
    """All joint values (k, 6), angles in (-pi, pi], that reach each of the poses (N, 4, 4).

    frames (7, 4, 4): the chain as in `loop_frames.py`.
    """
    six = six_joints(frames, plan.length, plan.axes)
    pose, rows, _ = six_joint_rows(six, plan, poses, runtime_policy(SolvePolicy()))
    return _by_pose(rows, pose, len(poses))


def _by_pose(rows: Array, pose: NDArray[np.intp], count: int) -> list[Array]:
    """Rows (k, 6) of poses (k,) in order, those of each."""
    return np.split(rows, np.searchsorted(pose, np.arange(1, count))) if count else []


def initial_residuals(
    frames: Array, plans: Sequence[Plan], poses: Array
) -> list[tuple[list[Array], Array]]:
    """The first elimination's solutions by each plan for poses (N, 4, 4), lengths over the plan's, and the
    pose errors (m,) of those candidates that became solutions, before Newton's method: how well conditioned
    the elimination is. The plans are of one arm: all their candidates are refined together."""
    policy, plan = runtime_policy(SolvePolicy()), plans[0]
    six, T = six_joints(frames, plan.length, plan.axes), over(poses, plan.length)
    found = [one.find(six.frames, T, one.eliminations[0], one.turning)[:2] for one in plans]
    ends = np.cumsum([len(index) for index, _ in found])[:-1]
    index, q = map(np.concatenate, zip(*found, strict=True))
    if not len(q):
        return [([np.zeros((0, 6)) for _ in poses], np.zeros(0)) for _ in plans]
    refined = refined_rows(six, plan, index, T[index], q, policy)
    out = []
    for pose, *part in zip(*(np.split(x, ends) for x in (index, *refined)), strict=True):
        good = part[1] < policy.arrived
        rows, pose, _ = distinct_rows(part[0][good], pose[good], plan.turning, policy.coincident)
        out.append((_by_pose(rows, pose, len(poses)), part[2][good]))
    return out
