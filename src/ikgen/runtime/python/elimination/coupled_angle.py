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
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.arm.chain_kinematics import Motion
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.elimination.back_substitution import null_angles
from ikgen.runtime.python.elimination.coupled_loop import CoupledLoop
from ikgen.runtime.python.elimination.general_6r import Candidates, Elimination
from ikgen.runtime.python.elimination.hidden_angle import lift, real_angles
from ikgen.runtime.python.rows.solution_rows import rows_of

__all__ = ["CoupledAngle", "circle_roots", "coupled_determinants"]

Complex = NDArray[np.complex128]

_FIRST_NODE = 0.05  # rad, an angle that no right angle shares
_REAL = 0.03  # rad, the imaginary part of an angle that may be real
_NOISE = 1e-13  # of a determinant's harmonics, of the largest
_OFF = 0.3  # rad: imaginary part from which on a root cannot be real
_SURE = 1e-6  # rad by which rounding may move a root that leaves no doubt
_SHARE = 0.25  # share of its imaginary part by which rounding may move a root that leaves no doubt
_GONE = 10j  # a root that is none

# Near a crowded angle (rad): how far, and the degree of polynomials of sines and cosines there.
_NEAR, _CLOSE, _SEAM, _CORE = 0.2, 20, 5e-3, 0.01
_NODES: Array = np.cos(np.pi / (_CLOSE + 1) * (np.arange(_CLOSE + 1, dtype=float) + 0.5))
_CHEBYSHEV = np.linalg.inv(np.polynomial.chebyshev.chebvander(_NODES, _CLOSE))


