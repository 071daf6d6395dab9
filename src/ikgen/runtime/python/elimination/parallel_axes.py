"""Two parallel axes of a closed loop of six: one angle hidden in a polynomial of degree 4 or 8.

In the frame between axes 5 and 6, z_1, O_1 and z_4, O_4 are directions and points of the axes beside the
parallel ones, those of axis 1 turned by theta_6, those of axis 4 by theta_5. With D = O_4 - O_1 the
products `w = z_1.z_4`, `u = z_1.D`, `v = z_4.D`, `r = D.D` and `e = z_1.(z_4 x D)` are bilinear in the
cosines and sines of both. The parallel axes' distance is a constant, and so are the products of their
direction n with z_1, z_4 and D: a line and a conic, or two lines, that (cos, sin) of theta_5 lies on.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import cross
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.arrays.rigid_motion import inverses
from ikgen.runtime.python.elimination.general_6r import Candidates, Elimination
from ikgen.runtime.python.elimination.hidden_angle import DOUBTFUL, real_angles
from ikgen.runtime.python.elimination.loop_equations import (
    joint_values,
    loop_constants,
    of_constants,
)
from ikgen.runtime.python.elimination.parallel_links import (
    MEETING,
    PLAIN,
    UPRIGHT,
    ParallelLinks,
    deviation,
    links_of,
    parallel_links,
)
from ikgen.runtime.python.elimination.parallel_turns import parallel_turns
from ikgen.runtime.python.rows.solution_rows import Turning, rows_of

__all__ = ["parallel_candidates"]

_ACCEPT = 0.03  # imaginary part of a root (rad) up to which it is tried
_SPLIT = 40.0  # times the root of the links' deviation: how far that may take halves of double roots apart
_NOTHING = 1e-14  # of what products of their sizes allow: resultants below are rounding
_CONE = np.array([-1.0, 1.0, 1.0])  # of (1, cos, sin)


def _half_angle_table(degree: int) -> tuple[Array, Array]:
    """Nodes (n,) of a trigonometric polynomial f, and the matrix from its values there, the first node's
    first, to the coefficients of `(1 + t^2)^degree f(first node - pi + 2 atan t)`, the highest first."""
    count = 2 * degree + 2
    nodes = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    table = np.zeros((count, 2 * degree + 1))
    for m in range(degree + 1):
        power = np.ones(1, dtype=complex)
        for factor in [[1j, 1.0]] * (2 * m) + [[1.0, 0.0, 1.0]] * (degree - m):
            power = np.convolve(power, factor)
        waves = np.exp(-1j * m * (nodes + np.pi)) * (2.0 if m else 1.0) / count
        table += (waves[:, None] * power).real
    return nodes, table


_OF_FOUR, _OF_EIGHT = _half_angle_table(4), _half_angle_table(8)
_TABLES = {PLAIN: _OF_FOUR, UPRIGHT: _OF_EIGHT, MEETING: _OF_EIGHT}


def _turning(v: Array, back: float) -> Array:
    """Rz(theta) v, v (n, 3), or of the angle `back` = -1 times: (n, 3, 3) times (1, cos, sin)."""
    out = np.zeros((*v.shape, 3))
    out[..., 2, 0] = v[..., 2]
    out[..., (0, 1), 1] = v[..., :2]
    out[..., 0, 2], out[..., 1, 2] = -back * v[..., 1], back * v[..., 0]
    return out


def _circle(t: Array) -> Array:
    """(1, cos, sin) of t (...): (..., 3)."""
    return np.stack([np.ones_like(t), np.cos(t), np.sin(t)], axis=-1)


def _one(*C: Array) -> Array:
    """z_1, O_1 (n, 3, 6) times (1, cos, sin) of theta_6, of links 0, 1, 2, 4 and 5."""
    *others, back, last = C
    z, o = last[..., :3, 2], last[..., :3, 3]
    z, o = np.broadcast_arrays(z, o + links_of(parallel_links(others)).h1 * z)
    one: Array = back[..., :3, :3] @ np.concatenate([_turning(z, 1.0), _turning(o, 1.0)], axis=-1)
    one[..., 3] += back[..., :3, 3]
    return one


def _four(*C: Array) -> Array:
    """z_4, O_4, z_4 x O_4 (n, 3, 9) times (1, cos, sin) of theta_5, of links 0 to 3."""
    four = inverses(C[3])
    z, o = four[..., :3, 2], four[..., :3, 3]
    z, o = np.broadcast_arrays(z, o + links_of(parallel_links(C)).h4 * z)
    return np.concatenate([_turning(v, -1.0) for v in (z, o, cross(z, o))], axis=-1)


def _products(one: Array, four: Array, six: Array) -> Array:
    """1, w, u, v, r and e (n, m, 6, 3) in (1, cos, sin) of theta_5; six (n, m, 3): those of theta_6."""
    z, o = six @ np.swapaxes(one[..., :3], -1, -2), six @ np.swapaxes(one[..., 3:], -1, -2)
    by_z, by_o, by_m = z @ four, o @ four[..., :6], cross(o, z) @ four[..., :3]
    z4, o4 = four[..., :2].sum(axis=-1), four[..., 3:5].sum(axis=-1)  # at theta_5 = 0
    out = np.zeros((*by_z.shape[:2], 6, 3))
    out[..., 0, 0] = 1.0
    out[..., 1, :], out[..., 2, :] = by_z[..., :3], by_z[..., 3:6]
    out[..., 3, :], out[..., 4, :] = -by_o[..., :3], -2.0 * by_o[..., 3:]
    out[..., 5, :] = by_z[..., 6:] - by_m
    out[..., 2, 0] -= (z * o).sum(axis=-1)
    out[..., 3, 0] += (z4 * o4).sum(axis=-1)[..., None]
    out[..., 4, 0] += (o4 * o4).sum(axis=-1)[..., None] + (o * o).sum(axis=-1)
    return out


def _curves(kind: int, C: list[Array]) -> Array:
    """The line and the conic (m, 7, 6) as sums of the products and of these by each other."""
    return of_constants(_upright_curves if kind == UPRIGHT else _other_curves, *C[:3])


def _upright_curves(*C: Array) -> Array:
    """e = 0, k^2 = 4 |a3 z_4 x D + a1 D x z_1|^2 with k a sum of products."""
    of = links_of(parallel_links(C))
    k = np.zeros((len(of.d), 6))
    k[:, :1], k[:, 1:2], k[:, 4] = of.a1**2 + of.a3**2 - of.a2**2, -2.0 * of.a1 * of.a3, 1.0
    out = np.zeros((len(k), 7, 6))
    out[:, 0, 5] = 1.0
    out[:, 1:] = k[:, :, None] * k[:, None] - 4.0 * _square_of_normals(of.a3, of.a1)
    return out


def _other_curves(*C: Array) -> Array:
    """r = a2^2 + d^2, e^2 = |c1 z_4 x D + c3 D x z_1 + d z_1 x z_4|^2."""
    of = links_of(parallel_links(C))
    out = np.zeros((len(of.d), 7, 6))
    line, conic = out[:, 0], out[:, 1:]
    line[:, :1], line[:, 4] = -(of.a2**2) - of.d**2, 1.0
    conic[:, 5, 5] = 1.0
    conic[:, 0, :1], conic[:, 1, 1:2] = -(of.d**2), of.d**2
    first, third = (of.c1 * of.d)[:, 0], (of.c3 * of.d)[:, 0]
    for i, j, x in ((0, 2, first), (1, 3, -first), (0, 3, third), (1, 2, -third)):
        conic[:, i, j] = conic[:, j, i] = x
    conic -= _square_of_normals(of.c1, of.c3)
    return out


def _square_of_normals(x: Array, y: Array) -> Array:
    """|x z_4 x D + y D x z_1|^2 as a sum (m, 6, 6) of the products by each other; x, y (m, 1)."""
    x, y = x[:, 0], y[:, 0]
    out = np.zeros((len(x), 6, 6))
    out[:, 0, 4] = out[:, 4, 0] = 0.5 * (x * x + y * y)
    out[:, 3, 3], out[:, 2, 2] = -x * x, -y * y
    out[:, 2, 3] = out[:, 3, 2] = x * y
    out[:, 1, 4] = out[:, 4, 1] = -x * y
    return out


def _resultant(kind: int, curves: Array, X: Array) -> Array:
    """What vanishes where line and conic, or both lines, meet on the circle: (n, m) of products X."""
    first = np.einsum("ni,nmik->nmk", curves[:, 0], X)
    if kind == PLAIN:
        second = X[..., 5, :]
        return np.asarray((cross(first, second) ** 2 * _CONE).sum(axis=-1), dtype=float)
    Q = np.swapaxes(X, -1, -2) @ curves[:, None, 1:] @ X
    K = np.zeros((*first.shape, 3))
    K[..., (2, 0, 1), (1, 2, 0)] = first
    K[..., (1, 2, 0), (2, 0, 1)] = -first
    G = Q @ (np.swapaxes(K, -1, -2) * _CONE) @ K
    trace = np.einsum("nmii->nm", G)
    return np.asarray(2.0 * np.einsum("nmij,nmji->nm", G, G) - trace * trace, dtype=float)


def _vanishes(kind: int, f: Array, curves: Array, X: Array) -> Flags:
    """Where resultants f (N, m) of products X (N, m, 6, 3) are rounding at every node: on a continuum."""
    line = np.sqrt((curves[:, 0] ** 2).sum(axis=-1))
    size = np.sqrt((X * X).sum(axis=(-2, -1)).max(axis=1))
    scale = (line * size) ** 2
    if kind == PLAIN:
        scale *= size**2
    else:
        scale *= scale * (curves[:, 1:] ** 2).sum(axis=(1, 2)) * size**4
    return np.asarray(np.abs(f).max(axis=1) < _NOTHING * scale)


def _fifth(kind: int, curves: Array, X: Array) -> Array:
    """(1, cos, sin) of theta_5 (k, 3) at roots of the resultant, of products X (k, 6, 3)."""
    first = (curves[:, :1] @ X)[:, 0]
    if kind == PLAIN:
        both = cross(first, X[:, 5])
        both *= np.copysign(1.0, both[:, :1])
        size = np.hypot(both[:, 1], both[:, 2]) + 1e-300
        return np.stack([np.ones_like(size), both[:, 1] / size, both[:, 2] / size], axis=-1)
    a, b, c = first.T
    square = b * b + c * c + 1e-300
    half = np.sqrt(np.maximum(square - a * a, 0.0))
    ends = np.ones((2, len(X), 3))
    ends[0, :, 1], ends[0, :, 2] = -a * b - half * c, half * b - a * c
    ends[1, :, 1], ends[1, :, 2] = half * c - a * b, -half * b - a * c
    ends[..., 1:] /= square[:, None]
    at = (X @ ends[..., None])[..., 0]
    off = np.abs(((at[..., None, :] @ curves[:, 1:])[..., 0, :] * at).sum(axis=-1))
    return np.asarray(np.where((off[0] <= off[1])[:, None], ends[0], ends[1]))


def _directions(kind: int, of: ParallelLinks, z: Array, y: Array, D: Array) -> Array:
    """The parallel axes' directions (k, 3) or (2 k, 3) from z_1, z_4 and D (k, 3)."""
    n = cross(z, y)
    if kind == MEETING:
        n = of.c1 * cross(y, D) + of.c3 * cross(D, z) + of.d * n
        n *= np.copysign(1.0, (z * cross(y, D)).sum(axis=-1))[:, None]
    n /= np.sqrt((n * n).sum(axis=-1))[:, None] + 1e-300
    if kind == PLAIN:
        return np.concatenate([n, -n])
    if kind == UPRIGHT:
        k = (D * D).sum(axis=-1) - (2.0 * of.a1 * of.a3)[:, 0] * (z * y).sum(axis=-1)
        k += (of.a1**2 + of.a3**2 - of.a2**2)[:, 0]
        k *= (n * (of.a3 * cross(y, D) + of.a1 * cross(D, z))).sum(axis=-1)
        n *= np.copysign(1.0, k)[:, None]
    return np.asarray(n)


