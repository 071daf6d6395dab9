"""The closed loop of six joints seen from those that turn: slides leave rotations alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.elimination.spherical_triple import Complex, turns_z

__all__ = ["RevoluteLoop", "displacement", "revolute_loop", "slide_lengths"]


@dataclass(frozen=True)
class RevoluteLoop:
    """The loop `R_1 K_1 ... R_r K_r = 1` of r revolute joints, for n poses: rotations K (r, n, 3, 3) and
    displacements k (r, n, 3) behind each joint; the directions u (6 - r, n, 3) of the slides, each behind
    the revolute joint of that number `at` (from 0)."""

    K: Array
    k: Array
    u: Array
    at: tuple[int, ...]

    def of(self, pose: Index) -> RevoluteLoop:
        """The loops of some poses."""
        return RevoluteLoop(self.K[:, pose], self.k[:, pose], self.u[:, pose], self.at)


def revolute_loop(C: list[Array], turns: list[bool], count: int) -> RevoluteLoop:
    """From the constants behind six joints, C (1 or `count`, 4, 4) each; the first of them turns."""
    behind: list[Array] = []
    u: list[Array] = []
    at: list[int] = []
    for c, turn in zip(C, turns):
        frame = np.broadcast_to(c, (count, 4, 4))
        if turn:
            behind.append(frame)
            continue
        at.append(len(behind) - 1)
        u.append(behind[-1][:, :3, 2])
        behind[-1] = behind[-1] @ frame
    X = np.array(behind)
    return RevoluteLoop(X[..., :3, :3], X[..., :3, 3], np.array(u), tuple(at))


def displacement(loop: RevoluteLoop, c: Complex, s: Complex) -> tuple[Complex, Complex]:
    """The loop's displacement (2, n, 3) without the slides, and the slides' directions (6 - r, 2, n, 3), at
    cosines and sines (2, r, n) of the angles."""
    shape = c[:, 0].shape
    A: Complex = np.broadcast_to(np.eye(3) + 0j, (*shape, 3, 3))
    p: Complex = np.zeros((*shape, 3), dtype=complex)
    u = []
    for i in range(len(loop.k)):
        A = A @ turns_z(c[:, i], s[:, i])
        p = p + (A @ loop.k[i][..., None])[..., 0]
        u += [(A @ v[..., None])[..., 0] for v, at in zip(loop.u, loop.at) if at == i]
        A = A @ loop.K[i]
    return p, np.array(u)


def slide_lengths(p: Complex, u: Complex) -> Array:
    """The lengths (n, m) of slides in the directions u (m, n, 3) that come nearest to closing a loop of the
    displacement p (n, 3)."""
    U = np.moveaxis(u.real, 0, -1)
    return np.asarray(-(np.linalg.pinv(U) @ p.real[..., None])[..., 0], dtype=float)