@dataclass(frozen=True)
class CoupledAngle:
    """Finds candidates of a chain in which one joint, and no other, turns several axes: `motions` in their
    order along the chain. An elimination's third number is the degree in that joint's angle. At `crowded`
    angles (rad) the determinant has roots at every pose, so many each; it is looked at there by itself. At
    most `share` solutions have an angle of that joint in common."""

    motions: tuple[Motion, ...]
    crowded: tuple[tuple[float, int], ...] = ()
    share: int = 1

    def __call__(
        self, F: Sequence[Array], T: Array, elimination: Elimination, _: tuple[bool, ...]
    ) -> Candidates:
        """Approximate solutions, as those of other eliminations; of as many frames F as rows and 1."""
        pose, angle, least, clear = self._angles(F, T, elimination)
        if not len(pose):
            return pose, np.zeros((0, 6)), least, clear
        loop = CoupledLoop(self.motions, [rows_of(frame, pose) for frame in F], elimination)
        at = loop.equations(T[pose], angle[:, None])
        k, pair, true = self._pairs(at.A[:, 0], pose, angle)
        least = np.minimum(least * self.share, np.bincount(pose[true], minlength=len(T)))
        return pose[k], loop.completed(at, k, angle, pair), least, clear

    def _pairs(self, A: Array, pose: Index, angle: Array) -> tuple[Index, Array, Index]:
        """theta_4, theta_5 from the equations A (k, 6, 9) at roots (k,) of poses (k,), both in order:
        indices into k, pairs of angles (m, 2); and the indices into k of roots with a solution, as often as
        they have one."""
        return *null_angles(lift(A), pose, angle), np.arange(len(A))

    def _determinants(
        self, F: Sequence[Array], T: Array, elimination: Elimination, nodes: Array
    ) -> Array:
        """What vanishes (N, n) at the solutions' angles, at angles `nodes`, (n,) or (N, n)."""
        return coupled_determinants(self.motions, F, T, elimination, nodes)

    def _angles(
        self, F: Sequence[Array], T: Array, elimination: Elimination
    ) -> tuple[Index, Array, Index, Flags]:
        """Poses (k,) in order and the roots (k,) that may be real; of each pose how many clearly are, and
        whether the others clearly are not. Roots that every pose has near a crowded angle are left out
        where no other is among them."""
        _, _, degree = elimination
        step = 2.0 * np.pi / (2 * degree + 2)
        nodes: Array = _FIRST_NODE + step * np.arange(2 * degree + 2, dtype=float)
        roots, sure = _roots(self._determinants(F, T, elimination, nodes), degree)
        roots, sure, clear = self._looked_closely(F, T, elimination, roots, sure)
        for place, order in self.crowded:
            close = self._determinants(F, T, elimination, place + _NEAR * _NODES)
            near, certain = _close_roots(close)
            core = np.abs(near) < _CORE
            alone = core.sum(axis=1) == order
            way = _way(roots, place)
            clear &= alone & ~_at_seam(way, roots.imag) & ~_at_seam(np.abs(near.real), near.imag)
            roots = np.where(way > 0.9 * _NEAR, roots, _GONE)
            left_out = (np.abs(near.real) > 0.9 * _NEAR) | (core & alone[:, None])
            roots = np.concatenate([roots, np.where(left_out, _GONE, place + near)], axis=1)
            sure = np.concatenate([sure, certain], axis=1)
        clear &= (sure | (np.abs(roots.imag) > _OFF)).all(axis=1)
        pose, angle, real, apart = real_angles(np.tan(0.5 * roots), np.zeros(len(T)), _REAL)
        return pose, angle, np.where(clear, real, 0), clear & apart

    def _looked_closely(
        self, F: Sequence[Array], T: Array, elimination: Elimination, roots: Complex, sure: Flags
    ) -> tuple[Complex, Flags, Flags]:
        """Roots (N, n): in place of those that rounding may move, and that may be real, those of
        polynomials of their neighbourhoods, which keep more digits; which of them are `_sure`, and of
        which poses (N,) none can be left out or taken twice."""
        clear = np.ones(len(T), dtype=bool)
        doubtful = ~sure & (np.abs(roots.imag) < _OFF)
        for place, _ in self.crowded:
            doubtful &= _way(roots, place) > 0.9 * _NEAR
        while doubtful.any():
            some = np.flatnonzero(doubtful.any(axis=1))
            place = roots.real[some, np.argmax(doubtful[some], axis=1)][:, None]
            frames, nodes = [rows_of(frame, some) for frame in F], place + _NEAR * _NODES
            near, certain = _close_roots(self._determinants(frames, T[some], elimination, nodes))
            way = _way(roots[some], place)
            clear[some] &= ~_at_seam(way, roots[some].imag)
            clear[some] &= ~_at_seam(np.abs(near.real), near.imag)
            more = np.full((len(T), near.shape[1]), _GONE)
            more[some] = np.where(np.abs(near.real) > 0.9 * _NEAR, _GONE, place + near)
            roots[some] = np.where(way > 0.9 * _NEAR, roots[some], _GONE)
            doubtful &= roots[:, : doubtful.shape[1]] != _GONE
            looked = np.ones(more.shape, dtype=bool)
            looked[some] = certain
            roots = np.concatenate([roots, more], axis=1)
            sure = np.concatenate([sure, looked], axis=1)
        return roots, sure, clear


def coupled_determinants(
    motions: Sequence[Motion], F: Sequence[Array], T: Array, elimination: Elimination, nodes: Array
) -> Array:
    """The determinants (N, n) of the twelve equations at angles `nodes`, (n,) or (N, n), of the coupled
    joint."""
    at = CoupledLoop(motions, F, elimination).equations(T, np.atleast_2d(nodes))
    return np.asarray(np.linalg.det(lift(at.A)))


def _way(roots: Complex, place: Array | float) -> Array:
    """How far (rad) roots (N, n) are from angles, (N, 1) or one."""
    return np.asarray(np.abs(np.remainder(roots.real - place + np.pi, 2.0 * np.pi) - np.pi))


def _at_seam(way: Array, off: Array) -> Flags:
    """The poses (N,) whose roots `way` (N, n) from a crowded angle, with imaginary parts `off`, may be of
    either polynomial."""
    seam = (np.abs(way - 0.9 * _NEAR) < _SEAM) & (np.abs(off) < _REAL)
    return np.asarray(seam.any(axis=1))


