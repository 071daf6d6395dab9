"""A 6R chain's closed loop `R_1 C_1 ... R_6 C_6 = 1` as equations in three of its angles.

Elimination of Raghavan and Roth (1990, 1993), its fourteen functions of a transform's last two columns.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import cross
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.arrays.rigid_motion import inverses, rotations_z

__all__ = [
    "FIT",
    "ROTATIONS",
    "XS",
    "YS",
    "ZS",
    "invariants",
    "joint_values",
    "left_invariants",
    "loop_action",
    "loop_constants",
    "loop_equations",
    "loop_order",
    "of_constants",
]

XS, YS = [0, 1, 2, 3], [4, 5, 6, 7]
ZS = [8, 9, 10, 11, 12, 13]  # the invariants that a rotation about z leaves alone
_THIRDS = np.array([0.0, 2.0 * np.pi / 3.0, 4.0 * np.pi / 3.0])
FIT = np.array([np.full(3, 1 / 3), 2 / 3 * np.cos(_THIRDS), 2 / 3 * np.sin(_THIRDS)])
_FIT_PAIR = np.kron(FIT, FIT)
ROTATIONS = rotations_z(_THIRDS)


def loop_constants(
    F: Sequence[Array], T: Array, start: int, reverse: int
) -> tuple[list[int], list[Array]]:
    """The loop of seven frames F (1 or N, 4, 4) and poses T (N, 4, 4) begun at joint `start`, reversed with
    negated angles: the order of the joints, and C (1 or N, 4, 4) each."""
    C, order = [*F[1:6], F[6] @ inverses(T) @ F[0]], loop_order(start, reverse)
    if not reverse:
        return order, [C[i] for i in order]
    return order, [of_constants(inverses, C[(i - 1) % 6]) for i in order]


def loop_order(start: int, reverse: int) -> list[int]:
    """The order of the joints in a loop begun at joint `start`, reversed or not."""
    return [(start - i if reverse else start + i) % 6 for i in range(6)]


def joint_values(values: Array, order: list[int], reverse: int = 0) -> Array:
    """The loop's values (k, 6) in the order of the joints, turned back where the loop runs backwards."""
    q = np.empty_like(values)
    q[:, order] = -values if reverse else values
    return q


def of_constants(function: Callable[..., Array], *C: Array) -> Array:
    """`function` of transforms (n, 4, 4), kept where those are single: mostly they are the arm's own."""
    if any(len(c) != 1 for c in C):
        return function(*C)
    return _kept(function, *(c.tobytes() for c in C))


@lru_cache(maxsize=256)
def _kept(function: Callable[..., Array], *C: bytes) -> Array:
    out = function(*(np.frombuffer(c).reshape(1, 4, 4) for c in C))
    out.flags.writeable = False
    return out


def invariants(X: Array) -> Array:
    """The 14 bilinear functions z, p, m = p x z, q = (p.p) z - 2 (p.z) p, p.p, p.z of the columns z
    and p of X (..., 4, 4), in the order x, y, z of the four vectors, then the two scalars."""
    z, p = X[..., :3, 2], X[..., :3, 3]
    pp = (p * p).sum(axis=-1)[..., None]
    pz = (p * z).sum(axis=-1)[..., None]
    v = np.stack([z, p, cross(p, z), pp * z - 2.0 * pz * p], axis=-1)
    return np.concatenate([v.reshape(*v.shape[:-2], 12), pp, pz], axis=-1)


def loop_action(C: Array) -> Array:
    """G (..., 14, 15) with invariants(C X) = G (invariants(X), 1)."""
    R, t = C[..., :3, :3], C[..., :3, 3]
    S = np.zeros((*C.shape[:-2], 3, 3))
    S[..., (2, 0, 1), (1, 2, 0)] = t
    S[..., (1, 2, 0), (2, 0, 1)] = -t
    tt = (t * t).sum(axis=-1)
    G = np.zeros((*C.shape[:-2], 14, 15))
    V = G[..., :12, :12].reshape(*C.shape[:-2], 3, 4, 3, 4)
    for k in range(4):
        V[..., k, :, k] = R
    V[..., 2, :, 0] = S @ R
    V[..., 3, :, 2] = -2.0 * S @ R
    V[..., 3, :, 0] = (
        tt[..., None, None] * np.eye(3) - 2.0 * t[..., :, None] * t[..., None, :]
    ) @ R
    G[..., :12, :12] = V.reshape(*C.shape[:-2], 12, 12)
    tR = np.einsum("...i,...ij->...j", t, R)
    G[..., 12, 1:12:4], G[..., 13, 0:12:4] = 2.0 * tR, tR
    G[..., 12, 12] = G[..., 13, 13] = 1.0
    G[..., 3:12:4, 13] = -2.0 * t
    G[..., 1:12:4, 14] = t
    G[..., 12, 14] = tt
    return G


def left_invariants(C3: Array, C4: Array, C5: Array) -> Array:
    """The invariants of `C_3 R_4 C_4 R_5 C_5` (n, 14, 9) in (1, c4, s4) x (1, c5, s5)."""
    D = (C3[:, None] @ ROTATIONS)[:, :, None] @ (C4[:, None] @ ROTATIONS @ C5[:, None])[:, None]
    V = invariants(D)
    return np.asarray(np.swapaxes(_FIT_PAIR @ V.reshape(len(V), 9, 14), 1, 2), dtype=float)


def loop_equations(C: list[Array]) -> tuple[Array, Array, Array]:
    """Six equations `E (v_0, v) = 0`, free of theta_1, theta_2, theta_6, for the invariants v of
    `R_3 C_3 R_4 C_4 R_5 C_5` and v_0 = 1: E (N, 6, 15) in the order (v, v_0). With it the
    invariants of `C_3 R_4 C_4 R_5 C_5` (n, 14, 9) in (1, c4, s4) x (1, c5, s5), and those of `R_2
    C_2 R_3 ... C_5 = C_1^-1 R_1^-1 C_6^-1 R_6^-1` (N, 14, 3) in (1, c1, s1)."""
    left = of_constants(left_invariants, *C[2:5])
    first, last = (of_constants(inverses, c)[:, None] for c in (C[0], C[5]))
    Y = first @ np.swapaxes(ROTATIONS, 1, 2) @ last
    right = np.swapaxes(FIT @ invariants(Y), 1, 2)
    G = of_constants(loop_action, C[1])
    null_6 = np.linalg.qr(right[:, ZS, 1:], mode="complete")[0][..., 2:]
    top = np.swapaxes(null_6, 1, 2)
    first = top @ G[:, ZS]
    first[..., 14] -= (top * right[:, ZS, 0][:, None]).sum(axis=-1)  # bits do not depend on N
    pairs = right[:, XS] + 1j * right[:, YS]
    null_4 = np.linalg.qr(np.conj(pairs), mode="complete")[0][..., 3:]
    w = np.swapaxes(null_4, 1, 2) @ (G[:, XS] + 1j * G[:, YS])
    return np.concatenate([first, w.real, w.imag], axis=1), left, right
