"""Products and least squares in one order: right, and without BLAS's freedom."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ikgen.kinematics.fixed_order import cosines, dot, least_squares, length, product, sines

RNG = np.random.default_rng(11)


def test_products_are_those_of_matrices() -> None:
    A, B, C, v = (RNG.normal(size=s) for s in ((5, 4, 4), (4, 4), (5, 4, 4), (4,)))
    assert np.allclose(product(A, B, C), A @ B @ C, rtol=0.0, atol=1e-13)
    assert np.allclose(product(B, v), B @ v, rtol=0.0, atol=1e-14)
    assert np.allclose(product(A[:, :3, :3], A[:, :3, 3:]), A[:, :3, :3] @ A[:, :3, 3:])


def test_terms_are_added_from_left_to_right() -> None:
    """What BLAS's kernels do not agree on: rounding after each product, and the order of the sum."""
    A, B = RNG.normal(size=(4, 4)), RNG.normal(size=(4, 4))
    for i in range(4):
        for j in range(4):
            total = A[i, 0] * B[0, j]
            for k in (1, 2, 3):
                total = total + A[i, k] * B[k, j]
            assert product(A, B)[i, j] == total


def test_many_products_have_the_bits_of_each() -> None:
    signs = np.array([0.0, -0.0, 1.0, -1.0])
    A = np.where(
        RNG.random((60, 4, 4)) < 0.5, RNG.choice(signs, (60, 4, 4)), RNG.normal(size=(60, 4, 4))
    )
    B = np.where(
        RNG.random((60, 4, 7)) < 0.5, RNG.choice(signs, (60, 4, 7)), RNG.normal(size=(60, 4, 7))
    )
    many, each = product(A, B), np.array([product(a, b) for a, b in zip(A, B, strict=True)])
    assert many.tobytes() == each.tobytes()
    assert product(A, B[0]).tobytes() == np.array([product(a, B[0]) for a in A]).tobytes()


def test_vectors() -> None:
    u, v = RNG.normal(size=(2, 7))
    assert dot(u, v) == pytest.approx(float(u @ v), abs=1e-14)
    assert length(u) == pytest.approx(float(np.linalg.norm(u)), abs=1e-14)
    angles = RNG.normal(size=(3, 4))
    assert cosines(angles)[1, 2] == math.cos(angles[1, 2])
    assert sines(angles).tolist()[2][3] == math.sin(angles[2, 3])


def test_least_squares() -> None:
    for rows, columns in ((3, 3), (40, 1), (480, 30)):
        A, b = RNG.normal(size=(rows, columns)), RNG.normal(size=rows)
        expected = np.linalg.lstsq(A, b, rcond=None)[0]
        assert np.allclose(least_squares(A, b), expected, rtol=0.0, atol=1e-11)
    one = np.eye(3)[:, :2]
    assert np.allclose(least_squares(one, np.array([1.0, 2.0, 3.0])), [1.0, 2.0])
