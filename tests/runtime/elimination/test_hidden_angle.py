"""Linear equations at many hidden angles at once."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.elimination.both_half_angles import lift_both
from ikgen.runtime.python.elimination.hidden_angle import _JITTER, lift, solved


def test_a_singular_matrix_changes_nothing_beside_it() -> None:
    random = np.random.default_rng(3)
    pivot, N = random.normal(size=(5, 12, 12)), random.normal(size=(5, 12, 8))
    pivot[2, :, 4] = 0.0
    found = solved(pivot, N)
    assert np.isfinite(found).all()
    for i in range(5):
        np.testing.assert_array_equal(found[i], solved(pivot[i : i + 1], N[i : i + 1])[0])
    regular = [0, 1, 3, 4]
    assert np.abs(pivot[regular] @ found[regular] - N[regular]).max() < 1e-12


def test_a_matrix_that_is_singular_with_what_is_added_is_put_off_further() -> None:
    """As the matrix of a pencil that was put off is at the pencil's own roots."""
    pivot = np.random.default_rng(4).uniform(-0.5, 0.5, (1, 12, 12))
    pivot[0, 0], pivot[0, 1] = 0.0, -(1e-10 * 1.0 * _JITTER[1])
    pivot[0, 2, 0] = 1.0  # the largest
    put_off = pivot + 1e-10 * _JITTER
    assert not put_off[0, 1].any()
    found = solved(pivot, np.eye(12)[None])
    assert np.isfinite(found).all() and np.abs(found).max() > 1e6


def test_those_that_are_put_off_further_are_put_off_as_far_as_alone() -> None:
    random = np.random.default_rng(5)
    N = random.normal(size=(3, 12, 12))
    pivot = random.uniform(-0.5, 0.5, (3, 12, 12))
    pivot[:, 2, 0] = 1.0  # the largest
    pivot[1, 0], pivot[1, 1] = 0.0, -(1e-12 * 1.0 * _JITTER[1])
    for off in (0.0, 1e-12):
        found = solved(pivot, N, off)
        for i in range(3):
            np.testing.assert_array_equal(found[i], solved(pivot[i : i + 1], N[i : i + 1], off)[0])


def test_rows_times_half_angles_are_rows_in_these() -> None:
    A, w = np.random.default_rng(6).normal(size=(4, 5, 3, 9)), np.array([1.0, 0.6, -0.8])
    angle = 1.3
    whole = np.kron([1.0, np.cos(angle), np.sin(angle)], w)
    half = [f(k * 0.5 * angle) for k in (1.0, 3.0) for f in (np.cos, np.sin)]
    found = lift(A) @ np.kron(half, w)
    assert lift(A).shape == (4, 5, 6, 12)
    np.testing.assert_allclose(found[..., :3], np.cos(0.5 * angle) * (A @ whole), atol=1e-14)
    np.testing.assert_allclose(found[..., 3:], np.sin(0.5 * angle) * (A @ whole), atol=1e-14)


def test_no_rows_are_lifted_to_none() -> None:
    assert lift(np.zeros((0, 26, 6, 9))).shape == (0, 26, 12, 12)
    assert lift(np.zeros((4, 0, 6, 9))).shape == (4, 0, 12, 12)
    assert lift_both(np.zeros((0, 26, 6, 9))).shape == (0, 26, 24, 16)
