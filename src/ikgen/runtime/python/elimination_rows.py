"""An elimination of six joints as the closed form of an arm, held joints merged into the chain."""

from __future__ import annotations

from math import atan2

import numpy as np

from ikgen.runtime.python.array_types import Array, Index
from ikgen.runtime.python.general_6r import Plan, six_joint_rows
from ikgen.runtime.python.refinement import rank_loss
from ikgen.runtime.python.solution_rows import places
from ikgen.runtime.python.solved_arm import Arm

__all__ = ["elimination_lanes"]

_POSES = 256  # whose arrays fit into a processor's cache


def _frames(arm: Arm, held: Array) -> Array:
    """The chain of the axes that move, (7, 4, 4) unless a joint moves several, held joints merged into it.

    held: cosine and sine of a held angle, or a held distance, base to tip.
    """
    frames = [arm.chain.frames[0]]
    values = iter(held.tolist())
    for (joint, revolute, _, _), frame in zip(arm.chain.motions, arm.chain.frames[1:]):
        if joint not in arm.free:
            frames.append(frame)
            continue
        motion = np.eye(4)
        if revolute:
            c, s = next(values), next(values)
            motion[0, 0] = motion[1, 1] = c
            motion[1, 0], motion[0, 1] = s, -s
        else:
            motion[2, 3] = next(values)
        frames[-1] = frames[-1] @ motion @ frame
    return np.array(frames)


def _regular_first(arm: Arm, angles: Array, held: Array) -> Array:
    """At most `arm.most` rows of DH variables (k, 6): where a continuum gives more, its samples go."""
    if len(angles) <= arm.most:
        return angles
    q = np.empty((len(angles), len(arm.lower)))
    values, columns = iter(held.tolist()), iter(angles.T)
    motions = arm.chain.motions
    for joint in range(len(arm.lower)):
        lead = min((m for m in motions if m[0] == joint), key=lambda m: abs(m[2]))
        if joint not in arm.free:
            value = next(columns)
        elif lead[1]:
            c, s = next(values), next(values)
            value = np.array(atan2(s, c))
        else:
            value = np.array(next(values))
        q[:, joint] = (value - lead[3]) / lead[2]
    loss = rank_loss(arm.chain, arm.task, arm.moving, q)
    order = np.argsort(loss < arm.policy.continuum_rank_loss, kind="stable")
    return np.asarray(angles[order][: arm.most])


def elimination_lanes(arm: Arm, plan: Plan, entries: tuple[Array, ...]) -> tuple[Array, ...]:
    """Of many poses the cosine and sine of every moving joint's angle, and the lengths of slides (most, N),
    and which there are.

    entries: the pose's first three rows, then cosines, sines and distances of held joints.
    """
    columns = np.array([e.reshape(-1) for e in np.broadcast_arrays(*entries)])
    count = columns.shape[1]
    lanes = np.ones((6 + sum(plan.turning), arm.most, count))
    found = np.zeros((arm.most, count), dtype=bool)
    groups = [(np.arange(count), np.empty(0))]
    if len(columns) > 12:
        distinct, group = np.unique(columns[12:], axis=1, return_inverse=True)
        groups = [(np.flatnonzero(group.reshape(-1) == k), x) for k, x in enumerate(distinct.T)]
    for members, held in groups:
        for start in range(0, len(members), _POSES):
            part = members[start : start + _POSES]
            T = np.tile(np.eye(4), (len(part), 1, 1))
            T[:, :3] = columns[:12, part].T.reshape(-1, 3, 4)
            pose, values = _rows_of_poses(arm, plan, T, held)
            place, member, lane = places(pose), part[pose], 0
            for value, turns in zip(values.T, plan.turning):
                lanes[lane, place, member] = np.cos(value) if turns else value
                if turns:
                    lanes[lane + 1, place, member] = np.sin(value)
                lane += 2 if turns else 1
            found[place, member] = True
    return (*lanes, found)


def _rows_of_poses(arm: Arm, plan: Plan, T: Array, held: Array) -> tuple[Index, Array]:
    """Pose indices (k,) in order, and at most `arm.most` rows (k, 6) for each of the poses T (N, 4, 4)."""
    pose, values = six_joint_rows(_frames(arm, held), plan, T, arm.policy)
    for i in np.flatnonzero(np.bincount(pose, minlength=1) > arm.most):
        some = _regular_first(arm, values[pose == i], held)
        before, after = pose < i, pose > i
        values = np.concatenate([values[before], some, values[after]])
        pose = np.concatenate([pose[before], np.full(len(some), i), pose[after]])
    return pose, values
