"""The emitted routine itself, for probing: the same code that goes into generated modules."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from ikgen.model.joint_tree import Matrix
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python import general_6r as runtime
from ikgen.runtime.python.general_6r import Elimination
from ikgen.runtime.python.solve_policy import Policy

__all__ = ["Elimination", "general_6r", "general_6r_batch", "initial_residuals", "runtime_policy"]


def runtime_policy(given: SolvePolicy) -> Policy:
    """The tolerances as the emitted code takes them."""
    stages = tuple((s.steps, s.fine, s.promising) for s in given.refinement)
    names = [field.name for field in fields(Policy) if field.name != "refinement"]
    return Policy(**{name: getattr(given, name) for name in names}, refinement=stages)


def general_6r_batch(
    frames: Matrix, length: float, plans: Sequence[Elimination], poses: Matrix
) -> list[Matrix]:
    """All joint angles (k, 6) in (-pi, pi] that reach each of the poses (N, 4, 4).

    frames (7, 4, 4): the chain as in `frames.py`; length (m): its scale; plans in order of
    preference.
    """
    return runtime.general_6r(frames, length, tuple(plans), poses, runtime_policy(SolvePolicy()))


def general_6r(frames: Matrix, length: float, plans: Sequence[Elimination], pose: Matrix) -> Matrix:
    """`general_6r_batch` for one pose (4, 4)."""
    return general_6r_batch(frames, length, plans, np.asarray(pose, dtype=np.float64)[None])[0]


def initial_residuals(
    frames: Matrix, length: float, plan: Elimination, poses: Matrix
) -> tuple[list[Matrix], Matrix]:
    """One plan's solutions for poses (N, 4, 4), and the pose errors (m,) of those candidates that
    became solutions, before Newton's method: how well conditioned the elimination is."""
    policy = runtime_policy(SolvePolicy())
    F, T = frames.copy(), poses.copy()
    F[:, :3, 3] /= length
    T[:, :3, 3] /= length
    index, q, *_ = runtime.candidates(F, T, plan)
    if not len(q):
        return [np.zeros((0, 6)) for _ in poses], np.zeros(0)
    q, good, before = runtime.refined_angles(F, T[index], q, policy)
    near = policy.coincident
    rows = [runtime.distinct_angles(q[good & (index == i)], near) for i in range(len(poses))]
    return rows, before[good]
