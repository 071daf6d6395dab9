"""Three angles of a loop from six equations that one of them by half angles leaves without rank.

Six equations in (1, c4, s4) x (1, c5, s5), times cosine and sine of half of theta_4, are twelve in twelve
products. Right angles beside a slide may leave these with rank ten at every theta_3: no solution makes it
less. Times cosine and sine of half of theta_5 as well they are 24 in sixteen products (Sylvester's dialytic
elimination), which lose rank where there is a solution.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.elimination.hidden_angle import (
    BLURRED,
    HALF,
    NO_PIVOT,
    NODES,
    REAL,
    Resultant,
    all_clear,
    angles_off,
    half_tangents,
    loop_pencil,
    opposite_nodes,
    turned_sides,
)
from ikgen.runtime.python.elimination.loop_equations import XS, YS
from ikgen.runtime.python.rows.solution_rows import first_of_equals, rows_of

__all__ = ["both_angles", "lift_both", "null_pairs"]

_ACCEPT = 0.03  # rad: imaginary part of roots that candidates come from
_SOLVED = 1e-7  # of the equations' size: what a solution that keeps half its digits leaves of them
_DOUBLE = 1e-4  # of the size: what the second direction of a null space of two dimensions leaves
_SINGLE = 1e-3  # of what the second direction leaves: the first alone may be a null vector
_FAR = 1e3  # rad: an imaginary part of what is no root
_SAME = 1e-6  # rad: rounding moves roots with two solutions by less
_LIFT = np.einsum("aik,bjl->abijkl", HALF, HALF).reshape(4, 9, 16)
_MIXED = 0.8 + 0.6j  # a share of one shift with the other that no two solutions have in common

Complex = NDArray[np.complex128]


def both_angles(E: Array, left: Array, _: int) -> tuple[Index, Array, Index, Flags]:
    """theta_3, theta_4, theta_5 (k, 3) from the equations E (N, 6, 15) and the invariants of their left
    (1 or N, 14, 9): indices of poses (k,) in order, angles, how many solutions each pose has at least, -1
    where it does not tell, and whether those are all (N,).

    Each real root has to lead to a solution of the equations, as no other counts."""
    M = _resultant(E, left)
    angle, off, ranked, sharp = _roots(E, left, M)
    pose, root = np.nonzero(off < _ACCEPT)
    order = np.lexsort((angle[pose, root], pose))
    pose, root = pose[order], root[order]
    size = _size(M)
    sigma, rows = np.linalg.svd(_at(M, pose, angle[pose, root]))[1:]
    bound = (_SOLVED + off[pose, root]) * size[pose]
    true = sigma[:, 15] < bound  # others are of the combination alone
    off[pose[~true], root[~true]] = _FAR
    pose, root = pose[true], root[true]
    t3 = angle[pose, root]
    k, t45, again = null_pairs(rows[true], sigma[true], pose, t3)
    t = np.concatenate([t3[k, None], t45], axis=1)
    solved = np.flatnonzero(_left_over(M, pose[k], t) < _SOLVED * size[pose[k]])
    solved = solved[_first(t[solved], pose[k[solved]])]
    led = np.bincount(k[solved], minlength=len(pose))
    led[1:] = np.where(again[1:], led[:-1], led[1:])
    two = led > 1  # that lie apart: no halves of a double one
    off[pose[two], root[two]] = 0.0
    real = off[pose, root] < REAL
    least = np.bincount(pose[k[solved[real[k[solved]]]]], minlength=len(off))
    lost = np.bincount(pose[real & (led == 0)], minlength=len(off)) > 0
    return pose[k], t, np.where(ranked, least, -1), all_clear(angle, off) & sharp & ~lost


def _first(t: Array, pose: Index) -> Flags:
    """Which of the angles t (k, 3) of poses (k,), these in order, equal none before them."""
    return first_of_equals(np.repeat(t, 2, axis=1), pose, (True,) * 6, _SAME)


def lift_both(A: Array) -> Array:
    """Rows (..., 6, 9) in (1, c, s) x (1, c', s') times the half angles of both: (..., 24, 16)."""
    out = A[..., None, :, :] @ _LIFT
    return np.asarray(out.reshape(*A.shape[:-2], 4 * A.shape[-2], 16))


def _resultant(E: Array, left: Array) -> Resultant:
    """M0 (N, 24, 16), Mc, Ms with `M(theta_3) = M0 + Mc cos + Ms sin` without full rank at solutions."""
    F0, Fc, Fs = loop_pencil(E, left)
    return lift_both(F0), lift_both(Fc), lift_both(Fs)


def _at(M: Resultant, pose: Index, angle: Array) -> Array:
    """M (k, 24, 16) of poses (k,) at angles (k,)."""
    c, s = np.cos(angle)[:, None, None], np.sin(angle)[:, None, None]
    one, cosine, sine = (rows_of(m, pose) for m in M)
    return np.asarray(one + c * cosine + s * sine)


def _size(M: Resultant) -> Array:
    """How large each pose's M is, (1 or N,): a bound of its norm at any angle."""
    one, cosine, sine = (np.sqrt((m * m).sum(axis=(-2, -1))) for m in M)
    return np.asarray(one + cosine + sine)


