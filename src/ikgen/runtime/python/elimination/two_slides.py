"""Approximate solutions of four revolute joints and two slides: a trigonometric polynomial of degree 4.

Slides leave rotations alone: those of the four revolute joints close a spherical quadrilateral. One angle
hidden, the opposite one has two values, from the cosine, and the two between follow. The lengths of the
slides are eliminated by the triple product g of their directions and of the loop's displacement without
them. It is linear in the angles beside the hidden one, whose cosines and sines have the divisor
h = 1 - m^2, m the cosine between the axes beside it; so `g_+ g_- h`, over both values, has degree 4: the
eight solutions that Raghavan and Roth (1993) count, and none that is extraneous.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import cross
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.elimination.general_6r import Candidates, Elimination
from ikgen.runtime.python.elimination.hidden_angle import real_angles
from ikgen.runtime.python.elimination.loop_equations import joint_values, loop_constants
from ikgen.runtime.python.elimination.revolute_loop import (
    RevoluteLoop,
    displacement,
    revolute_loop,
    slide_lengths,
)
from ikgen.runtime.python.elimination.spherical_triple import Complex, spherical_triple, turns_z
from ikgen.runtime.python.rows.solution_rows import Turning

__all__ = ["two_slide_candidates"]

_QUARTIC_COUNT = 16
_QUARTIC_NODES = 2.0 * np.pi / _QUARTIC_COUNT * np.arange(_QUARTIC_COUNT)
_QUARTIC_OFFSETS = np.array(
    [0.1, 0.19, 0.28, 0.37]
)  # rad, of the nodes: one where no divisor is small
_WELL_APART = 1e-3  # divisors above it need no other nodes
_VANISHING = 1e-15  # value of a polynomial, lengths in the arm's, that is round-off
_BLURRED_QUARTIC = 1e-10  # value below which rounding moves roots too far to tell how many
_FOLDED_QUARTIC = 1e-5  # divisor at a root below which other solutions may have the same angle
_LARGE = 100.0  # value of a polynomial, lengths in the arm's, in whose rounding roots are lost
_QUARTIC_DEGREE = 4
_QUARTIC_HARMONICS = np.arange(-_QUARTIC_DEGREE, _QUARTIC_DEGREE + 1)


def _half_angle_powers() -> Complex:
    """Coefficients (9, 9) by powers of t = tan(a / 2) of `exp(i k a) (1 + t^2)^4`, a row for each k."""
    up, down = np.array([1j, 1.0]), np.array([-1j, 1.0])
    rows = []
    for k in _QUARTIC_HARMONICS.tolist():
        row = np.array([1.0 + 0j])
        for factor in [up] * (_QUARTIC_DEGREE + k) + [down] * (_QUARTIC_DEGREE - k):
            row = np.convolve(row, factor)
        rows.append(row[::-1])
    return np.array(rows)


_QUARTIC_POWERS = _half_angle_powers()


def _beside_hidden(loop: RevoluteLoop, angle: Array) -> tuple[Array, Complex, Complex]:
    """The divisor h (n,), and cosines and sines (2, 4, n) of all angles with the first at `angle` (n,)."""
    c, s = np.cos(angle) + 0j, np.sin(angle) + 0j
    M = np.swapaxes(loop.K[3] @ turns_z(c, s).real @ loop.K[0], -1, -2)
    h, cosines, sines = spherical_triple(loop.K[1:3], M)
    first = np.ones((2, 1, 1))
    return h, np.concatenate([first * c, cosines], 1), np.concatenate([first * s, sines], 1)


def _triple_product(p: Complex, u: Complex) -> Complex:
    """The triple product g (2, n)."""
    return np.asarray((cross(u[0], u[1]) * p).sum(axis=-1))


def _quartic_values(loop: RevoluteLoop, count: int) -> tuple[Array, Array]:
    """`g_+ g_- h` at the nodes (n, 16), and the offset of each pose's nodes (n,)."""
    pose = np.repeat(np.arange(count), _QUARTIC_COUNT)
    best, value, offset = np.full(count, -1.0), np.zeros((count, _QUARTIC_COUNT)), np.zeros(count)
    for shift in _QUARTIC_OFFSETS:
        rows = loop.of(pose)
        h, c, s = _beside_hidden(rows, np.tile(_QUARTIC_NODES + shift, count))
        g = _triple_product(*displacement(rows, c, s))
        least = np.abs(h).reshape(count, -1).min(axis=1)
        better = (least > best) & (best <= _WELL_APART)
        best = np.where(better, least, best)
        offset = np.where(better, shift, offset)
        product = (g[0] * g[1] * h).real.reshape(count, -1)
        value = np.where(better[:, None], product, value)
        if (best > _WELL_APART).all():
            break
    return value, offset


