"""Product of exponentials for whole batches of configurations, in NumPy.

`T_base_tip(q) = exp(S_1 v_1) ... exp(S_n v_n) M`, `v = A q + b` (Lynch and Park, Modern Robotics,
ch. 4). The screws come from Pinocchio's Jacobian of the original file, so that numerical searches
over thousands of configurations share nothing with the chain that the solver was derived from.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.model.arrays import Array

__all__ = ["ScrewChain"]


def _hat(screw: Array) -> Array:
    v, (x, y, z) = screw[:3], screw[3:]
    return np.array([[0, -z, y, v[0]], [z, 0, -x, v[1]], [-y, x, 0, v[2]], [0, 0, 0, 0]])


@dataclass(frozen=True, slots=True)
class ScrewChain:
    """`screws` (n, 6): linear then angular part, at the base origin, in path order; `home` (4, 4);
    `A` (n, dof) and `b` (n,) give the joint values from q (rows of A have one entry)."""

    screws: Array
    home: Array
    A: Array
    b: Array

    def _exponential(self, i: int, v: Array) -> Array:
        """exp(S_i v) for v (N,): (N, 4, 4)."""
        hat, angle = _hat(self.screws[i]), v[:, None]
        out: Array = np.eye(4).ravel() + angle * hat.ravel()
        if self.screws[i, 3:].any():
            second = hat @ hat
            third = (second @ hat).ravel()
            out += (1 - np.cos(angle)) * second.ravel() + (angle - np.sin(angle)) * third
        return out.reshape(-1, 4, 4)

    def forward(self, q: Array) -> Array:
        """Tip poses in the base link (N, 4, 4) for q (N, dof)."""
        v = q @ self.A.T + self.b
        T = np.broadcast_to(np.eye(4), (len(q), 4, 4))
        for i in range(len(self.screws)):
            T = T @ self._exponential(i, v[:, i])
        return np.asarray(T @ self.home)

    def forward_and_jacobian(self, q: Array) -> tuple[Array, Array]:
        """Tip poses (N, 4, 4) and geometric Jacobians (N, 6, dof), linear rows first, at the
        tip."""
        v = q @ self.A.T + self.b
        T = np.broadcast_to(np.eye(4), (len(q), 4, 4))
        linear, angular, origin = np.empty((3, len(q), len(self.screws), 3))
        for i, screw in enumerate(self.screws):
            R, origin[:, i] = T[:, :3, :3], T[:, :3, 3]
            linear[:, i], angular[:, i] = R @ screw[:3], R @ screw[3:]
            T = T @ self._exponential(i, v[:, i])
        T = np.asarray(T @ self.home)
        linear += np.cross(origin, angular)
        linear += np.cross(angular, T[:, None, :3, 3])
        J = np.concatenate([linear, angular], axis=2)
        return T, np.asarray(J.transpose(0, 2, 1) @ self.A)
