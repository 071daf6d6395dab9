"""The arm angle, held in place of a joint: of rows and poses, and as an error of rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Chain, forward, tip_and_jacobian
from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["ArmAngle"]

_SHOULDER_JOINTS = 3
_BEYOND = (
    1e-5  # distance of the elbow from the line, to the other side, over the upper arm, that counts
)
_ON_AXIS = 1e-8  # distance of the wrist from the first axis, over that from the shoulder


@dataclass(frozen=True)
class ArmAngle:
    """`elbow`: the chain from the base link to a frame at the elbow, of exact geometry; `shoulder`
    (4, 4): in the base link, z along the first axis; `wrist` (3,): in the tip link; `upper` (m):
    shoulder to elbow.

    A row has the arm angle of the half plane from the line through the shoulder and the pose's
    wrist through the row's elbow, counted about the direction to the wrist from the side of the
    first axis."""

    elbow: Chain
    shoulder: Array
    wrist: Array
    upper: float

    def of_rows(self, q: Array, pose: Array) -> Array:
        """The arm angles (...) of rows (..., dof) of poses (..., 4, 4), in (-pi, pi]."""
        x, y = np.moveaxis(self.beside_line(q, pose), -1, 0)
        return np.asarray(np.arctan2(y, x))

    def beside_line(self, q: Array, pose: Array) -> Array:
        """Where elbows are beside the line (..., 2), m: along the half plane of angle 0, and at
        right angles to it."""
        e = forward(self.elbow, q[..., :_SHOULDER_JOINTS])[..., :3, 3] - self.shoulder[:3, 3]
        return np.stack([(e * axis).sum(axis=-1) for axis in self.plane(pose)], axis=-1)

    def aims(self, T: Array, held: Array) -> Array:
        """Poses (k, 4, 4) with two more lines: from the line into the half plane at arm angles
        `held` (k, 1), and the normal of that."""
        x, y = self.plane(T)
        out = np.zeros((len(T), 6, 4))
        out[:, :4], out[:, 4, :3] = T, np.cos(held) * x + np.sin(held) * y
        out[:, 5, :3] = np.cos(held) * y - np.sin(held) * x
        return out

    def errors(self, q: Array, aim: Array) -> tuple[Array, Array]:
        """How far elbows (k,) of rows (k, dof) are from the half plane of `aims` over the upper
        arm, and the derivatives (k, dof) of that."""
        pose, J = tip_and_jacobian(self.elbow, q[:, :_SHOULDER_JOINTS])
        normal = aim[:, 5, :3] / self.upper
        missed = self.shoulder[:3, 3] - pose[:, :3, 3]
        error = (normal * missed).sum(axis=1)
        error[(aim[:, 4, :3] * missed).sum(axis=1) > _BEYOND * self.upper] += 1.0
        slope = np.zeros_like(q)
        slope[:, :_SHOULDER_JOINTS] = (normal[:, :, None] * J[:, :3]).sum(axis=1)
        return error, slope

    def turned(self, q: Array, aim: Array) -> Array:
        """The derivatives (k,) of minus those errors by the arm angle."""
        elbow = forward(self.elbow, q[:, :_SHOULDER_JOINTS])[:, :3, 3]
        into = aim[:, 4, :3] / self.upper
        return np.asarray((into * (self.shoulder[:3, 3] - elbow)).sum(axis=1))

    def plane(self, T: Array) -> tuple[Array, Array]:
        """Directions (..., 3) from the line to the wrist: where the arm angle is 0, and a quarter
        turn on."""
        R = self.shoulder[:3, :3]
        w = ((T[..., :3, :3] @ self.wrist + T[..., :3, 3]) - self.shoulder[:3, 3]) @ R
        w = w / np.maximum(np.sqrt((w * w).sum(axis=-1, keepdims=True)), 1e-12)
        off = np.hypot(w[..., 0], w[..., 1])
        on, some = off <= _ON_AXIS, np.maximum(off, _ON_AXIS)
        c, s = np.where(on, 1.0, w[..., 0] / some), np.where(on, 0.0, w[..., 1] / some)
        x = np.stack([-c * w[..., 2], -s * w[..., 2], np.where(on, 0.0, off)], axis=-1)
        y = np.stack([s, -c, np.zeros_like(s)], axis=-1)
        return x @ R.T, y @ R.T
