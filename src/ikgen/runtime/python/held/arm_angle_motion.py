"""Intervals of the arm angle in closed form from the joint limits (Shimizu et al. 2008).

What the shoulder's joints carry turns with the arm angle about the line from shoulder to wrist: a joint is
on a limit where an axis that turns so makes a given angle with one that stays, at no more than two arm
angles.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import acos, atan2, hypot, pi
from typing import Any

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import cross, joint_axes
from ikgen.runtime.python.arm.limit_margins import bounded_joints, outside
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.held.held_joint import HeldJoint, Rows, pose_lines, rows_at
from ikgen.runtime.python.held.self_motion import Interval, self_motion_of

__all__ = ["arm_angle_motion_of"]

_ELBOW = 3
_STRETCHED = 1e-4  # distance of the elbow from the line, over the upper arm
_ALIGNED = 1e-9  # 1 less the cosine between the outer axes of shoulder or wrist


def arm_angle_motion_of(joint: HeldJoint, pose: Any, limits: bool) -> tuple[Interval, ...]:
    """The intervals of a pose (4, 4), by branch and value; none for what is no pose. Of a rounded arm, and
    where joints come to a singularity on the way, by samples."""
    T = pose_lines(joint.arm, pose)
    if T is None:
        return ()
    found = None if joint.arm.rounded else _from_limits(joint, T, limits)
    return self_motion_of(joint, pose, limits) if found is None else found


def _from_limits(joint: HeldJoint, T: Array, limits: bool) -> tuple[Interval, ...] | None:
    arm, ends = joint.arm, [-pi, pi]
    start = rows_at(joint, T, np.zeros(1))
    rows = start.q[0][start.real[0]]
    _, first = np.unique(np.round(rows[:, _ELBOW], 6), return_index=True)
    for q in rows[first]:
        more = _ends(arm, T, q, limits)
        if more is None:
            return None
        ends += more
    cuts = np.unique(ends)
    middle = 0.5 * (cuts[1:] + cuts[:-1])[np.diff(cuts) > 1e-12]
    return _runs(arm, rows_at(joint, T, middle), cuts, limits)


def _runs(arm: Arm, rows: Rows, cuts: Array, limits: bool) -> tuple[Interval, ...]:
    """Runs of cells between cuts in the middle of which a branch is inside."""
    inside = rows.real & (outside(arm, rows.q, limits) <= arm.policy.limit_tolerance)
    low = cuts[np.searchsorted(cuts, rows.held) - 1]
    found = []
    for branch in range(inside.shape[1]):
        change = np.diff(inside[:, branch].astype(int), prepend=0, append=0)
        limits_of = np.append(low, cuts[-1])
        pairs = zip(limits_of[change == 1].tolist(), limits_of[change == -1].tolist())
        found += [Interval(a, b, branch) for a, b in pairs]
    return tuple(found)


def _ends(arm: Arm, T: Array, q: Array, limits: bool) -> list[float] | None:
    """The arm angles at which a joint may be on a limit, from a row (dof,) at arm angle 0; None where
    joints come to a singularity."""
    assert arm.angle is not None
    x, y = arm.angle.plane(T)
    line, elbow = cross(x, y), arm.angle.beside_line(q, T)
    frames = joint_axes(arm.chain, q[None])[:-1, 0]
    axes = frames[:, :3, 2] * np.array([m[2] for m in arm.chain.motions])[:, None]
    outer = (_harmonic(line, axes[a], axes[b]) for a, b in ((0, 2), (6, 4)))
    if hypot(*elbow) < _STRETCHED * arm.angle.upper or any(
        hypot(a, b) + abs(c) > 1.0 - _ALIGNED for a, b, c in outer
    ):
        return None
    out: list[float] = []
    for j, middle, half, _ in bounded_joints(arm) if limits else ():
        if j != _ELBOW:
            for side in (-1.0, 1.0):
                limit = middle + side * (half + 0.5 * arm.policy.limit_tolerance)
                out += _roots(line, axes, j, limit - q[j])
    return out


def _harmonic(line: Array, n: Array, m: Array) -> tuple[float, float, float]:
    """`m` turned about the line, times `n`, is a cos + b sin + c of the arm angle."""
    c = float(n @ line) * float(m @ line)
    return float(n @ m) - c, float(n @ cross(line, m)), c


def _turned(about: Array, angle: float, v: Array) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(c * v + s * cross(about, v) + (1.0 - c) * (about @ v) * about)


def _roots(line: Array, axes: Array, j: int, by: float) -> Iterator[float]:
    """The arm angles at which joint j, moved by `by`, is on its limit."""
    middle, still, moving = (1, 0, 2) if j < _ELBOW else (5, 6, 4)
    by = by if j < _ELBOW else -by
    if j == middle:  # the outer axes make the angle that they make there
        wanted = axes[still] @ _turned(axes[j], by, axes[moving])
        n, m = axes[still], axes[moving]
    elif j == still:  # the middle axis stays, at its angle with the one that turns
        wanted = axes[middle] @ axes[moving]
        n, m = _turned(axes[j], by, axes[middle]), axes[moving]
    else:  # the middle axis turns with the arm, at its angle with the one that stays
        wanted = axes[middle] @ axes[still]
        n, m = axes[still], _turned(axes[j], -by, axes[middle])
    a, b, c = _harmonic(line, n, m)
    size = hypot(a, b)
    if abs(wanted - c) <= size and size > 0.0:
        half = acos((wanted - c) / size)
        for angle in (atan2(b, a) + half, atan2(b, a) - half):
            yield angle - 2.0 * pi * round(angle / (2.0 * pi))
