"""Approximate solutions of four revolute joints and two slides: a trigonometric polynomial of degree 4.

Slides leave rotations alone: those of the four revolute joints close a spherical quadrilateral. One angle
hidden, the opposite one has two values, from the cosine, and the two between follow. The lengths of the slides
are eliminated by the triple product g of their directions and of the loop's displacement without them. It is
linear in the angles beside the hidden one, whose cosines and sines have the divisor h = 1 - m^2, m the cosine
between the axes beside it; so `g_+ g_- h`, over both values, has degree 4 in the hidden angle: the eight
solutions that Raghavan and Roth (1993) count, and none that is extraneous.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.array_types import Array
from ikgen.runtime.python.chain_kinematics import cross
from ikgen.runtime.python.general_6r import Candidates, Elimination, Turning
from ikgen.runtime.python.hidden_angle import real_angles
from ikgen.runtime.python.loop_equations import loop_constants

__all__ = ["two_slide_candidates"]

Complex = NDArray[np.complex128]

_COUNT = 16
_NODES = 2.0 * np.pi / _COUNT * np.arange(_COUNT)
_OFFSETS = np.array([0.1, 0.19, 0.28, 0.37])  # rad, of the nodes: one where no divisor is small
_DEGREE = 4
_HARMONICS = np.arange(-_DEGREE, _DEGREE + 1)


def _half_angle_powers() -> Complex:
    """Coefficients (9, 9) by powers of t = tan(a / 2) of `exp(i k a) (1 + t^2)^4`, a row for each k."""
    up, down = np.array([1j, 1.0]), np.array([-1j, 1.0])
    rows = []
    for k in _HARMONICS.tolist():
        row = np.array([1.0 + 0j])
        for factor in [up] * (_DEGREE + k) + [down] * (_DEGREE - k):
            row = np.convolve(row, factor)
        rows.append(row[::-1])
    return np.array(rows)


_POWERS = _half_angle_powers()


@dataclass(frozen=True)
class _Quadrilateral:
    """The loop `R_1 K_1 ... R_4 K_4 = 1` of the revolute joints (n of them): rotations K (4, n, 3, 3) and
    displacements k (4, n, 3) behind each, the slides' directions u (2, n, 3), each behind the joint `at`."""

    K: Array
    k: Array
    u: Array
    at: tuple[int, ...]

    def of(self, pose: NDArray[np.intp]) -> _Quadrilateral:
        """Those of some poses."""
        return _Quadrilateral(self.K[:, pose], self.k[:, pose], self.u[:, pose], self.at)


def _quadrilateral(C: list[Array], turns: list[bool]) -> _Quadrilateral:
    count = max(len(c) for c in C)
    frames = [np.broadcast_to(c, (count, 4, 4)) for c in C]
    behind: list[Array] = []
    u: list[Array] = []
    at: list[int] = []
    for frame, turn in zip(frames, turns):
        if turn:
            behind.append(frame)
            continue
        at.append(len(behind) - 1)
        u.append(behind[-1][:, :3, 2])
        behind[-1] = behind[-1] @ frame
    X = np.array(behind)
    return _Quadrilateral(X[..., :3, :3], X[..., :3, 3], np.array(u), tuple(at))


def _turn(c: Complex, s: Complex) -> Complex:
    R = np.zeros((*c.shape, 3, 3), dtype=complex)
    R[..., 0, 0] = R[..., 1, 1] = c
    R[..., 1, 0], R[..., 0, 1] = s, -s
    R[..., 2, 2] = 1.0
    return R


def _others(loop: _Quadrilateral, angle: Array) -> tuple[Array, Complex, Complex]:
    """The divisor h (n,), and the cosines and sines (2, 4, n) of all four angles with the first at `angle` (n,)."""
    K = loop.K
    first = _turn(np.cos(angle) + 0j, np.sin(angle) + 0j)
    M = np.swapaxes(K[3] @ first.real @ K[0], -1, -2)
    m = M[:, 2, 2]
    h = 1.0 - m * m
    over = 1.0 / np.where(np.abs(h) < 1e-12, 1e-12, h)
    a, b = K[1][:, 2], K[2][:, :, 2]
    beta, gamma = a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1], a[:, 1] * b[:, 0] - a[:, 0] * b[:, 1]
    rho = np.hypot(beta, gamma) + 1e-300
    x = (m - a[:, 2] * b[:, 2]) / rho + 0j
    y = np.array([[1.0], [-1.0]]) * np.sqrt(1.0 - x * x)
    c3, s3 = (beta * x - gamma * y) / rho, (gamma * x + beta * y) / rho
    W = K[1] @ _turn(c3, s3) @ K[2]
    e, f = W[..., :, 2], W[..., 2, :]
    p, r = M[:, :, 2], M[:, 2]
    c2 = (e[..., 0] * p[:, 0] + e[..., 1] * p[:, 1]) * over
    s2 = (e[..., 0] * p[:, 1] - e[..., 1] * p[:, 0]) * over
    c4 = (r[:, 0] * f[..., 0] + r[:, 1] * f[..., 1]) * over
    s4 = (r[:, 0] * f[..., 1] - r[:, 1] * f[..., 0]) * over
    one = np.ones_like(c3)
    c, s = [one * np.cos(angle), c2, c3, c4], [one * np.sin(angle), s2, s3, s4]
    return h, np.stack(c, axis=1), np.stack(s, axis=1)


