"""Which hidden angles suit an arm in the elimination's resultant, a trigonometric polynomial of degree 8.

The closed loop may be begun at any joint and run backwards: twelve polynomials f, each in another
angle or with other equations. On special geometry some have double roots for every pose, or simple
ones that two solutions share, and some are small on part of the circle, where rounding moves their
roots: a property of the arm, hence found at generation time. Which of the two angles next to the
hidden one has the second degree changes f by a constant only.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from ikgen.model.arrays import Array
from ikgen.runtime.python.elimination.hidden_angle import loop_pencil
from ikgen.runtime.python.elimination.loop_equations import (
    loop_constants,
    loop_equations,
    loop_order,
)

__all__ = ["RESULTANTS", "Resultant", "root_shifts", "roots_shared"]

Resultant = tuple[int, int]
"""The joint that the loop begins at (0-based), and whether it is reversed."""

RESULTANTS: tuple[Resultant, ...] = tuple(
    (start, reverse) for reverse, start in product((0, 1), range(6))
)
_NODES = 24
_FIRST = 0.1  # rad, an angle that no right angle shares
_DEGREE = 8
_NOISE = 11.0  # times the norm of what a polynomial of degree 8 has not: as in the emitted code
_ALIKE, _APART = 1e-7, 1e-3  # rad; of what two solutions share, and of what tells them apart
_ROUNDING = 5e-13
"""Share of the coefficients, at least: rounding alone reaches it hardly ever. What it really is, is another
on every processor, and choices would be with it."""


def root_shifts(frames: Array, poses: Array, q: Array) -> Array:
    """How far rounding may move the hidden angle of a known solution, (12, N) in rad, at most 1.

    frames (7, 4, 4) and poses (N, 4, 4) with lengths over the arm's; q (N, 6) in rad reaches them.
    A double root counts as moved by 1 rad.
    """
    return np.array([_shifts(frames, poses, q, plan) for plan in RESULTANTS])


def roots_shared(rows: Sequence[Array]) -> Array:
    """Whether two solutions of a pose have one hidden angle, (12, N), of rows (k, 6) in rad for each.

    As both sides of an elbow they may have the two angles next to it in common too: then it is a simple
    root, of which one of them is found.
    """
    hidden = [loop_order(*plan)[2] for plan in RESULTANTS]
    shared = np.zeros((len(RESULTANTS), len(rows)), dtype=bool)
    for i, q in enumerate(rows):
        gap = np.abs(np.remainder(q[:, None] - q + np.pi, 2.0 * np.pi) - np.pi)
        alike = (gap < _ALIKE) & (gap.max(axis=2, keepdims=True) > _APART)
        shared[:, i] = alike.any(axis=(0, 1))[hidden]
    return shared


def _shifts(frames: Array, poses: Array, q: Array, plan: Resultant) -> Array:
    order, pencil = _pencil(frames, poses, plan)
    nodes = np.linspace(_FIRST, _FIRST + 2.0 * np.pi, _NODES, endpoint=False)
    spectrum = np.fft.fft(_resultant(pencil, nodes), axis=1) / _NODES
    above = np.linalg.norm(spectrum[:, _DEGREE + 1 : _NODES - _DEGREE], axis=1)
    k = np.r_[0 : _DEGREE + 1, -_DEGREE:0]
    c = spectrum[:, k]
    noise = _NOISE * above + _ROUNDING * np.abs(c).sum(axis=1)
    hidden = -q[:, order[2]] if plan[1] else q[:, order[2]]
    slope = (c * np.exp(1j * np.outer(hidden - _FIRST, k)) * (1j * k)).sum(axis=1).real
    return np.asarray(np.minimum(noise / np.maximum(np.abs(slope), 1e-300), 1.0), dtype=np.float64)


def _pencil(frames: Array, poses: Array, plan: Resultant) -> tuple[list[int], Array]:
    """The order of the loop's joints, and the equations (3, N, 6, 9) in (1, c4, s4) x (1, c5, s5),
    their terms in 1, cos and sin of the hidden angle."""
    order, C = loop_constants([*frames[:, None]], poses, *plan)
    E, left, _ = loop_equations(C)
    return order, np.array(loop_pencil(E, left))


def _resultant(pencil: Array, angles: Array) -> Array:
    """f (N, n) of the pencil (3, N, 6, 9) at the angles (n,): det(A A^T) times the determinant of
    half angles of an orthonormal basis of A's null space."""
    terms = np.array([np.ones_like(angles), np.cos(angles), np.sin(angles)])
    A = np.einsum("tk,tnij->nkij", terms, pencil)
    Q, R = np.linalg.qr(np.swapaxes(A, -1, -2), mode="complete")
    basis = Q[..., 6:]
    one, c, s = basis[..., 0:3, :], basis[..., 3:6, :], basis[..., 6:9, :]
    half = np.concatenate(
        [np.concatenate([c - one, s], axis=-1), np.concatenate([s, -(c + one)], axis=-1)], axis=-2
    )
    size = np.prod(np.diagonal(R[..., :6, :], axis1=-2, axis2=-1), axis=-1) ** 2
    return np.asarray(size * np.linalg.det(half))
