"""Approximate solutions of coupled joints whose equations one angle by half angles leaves without rank.

At right angles the twelve equations of the other five joints may be singular at every angle of the coupled
joint. By half angles of both angles they are 24 in sixteen products, which lose rank where there is a
solution (`both_half_angles`). Sixteen sums of them, the same for all angles, have a determinant that is a
trigonometric polynomial; of its roots those count at which the 24 lose rank.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Motion
from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.elimination.both_half_angles import lift_both, null_pairs
from ikgen.runtime.python.elimination.coupled_angle import CoupledAngle
from ikgen.runtime.python.elimination.coupled_loop import CoupledLoop
from ikgen.runtime.python.elimination.general_6r import Elimination

__all__ = ["CoupledBothAngle", "tall_determinants"]

_SUMS = np.cos(np.outer(np.arange(1, 17), np.arange(1, 25)))  # no two equations count alike
_NEAR = 0.03  # least singular value over the largest at which a root may be one of the equations
_TRUE = 1e-7  # least singular value over the largest at which a root is one of the equations


@dataclass(frozen=True)
class CoupledBothAngle(CoupledAngle):
    """Finds candidates by half angles of both angles beside the coupled one; an elimination's third number
    is the degree in that."""

    def _pairs(self, A: Array, pose: Index, angle: Array) -> tuple[Index, Array, Index]:
        sigma, rows = np.linalg.svd(lift_both(A))[1:]
        near = np.flatnonzero(sigma[:, 15] < _NEAR * sigma[:, 0])
        k, pair = null_pairs(rows[near], sigma[near], pose[near], angle[near])[:2]
        return near[k], pair, np.flatnonzero(sigma[:, 15] < _TRUE * sigma[:, 0])

    def _determinants(
        self, F: Sequence[Array], T: Array, elimination: Elimination, nodes: Array
    ) -> Array:
        return tall_determinants(self.motions, F, T, elimination, nodes)


def tall_determinants(
    motions: Sequence[Motion], F: Sequence[Array], T: Array, elimination: Elimination, nodes: Array
) -> Array:
    """The determinants (N, n) of sums of the 24 equations at angles `nodes`, (n,) or (N, n), of the coupled
    joint."""
    at = CoupledLoop(motions, F, elimination).equations(T, np.atleast_2d(nodes))
    return np.asarray(np.linalg.det(_SUMS @ lift_both(at.A)))