def _quartic_roots(value: Array, offset: Array) -> tuple[Complex, Array]:
    """Eigenvalues t (n, 8), and the angle a (n,) for which hidden angles are `a + 2 atan(t)`: opposite to
    the node where the polynomial is largest, so that this is the leading coefficient. Where it vanishes
    everywhere each angle is a root: eight of them."""
    spectrum = np.fft.fft(value, axis=1)[:, _QUARTIC_HARMONICS] / _QUARTIC_COUNT
    opposite = (np.abs(value).argmax(axis=1) + _QUARTIC_COUNT // 2) % _QUARTIC_COUNT
    spectrum = spectrum * np.exp(1j * _QUARTIC_NODES[opposite][:, None] * _QUARTIC_HARMONICS)
    # not a matrix product, whose rounding hangs on the number of poses
    powers = (spectrum[:, :, None] * _QUARTIC_POWERS).sum(axis=1).real
    lead = np.where(powers[:, -1:] == 0.0, 1e-300, powers[:, -1:])
    companion = np.zeros((len(value), 8, 8))
    companion[:, 1:, :-1] = np.eye(7)
    companion[:, :, -1] = -powers[:, :-1] / lead
    t = np.asarray(np.linalg.eigvals(companion), dtype=complex)
    t[np.abs(value).max(axis=1) < _VANISHING] = np.tan(0.5 * _QUARTIC_NODES[::2])
    return t, offset + _QUARTIC_NODES[opposite]


def two_slide_candidates(
    F: Sequence[Array], T: Array, elimination: Elimination, turning: Turning
) -> Candidates:
    """Approximate solutions of a chain with two joints that are not `turning`; the loop begins at the angle
    that is hidden. The result is that of `candidates`."""
    start, reverse, _ = elimination
    order, C = loop_constants(F, T, start, reverse)
    turns = [turning[j] for j in order]
    loop = revolute_loop(C, turns, len(T))
    values, offset = _quartic_values(loop, len(T))
    t, about = _quartic_roots(values, offset)
    pose, angle, least, simple = real_angles(t, about, 0.03)
    largest = np.abs(values).max(axis=1)
    least[(largest < _BLURRED_QUARTIC) | (largest > _LARGE)] = -1
    loop = loop.of(pose)
    h, c, s = _beside_hidden(loop, angle)
    simple &= np.bincount(pose[np.abs(h) < _FOLDED_QUARTIC], minlength=len(T)) == 0
    p, u = displacement(loop, c, s)
    g = np.abs(_triple_product(p, u))
    branch, k = np.nonzero(g <= 1e3 * g[::-1] + 1e-6)  # the one of which it is a root, or both
    joints = np.empty((len(k), 6))
    joints[:, np.flatnonzero(turns)] = np.arctan2(s[branch, :, k].real, c[branch, :, k].real)
    joints[:, np.flatnonzero(~np.array(turns))] = slide_lengths(p[branch, k], u[:, branch, k])
    return pose[k], joint_values(joints, order), least, simple
