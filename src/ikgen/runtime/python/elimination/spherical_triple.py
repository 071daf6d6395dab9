"""Three angles whose rotation is given, `R_1 K_1 R_2 K_2 R_3 = M`: two solutions, complex ones too."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["Complex", "spherical_triple", "turns_z"]

Complex = NDArray[np.complex128]

_TRIPLE_SIGNS = np.array([[1.0], [-1.0]])
_LEAST_DIVISOR = 1e-12  # of the divisor
_PARALLEL_SINE = 1e-9  # the middle axis with one beside it: no cosine gives its angle


def turns_z(c: Complex, s: Complex) -> Complex:
    """Rotations about z (..., 3, 3) of cosines and sines (...)."""
    R = np.zeros((*c.shape, 3, 3), dtype=complex)
    R[..., 0, 0] = R[..., 1, 1] = c
    R[..., 1, 0], R[..., 0, 1] = s, -s
    R[..., 2, 2] = 1.0
    return R


def spherical_triple(K: Array, M: Array) -> tuple[Array, Complex, Complex]:
    """Cosines and sines (2, 3, n) for K (2, n, 3, 3) and M (n, 3, 3), and their divisor h (n,).

    The cosine m between the outer axes, an entry of M, gives that of the angle in the middle. Those beside
    it turn one vector into another; h = 1 - m^2, the square of the vector's part that turns.
    """
    m = M[:, 2, 2]
    h = 1.0 - m * m
    over = 1.0 / np.where(np.abs(h) < _LEAST_DIVISOR, _LEAST_DIVISOR, h)
    a, b = K[0][:, 2], K[1][:, :, 2]
    beta, gamma = a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1], a[:, 1] * b[:, 0] - a[:, 0] * b[:, 1]
    size = np.maximum(np.hypot(beta, gamma), _PARALLEL_SINE)
    x = (m - a[:, 2] * b[:, 2]) / size + 0j
    y = _TRIPLE_SIGNS * np.sqrt(1.0 - x * x)
    c2, s2 = (beta * x - gamma * y) / size, (gamma * x + beta * y) / size
    W = K[0] @ turns_z(c2, s2) @ K[1]
    e, f = W[..., :, 2], W[..., 2, :]
    p, r = M[:, :, 2], M[:, 2]
    c1 = (e[..., 0] * p[:, 0] + e[..., 1] * p[:, 1]) * over
    s1 = (e[..., 0] * p[:, 1] - e[..., 1] * p[:, 0]) * over
    c3 = (r[:, 0] * f[..., 0] + r[:, 1] * f[..., 1]) * over
    s3 = (r[:, 0] * f[..., 1] - r[:, 1] * f[..., 0]) * over
    return h, np.stack([c1, c2, c3], axis=1), np.stack([s1, s2, s3], axis=1)