def _roots(E: Array, left: Array, M: Resultant) -> tuple[Array, Array, Flags, Flags]:
    """Angles theta_3 (N, 32) at which `P M` is singular and how large their imaginary parts are, whether
    M has full rank elsewhere (N,), and whether rounding leaves told which of them are real (N,).

    P is M's pseudo-inverse where M is far from singular, at the angle opposite a node. What `P M` has of
    roots that M does not have lies anywhere.
    """
    opposite = opposite_nodes(M)
    k = np.linalg.slogdet(np.swapaxes(opposite, -1, -2) @ opposite)[1].argmax(axis=1)
    W = np.concatenate([lift_both(left[:, XS]), lift_both(left[:, YS])], axis=1)
    pivot = opposite[np.arange(len(k)), k]
    left_of, sigma, right_of = np.linalg.svd(pivot, full_matrices=False)
    kept: Flags = np.asarray(sigma > sigma[:, :1] / NO_PIVOT)
    over = np.divide(1.0, sigma, where=kept, out=np.zeros_like(sigma))
    P = np.swapaxes(right_of, 1, 2) @ (over[..., None] * np.swapaxes(left_of, 1, 2))
    t, largest = half_tangents(W, P @ turned_sides(E, k, 4))
    return *angles_off(t, NODES[k]), np.asarray(kept.all(axis=1)), largest < BLURRED


def null_pairs(rows: Array, sigma: Array, pose: Index, t3: Array) -> tuple[Index, Array, Flags]:
    """theta_4, theta_5 from the right singular vectors (k, 16, 16) and values (k, 16) of M at roots theta_3
    of poses (k,), both in order: indices into k, in order, pairs of angles (m, 2); and which roots (k,) are
    those before them again: one with two solutions counts twice, and is taken once."""
    double = sigma[:, 14] < _DOUBLE * sigma[:, 0]
    again = np.zeros(len(rows), dtype=bool)
    again[1:] = double[:-1] & (np.diff(pose) == 0) & (np.diff(t3) < _SAME)
    one = np.flatnonzero(~double | (sigma[:, 15] < _SINGLE * sigma[:, 14]) & ~again)
    two = np.flatnonzero(double & ~again)
    vectors = [rows[one, 15] + 0j, *_split(rows[two, 14:])]
    k = np.concatenate([one, two, two])
    order = np.argsort(k, kind="stable")
    v = np.concatenate(vectors)[order]
    return k[order], np.stack([_phase(v, 0), _phase(v, 1)], axis=-1), again


def _shift(v: Complex, angle: int) -> tuple[Complex, Complex]:
    """The parts of null vectors (..., 16) with the powers -3/2, -1/2 and 1/2 of `exp(i theta)`, theta_4 or
    (`angle` 1) theta_5, and those with the powers -1/2, 1/2 and 3/2: exp(i theta) times as much."""
    w = np.moveaxis(v.reshape(*v.shape[:-1], 4, 4), angle - 2, 0)
    one, three = w[0] + 1j * w[1], w[2] + 1j * w[3]
    back, far = w[0] - 1j * w[1], w[2] - 1j * w[3]
    return np.concatenate([far, back, one], axis=-1), np.concatenate([back, one, three], axis=-1)


def _phase(v: Complex, angle: int) -> Array:
    """An angle of null vectors (k, 16)."""
    lower, upper = _shift(v, angle)
    return np.asarray(np.angle((np.conj(lower) * upper).sum(axis=-1)))


def _split(plane: Array) -> list[Complex]:
    """The two null vectors (n, 16) of solutions in planes (n, 2, 16): those that the shifts by
    exp(i theta_4) and by exp(i theta_5) only stretch."""
    mixed: Complex = np.zeros((len(plane), 2, 2), dtype=complex)
    for angle, share in enumerate((1.0, _MIXED)):
        lower, upper = (np.swapaxes(part, 1, 2) for part in _shift(plane.astype(complex), angle))
        mixed += share * (np.linalg.pinv(lower) @ upper)
    columns = np.linalg.eig(mixed)[1].astype(complex)
    vectors: Complex = np.swapaxes(columns, 1, 2) @ plane.astype(complex)
    return [vectors[:, 0], vectors[:, 1]]


def _left_over(M: Resultant, pose: Index, t: Array) -> Array:
    """What the angles t (k, 3) leave of the equations of poses (k,)."""
    half = [
        np.stack([f(m * a) for m in (0.5, 1.5) for f in (np.cos, np.sin)], axis=-1) for a in t.T[1:]
    ]
    v = 0.5 * (half[0][:, :, None] * half[1][:, None]).reshape(-1, 16, 1)
    return np.asarray(np.linalg.norm(_at(M, pose, t[:, 0]) @ v, axis=(1, 2)))
