"""An elimination of six joints as the closed form of an arm, held joints merged into the chain."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Motion, forward
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.elimination.general_6r import Plan, six_joint_rows
from ikgen.runtime.python.elimination.six_joints import SixJoints, six_joints, with_tool_joint
from ikgen.runtime.python.newton.refinement import smallest_singular_values
from ikgen.runtime.python.rows.solution_rows import places

__all__ = ["elimination_lanes"]

_POSES = 256  # whose arrays fit into a processor's cache


def _six_joints(arm: Arm, plan: Plan, held: Array) -> SixJoints:
    """The joints that move, of the chain with the others `held` (N, c): at the cosine and sine of an angle,
    or at a distance, base to tip."""
    columns, moving = iter(held.T), iter(plan.axes)
    motions: list[Motion] = []
    values: list[Array] = []
    for joint, turns, _, _ in arm.chain.motions:
        if joint not in arm.free:
            motions.append(next(moving))
            continue
        motions.append((6 + len(values), turns, 1.0, 0.0))
        values.append(_value(columns, turns))
    at, frames = np.stack(values, axis=1) if values else None, arm.chain.frames
    if plan.tool is not None:
        frames = with_tool_joint(frames, plan.tool)
    return six_joints(frames, plan.length, (*motions, *moving), at)


def _value(columns: Iterator[Array], turns: bool) -> Array:
    """An angle of its cosine and sine, or a distance."""
    first = next(columns)
    return np.asarray(np.arctan2(next(columns), first)) if turns else first


def _regular_first(arm: Arm, angles: Array, held: Array, T: Array) -> Array:
    """At most `arm.most` rows of DH variables (k, 6) of the pose T (4, 4): where a continuum gives more,
    its samples go, but for those farthest from all that are kept, those right to round-off first."""
    if len(angles) <= arm.most:
        return angles
    q = np.empty((len(angles), len(arm.lower)))
    values, columns = iter(held), iter(angles.T)
    motions = arm.chain.motions
    for joint in range(len(arm.lower)):
        lead = min((m for m in motions if m[0] == joint), key=lambda m: abs(m[2]))
        value = next(columns) if joint not in arm.free else _value(values, lead[1])
        q[:, joint] = (value - lead[3]) / lead[2]
    sigma = smallest_singular_values(arm.chain, arm.task, arm.moving, q)
    off = np.abs(arm.task.error(forward(arm.chain, q), np.broadcast_to(T, (len(q), 4, 4))))
    exact = off.max(axis=1) < arm.policy.exact
    rank = (sigma < arm.policy.continuum_below) * (2 - exact)
    order = np.flatnonzero(rank == 0).tolist()
    for level in (1, 2):
        left = np.flatnonzero(rank == level)
        while len(left) and len(order) < arm.most:  # the farthest: none crowds out others
            gap = np.abs(angles[left, None] - angles[order])
            gap = np.minimum(gap, np.abs(2.0 * np.pi - gap)).max(axis=2)
            place = gap.min(axis=1, initial=np.inf).argmax()
            order.append(int(left[place]))
            left = np.delete(left, place)
    return np.asarray(angles[np.sort(order[: arm.most])])


def elimination_lanes(arm: Arm, plan: Plan, entries: tuple[Array, ...]) -> tuple[Array, ...]:
    """Cosine and sine of every moving joint's angle, and lengths of slides (most, N), for many poses, and
    which there are; those behind the last are NaN where it can't tell whether there are more.

    entries: the pose's first three rows, then cosines, sines and distances of held joints.
    """
    count = max(entry.size for entry in entries)
    columns = np.empty((len(entries), count))
    for column, entry in zip(columns, entries):
        column[:] = entry.reshape(-1)
    lanes = np.ones((6 + sum(plan.turning), arm.most, count))
    found = np.zeros((arm.most, count), dtype=bool)
    T = np.zeros((count, 4, 4))
    T[:, :3] = columns[:12].T.reshape(-1, 3, 4)
    T[:, 3, 3] = 1.0
    held = columns[12:].T
    alike = bool((held == held[:1]).all())
    for start in range(0, count, _POSES):
        part = slice(start, start + _POSES)
        pose, values, unsure = _rows_of_poses(arm, plan, T[part], held[:1] if alike else held[part])
        last = np.bincount(pose, minlength=len(unsure))
        open_ = np.flatnonzero(unsure & (last < arm.most))
        lanes[:, last[open_], start + open_] = np.nan
        place, member = places(pose), start + pose
        cosines, sines = np.cos(values.T), np.sin(values.T)
        rows = [
            row
            for j, turns in enumerate(plan.turning)
            for row in ((cosines[j], sines[j]) if turns else (values[:, j],))
        ]
        lanes[:, place, member] = rows
        found[place, member] = True
    return (*lanes, found)


def _rows_of_poses(arm: Arm, plan: Plan, T: Array, held: Array) -> tuple[Index, Array, Flags]:
    """Pose indices (k,) in order, and at most `arm.most` rows (k, 6) for each of the poses T (N, 4, 4) with
    joints `held` (1 or N, c); for which (N,) there may be more."""
    policy = replace(arm.policy, arrived=arm.policy.arrived * min(1.0, arm.task.size / plan.length))
    pose, values, unsure = six_joint_rows(_six_joints(arm, plan, held), plan, T, policy)
    for i in np.flatnonzero(np.bincount(pose, minlength=1) > arm.most):
        some = _regular_first(arm, values[pose == i], held[i % len(held)], T[i])
        before, after = pose < i, pose > i
        values = np.concatenate([values[before], some, values[after]])
        pose = np.concatenate([pose[before], np.full(len(some), i), pose[after]])
    return pose, values, unsure
