"""Approximate solutions of coupled joints of which several share each value of the coupled joint.

A spherical wrist, or an angle that is found by its cosine, gives every value of the coupled joint more than
one solution. The twelve equations of the other five joints lose that much rank there, and their determinant
is a power of a polynomial: its roots lie in one place, where rounding takes them apart. Sums of the
equations and of their products, so many that one solution takes their rank, have a determinant whose roots
there are simple. What else it has of roots is left out. At a root the six equations have no unknowns but
theta_4 and theta_5: three sums of them, linear in (1, c5, s5), have a determinant of degree 3 in theta_4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Motion
from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.elimination.coupled_angle import CoupledAngle, circle_roots
from ikgen.runtime.python.elimination.coupled_loop import CoupledLoop
from ikgen.runtime.python.elimination.general_6r import Elimination
from ikgen.runtime.python.elimination.hidden_angle import lift
from ikgen.runtime.python.rows.solution_rows import first_of_equals

__all__ = ["CoupledSharedAngle", "shared_determinants"]

_SUMS = np.cos(np.outer(np.arange(1, 13), np.arange(1, 13)))  # no two equations count alike
_THREE = np.cos(np.outer(np.arange(1, 4), np.arange(1, 7)))  # of the six
_NODES: Array = 2.0 * np.pi / 7.0 * np.arange(7, dtype=float)
_HARMONICS = np.arange(-3, 4)
_ACCEPT = 0.03  # rad, the imaginary part of a theta_4 that may be real
_NEAR = 0.03  # of the equations' size: what angles leave of them that may be a solution
_TRUE = 1e-7  # what angles that are a solution leave of the equations, over their size
_SAME = 1e-6  # rad: rounding takes halves of a double theta_4 apart by less


@dataclass(frozen=True)
class CoupledSharedAngle(CoupledAngle):
    """Finds candidates where several solutions have each angle of the coupled joint in common."""

    def _pairs(self, A: Array, pose: Index, angle: Array) -> tuple[Index, Array, Index]:
        k, pair, left = _both_angles(A)
        order = np.argsort(k, kind="stable")
        k, pair, left = k[order], pair[order], left[order]
        true = np.flatnonzero(left < _TRUE)
        first = first_of_equals(np.repeat(pair[true], 3, axis=1), k[true], (True,) * 6, _SAME)
        return k, pair, k[true[first]]

    def _determinants(
        self, F: Sequence[Array], T: Array, elimination: Elimination, nodes: Array
    ) -> Array:
        return shared_determinants(13 - self.share, self.motions, F, T, elimination, nodes)


def _both_angles(A: Array) -> tuple[Index, Array, Array]:
    """theta_4, theta_5 from the equations A (k, 6, 9): indices into k, pairs of angles (m, 2), and what
    these leave of the equations (m,), over their size."""
    terms = A.reshape(-1, 6, 3, 3).swapaxes(1, 2)
    values = np.linalg.det(_THREE @ _at(terms[:, None], _NODES))
    z = circle_roots(np.fft.fft(values, axis=1)[:, _HARMONICS])
    k, root = np.nonzero(np.abs(np.log(np.abs(z))) < _ACCEPT)
    t4 = np.angle(z[k, root])
    P = _at(terms[k], t4)
    row = np.argmax((P * P).sum(axis=2), axis=1)
    # all rows are like the largest where two theta_5 go with theta_4
    one, c, s = P[np.arange(len(k)), row].T
    size = np.hypot(c, s)
    half = np.arccos(np.clip(-one / np.maximum(size, 1e-300), -1.0, 1.0))
    t5 = np.arctan2(s, c) + np.stack([half, -half])
    w = np.stack([np.ones_like(t5), np.cos(t5), np.sin(t5)], axis=-1)
    left = np.linalg.norm((P @ w[..., None])[..., 0], axis=2)
    left /= np.linalg.norm(A, axis=(1, 2))[k]
    which, j = np.nonzero(left < _NEAR)
    return k[j], np.stack([t4[j], t5[which, j]], axis=1), left[which, j]


def _at(terms: Array, angle: Array) -> Array:
    """The terms (..., 3, 6, 3) in 1, cos, sin of angles (...)."""
    c, s = np.cos(angle)[..., None, None], np.sin(angle)[..., None, None]
    return np.asarray(terms[..., 0, :, :] + c * terms[..., 1, :, :] + s * terms[..., 2, :, :])


def shared_determinants(
    size: int,
    motions: Sequence[Motion],
    F: Sequence[Array],
    T: Array,
    elimination: Elimination,
    nodes: Array,
) -> Array:
    """The determinants (N, n) of `size` sums of the twelve equations and products at angles `nodes`, (n,)
    or (N, n), of the coupled joint."""
    at = CoupledLoop(motions, F, elimination).equations(T, np.atleast_2d(nodes))
    return np.asarray(np.linalg.det(_SUMS[:size] @ lift(at.A) @ _SUMS[:, :size]))
