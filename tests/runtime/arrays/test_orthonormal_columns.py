"""The nearest orthonormal columns, for floats and for arrays."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.orthonormal_columns import (
    columns_defect,
    determinant,
    most_defect,
    nearest_columns,
)

Array = NDArray[np.float64]


def rotations(n: int, seed: int = 0) -> Array:
    """Rotations (n, 3, 3)."""
    Q = np.linalg.qr(np.random.default_rng(seed).standard_normal((n, 3, 3)))[0]
    Q[:, :, 0] *= np.linalg.det(Q)[:, None]
    return Q


def columns(R: Array) -> tuple[tuple[float, float, float], ...]:
    return tuple((x, y, z) for x, y, z in R.T.tolist())


@pytest.mark.parametrize("off", [1e-9, 1e-6, 1e-5])
def test_nearest_is_the_polar_factor(off: float) -> None:
    rng = np.random.default_rng(1)
    for R in rotations(50):
        noisy = R + rng.uniform(-off, off, (3, 3))
        U, _, V = np.linalg.svd(noisy)
        found = np.array(nearest_columns(columns(noisy))).T
        assert np.abs(found - U @ V).max() < 1e-14
        assert columns_defect(columns(found)) < 1e-29


def test_floats_and_arrays_give_the_same_bits() -> None:
    noisy = rotations(20) + np.random.default_rng(2).uniform(-1e-6, 1e-6, (20, 3, 3))
    stacked = tuple((noisy[:, 0, j], noisy[:, 1, j], noisy[:, 2, j]) for j in range(3))
    together = np.array(nearest_columns(stacked))
    for i, R in enumerate(noisy):
        assert np.array_equal(np.array(nearest_columns(columns(R))), together[:, :, i])
        assert columns_defect(columns(R)) == columns_defect(stacked)[i]


def test_entries_off_by_the_tolerance_are_admitted() -> None:
    signs = np.random.default_rng(3).choice([-1.0, 1.0], (200, 3, 3))
    defects = [columns_defect(columns(R)) for R in rotations(200) + 1e-6 * signs]
    assert max(defects) <= most_defect(9, 1e-6)
    assert columns_defect(columns(1.00001 * np.eye(3))) > most_defect(9, 1e-6)
    assert columns_defect(((1.0, 0.0, 1e-6),)) <= most_defect(3, 1e-6)


def test_handedness() -> None:
    assert determinant(columns(np.eye(3))) == 1.0
    assert determinant(columns(np.diag([1.0, 1.0, -1.0]))) == -1.0