def _real_roots(kind: int, f: Array, doubtful: Array) -> tuple[Index, Array, Index, Flags]:
    """As `real_angles`, of polynomials with values f (N, n) at the nodes: eigenvalues of companion
    matrices, in half angles about the opposite of the node where f is largest."""
    nodes, table = _TABLES[kind]
    k = np.abs(f).argmax(axis=1)
    powers = np.take_along_axis(f, (k[:, None] + np.arange(len(nodes))) % len(nodes), 1) @ table
    size = powers.shape[1] - 1
    companion = np.zeros((len(f), size, size))
    companion[:, range(1, size), range(size - 1)] = 1.0
    companion[:, 0] = -powers[:, 1:] / np.where(powers[:, :1] == 0.0, 1.0, powers[:, :1])
    return real_angles(np.linalg.eigvals(companion), nodes[k] - np.pi, _ACCEPT, doubtful)


def parallel_candidates(
    F: Sequence[Array], T: Array, elimination: Elimination, _: Turning
) -> Candidates:
    """Approximate solutions of a loop whose second and third axes are parallel and whose links beside them
    are of a kind in `parallel_links`: which is the third number. The result is that of `candidates`."""
    start, reverse, kind = elimination
    order, C = loop_constants(F, T, start, reverse)
    measures, curves = parallel_links(C), _curves(kind, C)
    links = links_of(measures)
    one, four = of_constants(_one, *C[:3], *C[4:]), of_constants(_four, *C[:4])
    X = _products(one, four, _circle(_TABLES[kind][0])[None])
    f = _resultant(kind, curves, X)
    doubtful = np.maximum(DOUBTFUL, _SPLIT * deviation(kind, links) ** 0.5)
    pose, t6, least, clear = _real_roots(kind, f, doubtful)
    noise = _vanishes(kind, f, curves, X)
    least[noise], clear[noise] = -1, False
    if not len(pose):
        return pose, np.zeros((0, 6)), least, clear
    one, four, six = rows_of(one, pose), rows_of(four, pose), _circle(t6)
    five = _fifth(kind, rows_of(curves, pose), _products(one, four, six[:, None])[:, 0])
    z, o = ((one[..., i : i + 3] @ six[..., None])[..., 0] for i in (0, 3))
    y, p = ((four[..., i : i + 3] @ five[..., None])[..., 0] for i in (0, 3))
    n = _directions(kind, links_of(rows_of(measures, pose)), z, y, p - o)
    each = len(n) // len(pose)
    pose, t6 = np.tile(pose, each), np.tile(t6, each)
    t5 = np.tile(np.arctan2(five[:, 2], five[:, 1]), each)
    side = links_of(rows_of(measures, pose)).side
    angles = parallel_turns([rows_of(c, pose) for c in C], side, n, t5, t6)
    return pose, joint_values(angles, order, reverse), np.where(noise, -1, each * least), clear