def _sure(z: Complex, off: Array, size: Array) -> Flags:
    """Which roots z (N, n) of polynomials, `off` (N, n) rad from real angles, rounding leaves as they are.
    `size` (N, n): by how many rad times the product of a root's distances from the others it moves each."""
    apart = z[:, :, None] - z[:, None, :]
    k = np.arange(z.shape[1])
    apart[:, k, k] = 1.0
    with np.errstate(all="ignore"):
        moved = size / np.abs(np.prod(apart, axis=2))
    return np.asarray(moved < np.maximum(_SURE, _SHARE * off))


def _roots(values: Array, degree: int) -> tuple[Complex, Flags]:
    """The roots (N, 2 degree), angles, of trigonometric polynomials with `values` (N, n) at the nodes, and
    which are `_sure`."""
    harmonics = np.arange(-degree, degree + 1)
    c, lead = _in_units(np.fft.fft(values, axis=1)[:, harmonics])
    z = circle_roots(c)
    size = np.abs(z)
    roots: Complex = _FIRST_NODE + np.angle(z) - 1j * np.log(size)
    with np.errstate(all="ignore"):
        harmonic = (size[:, :, None] ** np.arange(2 * degree + 1)).sum(axis=2)
        moved = _NOISE * harmonic / (size * np.abs(lead))
    return roots, _sure(z, np.abs(roots.imag), moved)


def _in_units(c: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Polynomials' coefficients (N, n) in units of each one's largest, and the last ones (N, 1) alone,
    which then are not 0."""
    c = c / np.maximum(np.abs(c).max(axis=1, keepdims=True), 1e-300)
    return c, np.where(np.abs(c[:, -1:]) < 1e-300, 1e-300, c[:, -1:])


def circle_roots(c: Complex) -> Complex:
    """The roots z (N, 2 degree) of sums of `c_k z^k`, c (N, 2 degree + 1), real on the unit circle: by
    values at as many angles as there are c, of which a trigonometric polynomial is a sum over half-angle
    cosecants (Henrici 1979). Over the one about the angle where it is largest that is rational in the
    cotangent there, and its zeros are the eigenvalues of a real matrix, diagonal but for a part of rank one
    (Golub 1973): a few times as fast as a complex companion matrix."""
    count = c.shape[1]
    turn = np.pi / count * np.arange(count)
    values = np.fft.irfft(c[:, count // 2 :], count, axis=1)
    first = np.abs(values).argmax(axis=1)
    around = (first[:, None] + np.arange(count)) % count
    values = np.take_along_axis(values, around, axis=1) * (-1.0) ** np.arange(count)
    values[np.abs(values[:, 0]) < 1e-300, 0] = 1e-300
    part = values[:, 1:] / (values[:, :1] * np.sin(turn[1:]))
    t = np.linalg.eigvals(np.diag(1.0 / np.tan(turn[1:])) + part[:, :, None])
    z: Complex = (t + 1j) / np.where(t == 1j, 1e-300, t - 1j)
    z[np.abs(z) < 1e-300] = 1e-300
    return np.asarray(z * np.exp(2j * turn[first])[:, None])


def _close_roots(values: Array) -> tuple[Complex, Flags]:
    """The roots (N, n), from a crowded angle, of determinants with `values` (N, n + 1) at the nodes near
    it, and which are `_sure`: eigenvalues of the colleague matrix (Good 1961)."""
    c, lead = _in_units(values @ _CHEBYSHEV.T)
    colleague = np.zeros((len(c), _CLOSE, _CLOSE))
    k = np.arange(_CLOSE - 1)
    colleague[:, k, k + 1] = colleague[:, k + 1, k] = 0.5
    colleague[:, 0, 1] = 1.0
    colleague[:, -1] -= 0.5 * c[:, :-1] / lead
    x: Complex = np.asarray(np.linalg.eigvals(colleague), dtype=np.complex128)
    with np.errstate(all="ignore"):
        last, wave, waves = np.ones_like(x), x, 1.0 + np.abs(x)
        for _ in range(_CLOSE - 1):
            last, wave = wave, 2.0 * x * wave - last
            waves = waves + np.abs(wave)
    moved = _NEAR * _NOISE * waves / (0.5 * 2.0**_CLOSE * np.abs(lead))
    return _NEAR * x, _sure(x, _NEAR * np.abs(x.imag), moved)
