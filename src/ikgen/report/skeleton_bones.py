"""An arm at one configuration as bones, joints and frames in space, from its Denavit-Hartenberg rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ikgen.kinematics.forward import row_constant, row_values
from ikgen.kinematics.rigid import dh_link, z_motion
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain, DHRow

__all__ = ["Bone", "JointMark", "Skeleton", "skeleton"]


@dataclass(frozen=True, slots=True)
class Bone:
    """A straight piece from `start` to `end` (3,), m; `name` is its length's symbol (`a_2`), empty at
    the base, at the tool and along a sliding joint."""

    start: Array
    end: Array
    name: str = ""
    slides: bool = False


@dataclass(frozen=True, slots=True)
class JointMark:
    """A joint: its number from 1, a point (3,) of its axis that lies on the arm, the axis' direction."""

    number: int
    at: Array
    along: Array
    revolute: bool


@dataclass(frozen=True, slots=True)
class Skeleton:
    """`frames` (n + 2, 4, 4): the base link, the frames of the rows 1 to n, and the tip link."""

    bones: tuple[Bone, ...]
    joints: tuple[JointMark, ...]
    frames: Array

    @property
    def points(self) -> Array:
        """(k, 3): all ends of bones."""
        return np.array([p for bone in self.bones for p in (bone.start, bone.end)])

    @property
    def size(self) -> float:
        """The longest edge (m) of the box around it; 1 for an arm without lengths."""
        return float(np.ptp(self.points, axis=0).max()) or 1.0


def skeleton(dh: DHChain, q: ArrayLike) -> Skeleton:
    """The skeleton at joint values `q` (dof,), rad and m, in the base link's frame: of each row its
    length a along the common normal, then its offset d along the joint's axis (Craig, ch. 3)."""
    values = row_values(dh, np.asarray(q, dtype=np.float64))
    T = dh.X_base
    bones, joints, frames = [Bone(np.zeros(3), T[:3, 3])], [], [np.eye(4)]
    for i, row in enumerate(dh.rows):
        foot = T @ dh_link(row.alpha.value, row.a.value, 0.0, 0.0)
        bones.append(Bone(T[:3, 3], foot[:3, 3], row.a.name or ""))
        T = T @ row_constant(row) @ z_motion(row.revolute, values[i])
        bones.append(Bone(foot[:3, 3], T[:3, 3], row.d.name or "", not row.revolute))
        joints.append(_mark(i, row, foot, T))
        frames.append(T)
    tip = T @ dh.X_tip
    bones.append(Bone(T[:3, 3], tip[:3, 3]))
    seen = tuple(bone for bone in bones if np.linalg.norm(bone.end - bone.start) > 1e-9)
    return Skeleton(
        seen or (Bone(np.zeros(3), np.zeros(3)),), tuple(joints), np.array([*frames, tip])
    )


def _mark(i: int, row: DHRow, foot: Array, T: Array) -> JointMark:
    """Half-way along the offset of a revolute row, at the start of a slide."""
    at = (foot[:3, 3] + T[:3, 3]) / 2 if row.revolute else foot[:3, 3]
    return JointMark(i + 1, at, foot[:3, 2], row.revolute)
