"""The angle theta_3 of a loop: roots of a resultant, as eigenvalues.

The resultant M(theta_3) is kept real by half angles and, because theta_3 turns four vectors of the left
side, its sixteen roots are the eigenvalues of a real 16x16 matrix with nothing extraneous, where Manocha
and Canny (1994) have 24x24 and (1 + x^2)^4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.elimination.loop_equations import XS, YS, ZS

__all__ = [
    "BLURRED",
    "DOUBTFUL",
    "HALF",
    "NODES",
    "NO_PIVOT",
    "REAL",
    "Resultant",
    "all_clear",
    "angles_off",
    "half_tangents",
    "hidden_angles",
    "lift",
    "loop_pencil",
    "loop_resultant",
    "opposite_nodes",
    "real_angles",
    "solved",
    "turned_sides",
]

Resultant = tuple[Array, Array, Array]
NODES = 2.0 * np.pi / 7.0 * np.arange(7)
REAL = 1e-8  # rad: imaginary part below which a root is real
DOUBTFUL = 1e-3  # rad: imaginary part below which a root may be half of a double one
_FOURFOLD = 0.03  # rad: imaginary part below which a root may be a quarter of a fourfold one
_CROWD = 8.0  # how far off the other pair of a fourfold root is at most, over the imaginary part
_NO_RANK = 1e9  # entry of the eigenproblem above which half of a root's digits are rounding
BLURRED = 1e6
"""Entry of the eigenproblem above which rounding, grown by its square, hides whether a root is real."""
NO_PIVOT = 1e11  # condition of M at the node above which nearly all are
HALF = np.array(  # of 1, c, s by half angles, times cos h and times sin h
    [
        [[1.0, 0.0, 0.0, 0.0], [0.5, 0.0, 0.5, 0.0], [0.0, 0.5, 0.0, 0.5]],
        [[0.0, 1.0, 0.0, 0.0], [0.0, -0.5, 0.0, 0.5], [0.5, 0.0, -0.5, 0.0]],
    ]
)
_LIFT = np.kron(HALF, np.eye(3))
_JITTER = np.cos(np.outer(np.arange(1, 13), np.arange(1, 13)))


def lift(A: Array) -> Array:
    """Rows (..., r, 9) in (1, c, s) x (1, c', s') times cos h and sin h, h half the first angle:
    (..., 2r, 12) in (cos h, sin h, cos 3h, sin 3h) x (1, c', s')."""
    out = np.empty((*A.shape[:-2], 2, A.shape[-2], 12))
    np.matmul(A[..., None, :, :], _LIFT, out=out)
    return out.reshape(*A.shape[:-2], 2 * A.shape[-2], 12)


def loop_resultant(E: Array, left: Array) -> Resultant:
    """M0 (N, 12, 12), Mc, Ms with `M(theta_3) = M0 + Mc cos + Ms sin` singular at solutions."""
    F0, Fc, Fs = loop_pencil(E, left)
    return lift(F0), lift(Fc), lift(Fs)


def loop_pencil(E: Array, left: Array) -> Resultant:
    """The six equations' terms (N, 6, 9) in 1, cos and sin of theta_3."""
    F0 = E[..., ZS] @ left[:, ZS]
    F0[..., 0] += E[..., 14]
    x, y = E[..., XS], E[..., YS]
    X, Y = left[:, XS], left[:, YS]
    return F0, x @ X + y @ Y, y @ X - x @ Y


def hidden_angles(
    E: Array, left: Array, M: Resultant, accept: float
) -> tuple[Index, Array, Index, Flags]:
    """The roots theta_3 with an imaginary part below `accept`: rows (k,) in order and real parts (k,),
    in order for each; per row the number of those that are clearly real, -1 where M is singular at every
    angle and roots mean nothing, and whether the others clearly are not."""
    opposite = opposite_nodes(M)
    k = np.abs(np.linalg.det(opposite)).argmax(axis=1)
    row = np.arange(len(opposite))
    N = turned_sides(E, k, 2)
    W = np.concatenate([lift(left[:, XS]), lift(left[:, YS])], axis=1)
    pivot, unit = opposite[row, k], np.broadcast_to(np.eye(12), (len(row), 12, 12))
    found = solved(pivot, np.concatenate([N, unit], axis=2))
    t, largest = half_tangents(W, found[:, :, :16])
    pose, angle, real, clear = real_angles(t, NODES[k], accept)
    condition = np.abs(pivot).max(axis=(1, 2)) * np.abs(found[:, :, 16:]).max(axis=(1, 2))
    real[(largest > _NO_RANK) | (condition > NO_PIVOT)] = -1
    return pose, angle, real, clear & (largest < BLURRED)


def opposite_nodes(M: Resultant) -> Array:
    """M at the angles opposite the nodes: (N, 7) of them."""
    c, s = np.cos(NODES)[:, None, None], np.sin(NODES)[:, None, None]
    return np.asarray(M[0][:, None] - c * M[1][:, None] - s * M[2][:, None])


