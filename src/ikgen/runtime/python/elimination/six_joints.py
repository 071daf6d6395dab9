"""Six joints that an elimination solves, of a chain whose other joints are held."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Chain, Motion, chain_of
from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.arrays.rigid_motion import motions_z, rotations_z
from ikgen.runtime.python.rows.solution_rows import Turning, rows_of

__all__ = ["SixJoints", "one_axis_each", "six_joints", "with_tool_joint"]


@dataclass(frozen=True)
class SixJoints:
    """`T = F_0 M_1 F_1 ... M_n F_n`, lengths over the arm's.

    `frames`: the F, (1, 4, 4) where they are the same for all poses, else (N, 4, 4), one for each; n = 6
    unless a joint moves several axes. `chain`: the same with the held joints behind the six, at the values
    `held` (1 or N, h), rad or arm lengths.
    """

    frames: tuple[Array, ...]
    chain: Chain
    held: Array

    def of(self, pose: Index) -> SixJoints:
        """The six joints of some poses."""
        if len(self.held) == 1:
            return self
        some = tuple(rows_of(frame, pose) for frame in self.frames)
        return SixJoints(some, self.chain, self.held[pose])


def one_axis_each(turning: Turning) -> tuple[Motion, ...]:
    """The motions of six joints, each turning about or sliding along an axis of its own."""
    return tuple((i, turns, 1.0, 0.0) for i, turns in enumerate(turning))


def with_tool_joint(F: Array, axis: int) -> Array:
    """Constant transforms (..., n + 2, 4, 4) of the chain F (..., n + 1, 4, 4) and of a joint behind it: a
    turn about the tool's axis (0: x) through its origin, which a task leaves open that reads the position
    and the direction of that axis."""
    last = np.eye(4)
    last[:3, :3] = np.roll(np.eye(3), -1 - axis, axis=0)
    behind = np.broadcast_to(last, (*F.shape[:-3], 1, 4, 4))
    return np.concatenate([F[..., :-1, :, :], F[..., -1:, :, :] @ last.T, behind], axis=-3)


def six_joints(
    F: Array, length: float, motions: tuple[Motion, ...], held: Array | None = None
) -> SixJoints:
    """Six joints from constant transforms F (n + 1, 4, 4) and the motions between them, of joints 0 to 5
    and of held ones, numbered from 6 on, at the values `held` (N, h) in rad or m."""
    frames, chain = _scaled(F.tobytes(), length, motions)
    values = np.zeros((1, 0)) if held is None else held.copy()
    merged = [frames[0]]
    for (joint, turns, _, _), frame in zip(motions, frames[1:]):
        if joint < 6:
            merged.append(frame)
            continue
        value = values[:, joint - 6]
        if not turns:
            value /= length
        merged[-1] = merged[-1] @ (rotations_z(value) if turns else motions_z(value)) @ frame
    return SixJoints(tuple(merged), chain, values)


@lru_cache(maxsize=64)
def _scaled(frames: bytes, length: float, motions: tuple[Motion, ...]) -> tuple[Array, Chain]:
    """The transforms (n + 1, 1, 4, 4) with lengths over the arm's, and their chain."""
    F = np.frombuffer(frames).reshape(-1, 1, 4, 4).copy()
    F[..., :3, 3] /= length
    return F, chain_of(F[:, 0], motions, 1 + max(joint for joint, *_ in motions))