def _displacement(loop: _Quadrilateral, c: Complex, s: Complex) -> tuple[Complex, Complex]:
    """The loop's displacement (2, n, 3) without the slides, and their directions (2, 2, n, 3)."""
    A: Complex = np.broadcast_to(np.eye(3) + 0j, (*c[:, 0].shape, 3, 3))
    p = np.zeros((*c[:, 0].shape, 3), dtype=complex)
    u = []
    for i in range(4):
        A = A @ _turn(c[:, i], s[:, i])
        p = p + (A @ loop.k[i][..., None])[..., 0]
        u += [(A @ loop.u[j][..., None])[..., 0] for j in range(2) if loop.at[j] == i]
        A = A @ loop.K[i]
    return p, np.array(u)


def _polynomial(loop: _Quadrilateral, count: int) -> tuple[Array, Array]:
    """`g_+ g_- h` at the nodes (n, 16), and the offset of each pose's nodes (n,)."""
    pose = np.repeat(np.arange(count), _COUNT)
    best, value, offset = np.full(count, -1.0), np.zeros((count, _COUNT)), np.zeros(count)
    for shift in _OFFSETS:
        rows = loop.of(pose)
        h, c, s = _others(rows, np.tile(_NODES + shift, count))
        p, u = _displacement(rows, c, s)
        g = (cross(u[0], u[1]) * p).sum(axis=-1)
        least = np.abs(h).reshape(count, -1).min(axis=1)
        better = least > best
        best = np.where(better, least, best)
        offset = np.where(better, shift, offset)
        product = (g[0] * g[1] * h).real.reshape(count, -1)
        value = np.where(better[:, None], product, value)
        if (best > 1e-3).all():
            break
    return value, offset


def _roots(value: Array, offset: Array) -> tuple[Array, Array]:
    """Eigenvalues t (n, 8), and the angle a (n,) of which hidden angles are `a + 2 atan(t)`: the opposite of the
    node where the polynomial is largest, so that it is the leading coefficient."""
    spectrum = np.fft.fft(value, axis=1)[:, _HARMONICS] / _COUNT
    opposite = (np.abs(value).argmax(axis=1) + _COUNT // 2) % _COUNT
    spectrum = spectrum * np.exp(1j * _NODES[opposite][:, None] * _HARMONICS)
    powers = (spectrum @ _POWERS).real
    lead = np.where(powers[:, -1:] == 0.0, 1e-300, powers[:, -1:])
    companion = np.zeros((len(value), 8, 8))
    companion[:, 1:, :-1] = np.eye(7)
    companion[:, :, -1] = -powers[:, :-1] / lead
    return np.linalg.eigvals(companion), offset + _NODES[opposite]


def two_slide_candidates(F: Array, T: Array, plan: Elimination, turning: Turning) -> Candidates:
    """As `candidates`, of a chain with two joints that are not `turning`; the plan begins at the hidden angle."""
    order, C = loop_constants(F, T, *plan[:2])
    turns = [turning[j] for j in order]
    loop = _quadrilateral(C, turns)
    value, offset = _polynomial(loop, len(T))
    t, node = _roots(value, offset)
    pose, angle, least, simple = real_angles(t, node, 0.03)
    loop = loop.of(pose)
    _, c, s = _others(loop, angle)
    p, u = _displacement(loop, c, s)
    g = np.abs((cross(u[0], u[1]) * p).sum(axis=-1))
    both = np.stack([g[0] <= 1e3 * g[1] + 1e-6, g[1] <= 1e3 * g[0] + 1e-6])
    branch, k = np.nonzero(both)
    U = np.moveaxis(u[:, branch, k].real, 0, -1)
    lengths = -(np.linalg.pinv(U) @ p[branch, k].real[..., None])[..., 0]
    values = np.empty((len(k), 6))
    values[:, np.flatnonzero(turns)] = np.arctan2(s[branch, :, k].real, c[branch, :, k].real)
    values[:, np.flatnonzero(~np.array(turns))] = lengths
    q = np.empty_like(values)
    q[:, order] = -values if plan[1] else values
    return pose[k], q, least, simple
