"""Approximate solutions of six revolute joints of which one turns several axes, as in hollow wrists.

The angle of that joint is hidden in the elimination of Raghavan and Roth (1990). At an angle of it five
joints are left, whose loop closes where the twelve equations without three of them are singular. Their
determinant is a trigonometric polynomial, of a degree that ratios and geometry make; its roots are
eigenvalues of a companion matrix. What is coupled may lie in any of three neighbouring links of the five
joints' loop, so that the null spaces by which the three are eliminated stay the same for all angles.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.array_types import Array, Index
from ikgen.runtime.python.back_substitution import complete_angles, null_angles
from ikgen.runtime.python.chain_kinematics import Motion
from ikgen.runtime.python.general_6r import Candidates, Elimination
from ikgen.runtime.python.hidden_angle import lift, real_angles
from ikgen.runtime.python.loop_equations import left_invariants, loop_equations
from ikgen.runtime.python.rigid_motion import inverses, rotations_z
from ikgen.runtime.python.solution_rows import rows_of

__all__ = ["CoupledAngle", "coupled_and_others", "coupled_determinants", "neighbours"]

_ONE = np.eye(4)[None]
_FIRST_NODE = 0.05  # rad, an angle that no right angle shares
_REAL = 0.03  # rad, the imaginary part of an angle that may be real

# Near a crowded angle (rad): how far, and the degree of polynomials of sines and cosines there.
_NEAR, _CLOSE = 0.2, 20
_NODES: Array = np.cos(np.pi / (_CLOSE + 1) * (np.arange(_CLOSE + 1, dtype=float) + 0.5))
_CHEBYSHEV = np.linalg.inv(np.polynomial.chebyshev.chebvander(_NODES, _CLOSE))


@dataclass(frozen=True)
class CoupledAngle:
    """Finds candidates of a chain in which one joint, and no other, turns several axes: `motions` in their
    order along the chain. The plan's third number is the degree in that joint's angle. Near `crowded`
    angles (rad) the determinant is small at every pose; it is looked at there by itself."""

    motions: tuple[Motion, ...]
    crowded: tuple[float, ...] = ()

    def __call__(
        self, F: Sequence[Array], T: Array, plan: Elimination, _: tuple[bool, ...]
    ) -> Candidates:
        """As `candidates`, of as many frames F as rows and 1; none is known to be all of a pose."""
        count, degree = len(T), plan[2]
        step = 2.0 * np.pi / (2 * degree + 2)
        nodes: Array = _FIRST_NODE + step * np.arange(2 * degree + 2, dtype=float)
        pose, angle = _roots(coupled_determinants(self.motions, F, T, plan, nodes), degree)
        for place in self.crowded:
            close = coupled_determinants(self.motions, F, T, plan, place + _NEAR * _NODES)
            apart = np.abs(np.remainder(angle - place + np.pi, 2.0 * np.pi) - np.pi) > 0.9 * _NEAR
            more, near = _close_roots(close)
            pose, angle = np.append(pose[apart], more), np.append(angle[apart], place + near)
        order = np.argsort(pose, kind="stable")
        pose, angle = pose[order], angle[order]
        none, unclear = np.zeros(count, dtype=np.intp), np.zeros(count, dtype=bool)
        if not len(pose):
            return pose, np.zeros((0, 6)), none, unclear
        frames = [rows_of(frame, pose) for frame in F]
        k, q = _completed(self.motions, frames, T[pose], plan, pose, angle)
        return pose[k], q, none, unclear


def coupled_determinants(
    motions: Sequence[Motion], F: Sequence[Array], T: Array, plan: Elimination, nodes: Array
) -> Array:
    """The determinants (N, n) of the twelve equations at the coupled joint's angles `nodes` (n,)."""
    loop = _Loop(motions, F, *plan[:2])
    links = loop.links(T[:, None], nodes[None])
    E, _ = _equations([link[:, 0] for link in links])
    shape = np.broadcast_shapes(*(link.shape[:2] for link in links[1:4]))
    inner = (np.broadcast_to(link, (*shape, 4, 4)).reshape(-1, 4, 4) for link in links[1:4])
    left = left_invariants(*inner).reshape(*shape, 14, 9)
    return np.asarray(np.linalg.det(_singular(E[:, None], left)))


def neighbours(
    motions: Sequence[Motion], F: Sequence[Array], plan: Elimination, nodes: Array
) -> Array:
    """Cosines (3, n) between the axes beside the links in which the coupled joint may lie, at its angles
    `nodes` (n,)."""
    links = _Loop(motions, F, *plan[:2]).links(np.eye(4)[None, None], nodes[None])
    return np.array([np.broadcast_to(link[0, :, 2, 2], nodes.shape) for link in links[1:4]])


def coupled_and_others(motions: Sequence[Motion]) -> tuple[int, list[int]]:
    """The joint that turns several axes, and the others in their order along the chain."""
    joints = [motion[0] for motion in motions]
    coupled = max(joints, key=joints.count)
    return coupled, [joint for joint in joints if joint != coupled]