def turned_sides(E: Array, node: Index, lifts: int) -> Array:
    """N (N, 6 lifts, 8 lifts) of six equations lifted to so many times as many, theta measured from the
    node (N,) of each pose: `M(theta) = M0 + N Rot(theta) W` with Rot = c + s J."""
    c, s = np.cos(NODES)[node, None, None], np.sin(NODES)[node, None, None]
    x, y = E[..., XS], E[..., YS]
    cosine, sine = c * x + s * y, c * y - s * x
    out = np.zeros((len(node), 6 * lifts, 8 * lifts))
    for a in range(lifts):
        part = out[:, 6 * a : 6 * a + 6]
        part[:, :, 4 * a : 4 * a + 4] = cosine
        part[:, :, 4 * (lifts + a) : 4 * (lifts + a) + 4] = sine
    return out


def half_tangents(W: Array, found: Array) -> tuple[Array | NDArray[np.complex128], Array]:
    """tan(theta/2) at roots theta from the node, from `found`, P N with P the inverse of `M_pi = M0 - N W`
    or what stands for it: the eigenvalues of `-J (1 + 2 W P N)`; and its largest entries (N,)."""
    half = W.shape[1] // 2
    K = np.eye(2 * half) + 2.0 * W @ found
    t = np.linalg.eigvals(np.concatenate([K[:, half:], -K[:, :half]], axis=1))
    return t, np.asarray(np.abs(K).max(axis=(1, 2)))


def real_angles(
    t: Array | NDArray[np.complex128],
    about: Array,
    accept: float,
    doubtful: float | Array = DOUBTFUL,
) -> tuple[Index, Array, Index, Flags]:
    """The angles `about + 2 atan(t)`, about (N,) and t (N, n) complex, of which the imaginary part is
    below `accept`: as `hidden_angles` has them. With one below `doubtful` (or that of each, (N, 1)) a root
    is not clearly complex."""
    angle, off = angles_off(t, about)
    row, i = np.nonzero(off < accept)
    order = np.lexsort((angle[row, i], row))
    real = (off < REAL).sum(axis=1)
    return row[order], angle[row, i][order], real, all_clear(angle, off, doubtful)


def angles_off(t: Array | NDArray[np.complex128], about: Array) -> tuple[Array, Array]:
    """Real parts (N, n) of the angles `about + 2 atan(t)`, about (N,) and t (N, n) complex, and how large
    their imaginary ones are."""
    # angle and modulus of (1 + i t) / (1 - i t)
    z = (1.0 + 1j * t) / np.where(t == -1j, 1e-300, 1.0 - 1j * t)
    off = np.abs(np.log(np.maximum(np.abs(z), 1e-300)))
    return np.asarray(about[:, None] + np.angle(z)), off


def all_clear(angle: Array, off: Array, doubtful: float | Array = DOUBTFUL) -> Flags:
    """The rows (N,) of which each root (N, n), of these real and imaginary parts, is clearly real or
    clearly complex."""
    clear = (off < doubtful).sum(axis=1) == (off < REAL).sum(axis=1)
    apart = (off < _FOURFOLD) & (off >= doubtful)
    row, root = np.nonzero(apart & clear[:, None])
    clear[row[_crowded(angle, off, row, root)]] = False
    return np.asarray(clear)


def _crowded(angle: Array, off: Array, row: Index, root: Index) -> Flags:
    """Which of some roots (k,), by row and column of the real and imaginary parts `angle` and `off` (N, n),
    may be of a fourfold one: complex, with another pair about as near as their own halves are. Rounding
    takes those apart by its fourth root, where it takes halves of a double one apart by its square root."""
    mine = off[row, root, None]
    across = np.exp(1j * (angle[row, root, None] - angle[row]))
    beside = np.hypot(np.abs(np.angle(across)), mine - off[row])
    return np.asarray((beside < _CROWD * mine).sum(axis=1) >= 4)


def solved(pivot: Array, N: Array, off: float = 0.0) -> Array:
    """`pivot^-1 N`, of pivots that are put `off` by so much of their largest entry; one that is singular
    then is put off further, and no other beside it: what is found of a pose does not hang on those that
    are solved with it."""
    size = np.abs(pivot).max(axis=(1, 2))[:, None, None] + 1e-30 if off else 0.0
    moved = pivot + off * size * _JITTER
    try:
        return np.asarray(np.linalg.solve(moved, N))
    except np.linalg.LinAlgError:
        flat = np.linalg.slogdet(moved)[0] == 0.0
        if flat.all() or not flat.any():
            return solved(pivot, N, 2.0 * off or 1e-12)
        out: Array = np.empty(N.shape)
        out[flat] = solved(pivot[flat], N[flat], 2.0 * off or 1e-12)
        out[~flat] = solved(pivot[~flat], N[~flat], off)
        return out
