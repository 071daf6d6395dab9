"""The emitted routine itself, for probing: the same code that goes into generated modules."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ikgen.elimination.loop_frames import over
from ikgen.model.arrays import Array
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arrays.array_types import Flags
from ikgen.runtime.python.elimination.general_6r import (
    DIRECT,
    Elimination,
    Plan,
    enough_alone,
    refined_rows,
    six_joint_rows,
)
from ikgen.runtime.python.elimination.six_joints import six_joints
from ikgen.runtime.python.rows.solution_rows import Turning, exact_first

__all__ = [
    "Elimination",
    "FirstRun",
    "Plan",
    "Turning",
    "first_runs",
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


class FirstRun(NamedTuple):
    """What an elimination finds alone: the `rows` (k, 6) of each of N poses, the pose errors (m,) of the
    candidates that became them, `before` Newton's method, which say how well conditioned it is, and for
    which poses (N,) that is `enough`, so that no other run follows."""

    rows: list[Array]
    before: Array
    enough: Flags

    @property
    def often_enough(self) -> float:
        """At what share of the first half of the poses it is enough: the others may be next to
        singularities, where rounding decides. None of no poses."""
        first = self.enough[: (len(self.enough) + 1) // 2]
        return float(first.mean()) if len(first) else 0.0


def first_runs(frames: Array, plans: Sequence[Plan], poses: Array) -> list[FirstRun]:
    """The first elimination of each plan at poses (N, 4, 4), lengths over the plan's. The plans are of one
    arm: all their candidates are refined together."""
    policy, plan = runtime_policy(SolvePolicy()), plans[0]
    six, T = six_joints(frames, plan.length, plan.axes), over(poses, plan.length)
    found = [one.find(six.frames, T, one.eliminations[0], one.turning) for one in plans]
    index, q = (np.concatenate([one[k] for one in found]) for k in (0, 1))
    if not len(q):
        none = np.zeros(len(poses), dtype=bool)
        return [FirstRun([np.zeros((0, 6)) for _ in poses], np.zeros(0), none) for _ in plans]
    rows, error, before = refined_rows(six, plan, index, T[index], q, policy)
    out, end = [], 0
    for of, _, real, clear in found:
        start, end = end, end + len(of)
        good = start + np.flatnonzero(error[start:end] < policy.arrived)
        exact = before[good] < DIRECT
        distinct, pose, exact = exact_first(
            rows[good], index[good], exact, plan.turning, policy.coincident
        )
        count, direct = (np.bincount(k, minlength=len(poses)) for k in (pose, pose[exact]))
        enough = enough_alone(real, clear, count, direct)
        out.append(FirstRun(_by_pose(distinct, pose, len(poses)), before[good], enough))
    return out