class _Loop:
    """The loop of the five joints that turn one axis each, begun at `start`, `reverse`d or not."""

    def __init__(
        self, motions: Sequence[Motion], F: Sequence[Array], start: int, reverse: int
    ) -> None:
        self.coupled, singles = coupled_and_others(motions)
        step = -1 if reverse else 1
        self.places = [(start + step * i) % 5 for i in range(5)]
        self.joints = [singles[place] for place in self.places]
        self.reverse, self.motions, self.F = reverse, motions, F

    def links(self, T: Array, angle: Array) -> list[Array]:
        """What is behind each joint in the loop's order, (n, m, 4, 4) or 1 in place of n or m, at poses T
        (n, m, 4, 4) and angles (n, m) of the coupled joint."""
        behind, link = [], self.F[0][:, None]
        for (joint, _, ratio, shift), frame in zip(self.motions, self.F[1:]):
            if joint == self.coupled:
                link = link @ rotations_z(ratio * angle + shift) @ frame[:, None]
            else:
                behind.append(link)
                link = frame[:, None]
        behind = [*behind[1:], link @ inverses(T) @ behind[0]]
        if self.reverse:
            return [inverses(behind[place - 1]) for place in self.places]
        return [behind[place] for place in self.places]


def _equations(links: list[Array]) -> tuple[Array, Array]:
    """Equations E (n, 6, 15) and the invariants of the other side, as `loop_equations` has them: no angle
    of the coupled joint changes them."""
    E, _, right = loop_equations([links[0], _ONE, _ONE, _ONE, _ONE, links[4]])
    return E, right


def _singular(E: Array, left: Array) -> Array:
    """The twelve equations (..., 12, 12) from E (..., 6, 15) and the left's invariants (..., 14, 9)."""
    A = E[..., :14] @ left
    A[..., 0] += E[..., 14]
    return lift(A)


def _roots(values: Array, degree: int) -> tuple[Index, Array]:
    """Poses (k,) in order and the real roots (k,), in order for each, of trigonometric polynomials with
    `values` (N, n) at the nodes."""
    harmonics = np.arange(-degree, degree + 1)
    c = np.fft.fft(values, axis=1)[:, harmonics]
    c = c / np.maximum(np.abs(c).max(axis=1, keepdims=True), 1e-300)
    lead = np.where(np.abs(c[:, -1:]) < 1e-300, 1e-300, c[:, -1:])
    companion = np.zeros((len(c), 2 * degree, 2 * degree), dtype=complex)
    companion[:, 1:, :-1] = np.eye(2 * degree - 1)
    companion[:, :, -1] = -c[:, :-1] / lead
    z = np.linalg.eigvals(companion)
    t: NDArray[np.complex128] = -1j * (z - 1.0) / np.where(z == -1.0, 1e-300, z + 1.0)
    pose, angle, _, _ = real_angles(t, np.full(len(z), _FIRST_NODE), _REAL)
    return pose, angle


def _close_roots(values: Array) -> tuple[Index, Array]:
    """Poses (k,) and the real roots (k,), from a crowded angle, of determinants with `values` (N, n) at the
    nodes near it: eigenvalues of the colleague matrix (Good 1961)."""
    c = values @ _CHEBYSHEV.T
    lead = np.where(np.abs(c[:, -1:]) < 1e-300, 1e-300, c[:, -1:])
    colleague = np.zeros((len(c), _CLOSE, _CLOSE))
    k = np.arange(_CLOSE - 1)
    colleague[:, k, k + 1] = colleague[:, k + 1, k] = 0.5
    colleague[:, 0, 1] = 1.0
    colleague[:, -1] -= 0.5 * c[:, :-1] / lead
    x = np.linalg.eigvals(colleague)
    pose, i = np.nonzero((np.abs(x.imag) < _REAL / _NEAR) & (np.abs(x.real) <= 1.0))
    return pose, np.asarray(_NEAR * x.real[pose, i], dtype=float)


def _completed(
    motions: Sequence[Motion],
    F: Sequence[Array],
    T: Array,
    plan: Elimination,
    pose: Index,
    angle: Array,
) -> tuple[Index, Array]:
    """Indices (m,) into the roots, `angle` (k,) of poses T (k, 4, 4), and values (m, 6) of all joints."""
    loop, count = _Loop(motions, F, *plan[:2]), len(angle)
    links = [link[:, 0] for link in loop.links(T[:, None], angle[:, None])]
    E, right = _equations(links)
    left = left_invariants(*(np.broadcast_to(link, (count, 4, 4)) for link in links[1:4]))
    k, pair = null_angles(_singular(E, left), pose, angle)
    C = [rows_of(link, k) for link in links]
    t = np.concatenate([np.zeros((len(k), 1)), pair], axis=1)
    each = np.arange(len(k))
    found = complete_angles([C[0], _ONE, *C[1:]], left[k], rows_of(right, k), each, t)
    q = np.empty((len(k), 6))
    q[:, loop.joints] = (-1.0 if plan[1] else 1.0) * found[:, [0, 1, 3, 4, 5]]
    q[:, loop.coupled] = angle[k]
    return k, q
