"""The other five angles of a loop from theta_3."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.arrays.rigid_motion import rotations_z
from ikgen.runtime.python.elimination.hidden_angle import hidden_angles, loop_resultant, solved
from ikgen.runtime.python.elimination.loop_equations import (
    XS,
    YS,
    ZS,
    loop_action,
    of_constants,
)
from ikgen.runtime.python.rows.solution_rows import rows_of

__all__ = ["complete_angles", "middle_angles", "null_angles", "turned", "with_last_angle"]

_ROUNDING = 1e-15  # of an equation's entries: at a root they are singular to the last digit
_ONE_ROOT = 1e-6  # rad: rounding moves roots with two solutions by less


def _split(N: Array) -> Array:
    """The solutions (n, 12, 2) within null spaces of two dimensions N (n, 12, 2). Where theta_4
    differs the shift `u3 = exp(i theta_4) u1` splits them, else the cone `w_0^2 = w_1^2 +
    w_2^2`."""
    u1, u3 = N[:, 0:3] + 1j * N[:, 3:6], N[:, 6:9] + 1j * N[:, 9:12]
    A = np.linalg.pinv(np.concatenate([u1, np.conj(u1)], axis=1))
    A = A @ np.concatenate([u3, u1], axis=1)
    (a, b), (c, d) = (A[:, 0, 0], A[:, 0, 1]), (A[:, 1, 0], A[:, 1, 1])
    root = np.sqrt(0.25 * (a - d) ** 2 + b * c)
    vectors = []
    H = (np.conj(np.swapaxes(u1, 1, 2)) @ (np.array([1.0, -1.0, -1.0])[:, None] * u1)).real
    disc = np.sqrt(np.maximum(H[:, 0, 1] ** 2 - H[:, 0, 0] * H[:, 1, 1], 0.0))
    for sign in (1.0, -1.0):
        x = sign * root - 0.5 * (a - d)  # eigenvector (b, x) or (x + a - d, c)
        first = np.abs(b) >= np.abs(c)
        shift = np.stack([np.where(first, b, x + a - d), np.where(first, x, c)], axis=-1)
        big = np.take_along_axis(shift, np.abs(shift).argmax(axis=1)[:, None], axis=1)
        cone = np.stack([-H[:, 0, 1] - sign * disc, H[:, 0, 0]], axis=-1)
        other = np.stack([H[:, 1, 1], -H[:, 0, 1] + sign * disc], axis=-1)
        cone = np.where((np.abs(H[:, 0, 0]) >= np.abs(H[:, 1, 1]))[:, None], cone, other)
        apart = np.abs(root) > 0.01
        vectors.append(np.where(apart[:, None], (shift * np.conj(big)).real, cone))
    return np.asarray(N @ np.stack(vectors, axis=-1), dtype=float)


def _null_spaces(M: Array) -> tuple[Array, Flags, Flags]:
    """Two orthogonal vectors (k, 12, 2) each that M (k, 12, 12) shrinks most, the first one most of all;
    which M may have both of them in their null space, and which the first one alone: of the columns of
    an inverse, as inverse iteration has it (Ipsen 1997)."""
    W = solved(M, np.broadcast_to(np.eye(12), M.shape), _ROUNDING)
    a, longest = _longest(W)
    W = W - a * (np.swapaxes(a, 1, 2) @ W)
    b, length = _longest(W)
    scale = np.sqrt((M * M).sum(axis=(1, 2)))
    return np.concatenate([a, b], axis=2), length * scale > 1e4, longest > 1e3 * length


def _longest(W: Array) -> tuple[Array, Array]:
    """The longest column of each W (k, 12, 12) at unit length (k, 12, 1), and its length (k,)."""
    size = np.maximum(np.abs(W).max(axis=(1, 2)), 1e-300)
    squares: Array = ((W / size[:, None, None]) ** 2).sum(axis=1)
    k, i = np.arange(len(W)), squares.argmax(axis=1)
    length = np.sqrt(squares[k, i]) * size
    return (W[k, :, i] / length[:, None])[:, :, None], length


def null_angles(M: Array, pose: Index, t3: Array) -> tuple[Index, Array]:
    """theta_4, theta_5 from the null vectors (cos h w, sin h w, cos 3h w, sin 3h w), with w = (1,
    c5, s5) and h half of theta_4, of M (k, 12, 12) at roots theta_3 (k,) of poses (k,), both in order:
    indices into k, pairs of angles (m, 2). A root with two solutions counts twice, and is taken once."""
    U, double, single = _null_spaces(M)
    index, v = np.arange(len(M)), U[:, :, 0]
    if double.any():
        again = np.zeros(len(M), dtype=bool)
        again[1:] = double[:-1] & (np.diff(pose) == 0) & (np.diff(t3) < _ONE_ROOT)
        one, two = np.flatnonzero(single | ~double), np.flatnonzero(double & ~again)
        index = np.concatenate([one, np.repeat(two, 2)])
        v = np.concatenate([v[one], np.swapaxes(_split(U[two]), 1, 2).reshape(-1, 12)])
    u1, u3 = v[:, 0:3] + 1j * v[:, 3:6], v[:, 6:9] + 1j * v[:, 9:12]
    t4 = np.angle((u3 * np.conj(u1)).sum(axis=1))
    w = (u1 * np.exp(-0.5j * t4)[:, None]).real
    w = np.where(w[:, :1] < 0.0, -w, w)
    return index, np.stack([t4, np.arctan2(w[:, 2], w[:, 1])], axis=-1)


def middle_angles(E: Array, left: Array, swap: int) -> tuple[Index, Array, Index, Flags]:
    """theta_3, theta_4, theta_5 (k, 3) from the equations E (N, 6, 15) and the invariants of their left.

    `swap` exchanges theta_4 and theta_5 in these on the way; the rest as `hidden_angles` has it."""
    mono = left.reshape(-1, 14, 3, 3).swapaxes(2, 3).reshape(-1, 14, 9) if swap else left
    M = loop_resultant(E, mono)
    pose, t3, least, clear = hidden_angles(E, mono, M, 0.03)
    if not len(pose):
        return pose, np.zeros((0, 3)), least, clear
    c, s = np.cos(t3)[:, None, None], np.sin(t3)[:, None, None]
    M0, M1, M2 = (rows_of(m, pose) for m in M)
    k, t45 = null_angles(M0 + c * M1 + s * M2, pose, t3)
    t = np.concatenate([t3[k, None], t45[:, ::-1] if swap else t45], axis=1)
    return pose[k], t, least, clear


def turned(left: Array, t: Array) -> Array:
    """The invariants of `R_3 C_3 R_4 C_4 R_5 C_5` and 1 (k, 15) at the three angles t (k, 3)."""
    one = np.ones(len(t))
    b3, b4, b5 = (np.stack([one, np.cos(x), np.sin(x)], axis=-1) for x in t.T)
    v = (left @ (b4[:, :, None] * b5[:, None]).reshape(-1, 9, 1))[..., 0]
    w = (v[:, XS] + 1j * v[:, YS]) * (b3[:, 1:2] + 1j * b3[:, 2:])
    return np.concatenate([w.real, w.imag, v[:, ZS], one[:, None]], axis=1)


def complete_angles(C: list[Array], left: Array, right: Array, pose: Index, t: Array) -> Array:
    """The six loop angles (k, 6) from theta_3, theta_4, theta_5 in t (k, 3) for the poses with indices
    `pose` (k,): theta_1 and theta_2 linearly, theta_6 from the rotation left over."""
    v = turned(rows_of(left, pose), t)
    G = of_constants(loop_action, C[1])
    flat = np.asarray(np.linalg.pinv(right[:, ZS, 1:]), dtype=float)
    u = (rows_of(G, pose) @ v[..., None])[..., 0]
    right = rows_of(right, pose)
    cs = (rows_of(flat, pose) @ (u[:, ZS] - right[:, ZS, 0])[..., None])[..., 0]
    t1 = np.arctan2(cs[:, 1], cs[:, 0])
    z = (
        right[..., 0]
        + (right[..., 1:] @ np.stack([np.cos(t1), np.sin(t1)], axis=-1)[..., None])[..., 0]
    )
    w = (z[:, XS] + 1j * z[:, YS]) * (u[:, XS] - 1j * u[:, YS])
    angles = np.concatenate([np.stack([t1, np.angle(w.sum(axis=1))], axis=-1), t], axis=1)
    X = rows_of(C[5], pose)
    for turn, c in zip(rotations_z(angles.T), C):
        X = X @ turn @ rows_of(c, pose)
    return with_last_angle(angles, X)


def with_last_angle(values: Array, X: Array) -> Array:
    """The values (k, 5) of a loop and theta_6, which turns back what the motion X (k, 4, 4) turns."""
    t6 = np.arctan2(X[:, 0, 1] - X[:, 1, 0], X[:, 0, 0] + X[:, 1, 1])
    return np.concatenate([values, t6[:, None]], axis=1)
