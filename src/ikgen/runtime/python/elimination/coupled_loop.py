"""The loop of the five joints that turn one axis each, beside one that turns several, and its equations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Motion
from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.arrays.rigid_motion import inverses, rotations_z
from ikgen.runtime.python.elimination.back_substitution import complete_angles
from ikgen.runtime.python.elimination.general_6r import Elimination
from ikgen.runtime.python.elimination.loop_equations import left_invariants, loop_equations
from ikgen.runtime.python.rows.solution_rows import rows_of

__all__ = ["CoupledLoop", "LoopEquations", "coupled_and_others", "neighbours"]

_ONE = np.eye(4)[None]


class LoopEquations(NamedTuple):
    """The links behind the five joints, the invariants of both sides (`left`: (N, n, 14, 9)), and the six
    equations A (N, n, 6, 9) in (1, c4, s4) x (1, c5, s5), of N poses at n angles of the coupled joint."""

    links: list[Array]
    left: Array
    right: Array
    A: Array


def coupled_and_others(motions: Sequence[Motion]) -> tuple[int, list[int]]:
    """The joint that turns several axes, and the others in their order along the chain."""
    joints = [motion[0] for motion in motions]
    coupled = max(joints, key=joints.count)
    return coupled, [joint for joint in joints if joint != coupled]


class CoupledLoop:
    """The loop of the five joints that turn one axis each, as an elimination begins and runs it."""

    def __init__(
        self, motions: Sequence[Motion], F: Sequence[Array], elimination: Elimination
    ) -> None:
        start, reverse, _ = elimination
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

    def equations(self, T: Array, angle: Array) -> LoopEquations:
        """The five joints' equations at poses T (N, 4, 4) and angles (N or 1, n)."""
        links = self.links(T[:, None], angle)
        ends = [links[0][:, 0], _ONE, _ONE, _ONE, _ONE, links[4][:, 0]]
        E, _, right = loop_equations(ends)  # no angle of the coupled joint changes them
        shape = np.broadcast_shapes(*(link.shape[:2] for link in links[1:4]))
        inner = (np.broadcast_to(link, (*shape, 4, 4)).reshape(-1, 4, 4) for link in links[1:4])
        left = left_invariants(*inner).reshape(*shape, 14, 9)
        A = E[:, None, :, :14] @ left
        A[..., 0] += E[:, None, :, 14]
        return LoopEquations(links, left, right, A)

    def completed(self, at: LoopEquations, k: Index, angle: Array, pair: Array) -> Array:
        """Values (m, 6) of all joints at the roots with indices k (m,), theta_4 and theta_5 the pairs
        (m, 2); `at` are the equations at all roots, one `angle` each."""
        count = len(angle)
        left = np.broadcast_to(at.left[:, 0], (count, 14, 9))
        C = [rows_of(link[:, 0], k) for link in at.links]
        t = np.concatenate([np.zeros((len(k), 1)), pair], axis=1)
        each = np.arange(len(k))
        found = complete_angles([C[0], _ONE, *C[1:]], left[k], rows_of(at.right, k), each, t)
        q = np.empty((len(k), 6))
        q[:, self.joints] = (-1.0 if self.reverse else 1.0) * found[:, [0, 1, 3, 4, 5]]
        q[:, self.coupled] = angle[k]
        return q


def neighbours(
    motions: Sequence[Motion], F: Sequence[Array], elimination: Elimination, nodes: Array
) -> Array:
    """Cosines (3, n) between the axes beside the links in which the coupled joint may lie, at its angles
    `nodes` (n,)."""
    links = CoupledLoop(motions, F, elimination).links(np.eye(4)[None, None], nodes[None])
    return np.array([np.broadcast_to(link[0, :, 2, 2], nodes.shape) for link in links[1:4]])
