"""Sums of products in one order of operations: the same bits on every processor.

What BLAS and LAPACK give depends on the kernels that they choose for the processor, and so do NumPy's
sines of arrays; constants that end in emitted code must not. Products and sums of arrays, element by
element, are those of IEEE 754.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ikgen.model.arrays import Array

__all__ = ["cosines", "dot", "least_squares", "length", "product", "sines"]


_MANY = 20
"""Matrices for which adding terms one by one is worth the calls."""


def product(first: Array, *others: Array) -> Array:
    """The matrix product from left to right, (..., m, k) by (..., k, n); the last may be a vector."""
    for other in others:
        if other.ndim == 1:
            first = np.asarray((first * other).sum(axis=-1))
        elif max(math.prod(first.shape[:-2]), math.prod(other.shape[:-2])) < _MANY:
            first = np.asarray((first[..., :, :, None] * other[..., None, :, :]).sum(axis=-2))
        else:
            first = _term_by_term(first, other)
    return first


def _term_by_term(first: Array, other: Array) -> Array:
    """The product of many matrices: the same bits with less memory, as sums begin with 0."""
    out = first[..., :, :1] * other[..., :1, :]
    out += 0.0
    for k in range(1, other.shape[-2]):
        out += first[..., :, k : k + 1] * other[..., k : k + 1, :]
    return np.asarray(out)


def dot(u: Array, v: Array) -> float:
    """The scalar product of two vectors."""
    return float((u * v).sum())


def length(v: Array) -> float:
    """The Euclidean norm of all elements."""
    return math.sqrt(float((v * v).sum()))


def cosines(angles: ArrayLike) -> Array:
    """The cosine of each angle (rad)."""
    return _each(math.cos, angles)


def sines(angles: ArrayLike) -> Array:
    """The sine of each angle (rad)."""
    return _each(math.sin, angles)


def _each(function: Any, angles: ArrayLike) -> Array:
    values = np.asarray(angles, dtype=np.float64)
    each = map(function, values.ravel().tolist())
    return np.fromiter(each, np.float64, values.size).reshape(values.shape)


def least_squares(A: Array, b: Array) -> Array:
    """The x (n,) with the smallest `A x - b`, A (m, n) of independent columns, by Householder's
    reflections (Golub and Van Loan, Matrix Computations, section 5.3)."""
    R, rest = A.copy(), b.copy()
    count = R.shape[1]
    for k in range(count):
        v = R[k:, k].copy()
        v[0] += math.copysign(length(v), v[0])
        square = dot(v, v)
        if square == 0.0:
            continue
        R[k:, k:] -= v[:, None] * ((2.0 / square) * (v[:, None] * R[k:, k:]).sum(axis=0))
        rest[k:] -= v * (2.0 / square * dot(v, rest[k:]))
    x = np.zeros(count)
    for k in reversed(range(count)):
        x[k] = (rest[k] - dot(R[k, k + 1 : count], x[k + 1 :])) / R[k, k]
    return x
