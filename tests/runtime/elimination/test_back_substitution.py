"""Angles from null vectors: one solution of a root, and two."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.elimination.back_substitution import _split, null_angles

Array = NDArray[np.float64]


def null_vector(t4: float, t5: float) -> Array:
    """(cos h w, sin h w, cos 3h w, sin 3h w), with w = (1, c5, s5) and h half of theta_4."""
    w, h = np.array([1.0, np.cos(t5), np.sin(t5)]), 0.5 * t4
    return np.concatenate([np.cos(h) * w, np.sin(h) * w, np.cos(3 * h) * w, np.sin(3 * h) * w])


def singular(rng: np.random.Generator, *vectors: Array) -> Array:
    """A matrix (12, 12) with these in its null space, and no others."""
    N = np.linalg.qr(np.stack(vectors, axis=1))[0]
    return np.asarray(rng.normal(size=(12, 12)) @ (np.eye(12) - N @ N.T))


def along(a: Array, b: Array) -> float:
    """The cosine between two lines."""
    return float(abs(a @ b) / np.linalg.norm(a) / np.linalg.norm(b))


@pytest.mark.parametrize("apart", [0.0, 0.7, 2.9])
def test_two_solutions_in_a_plane_of_null_vectors_are_split(apart: float) -> None:
    """By theta_4, and where that is the same by w, whichever vectors span the plane."""
    rng = np.random.default_rng(2)
    for _ in range(40):
        t4, t5, other = rng.uniform(-np.pi, np.pi, 3)
        pair = null_vector(t4, t5), null_vector(t4 + apart, other)
        N = np.linalg.qr(np.stack(pair, axis=1) @ rng.normal(size=(2, 2)))[0]
        found = _split(N[None])[0].T
        cosines = np.array([[along(v, w) for w in pair] for v in found])
        assert min(cosines.max(axis=0)) > 1.0 - 1e-10
        assert cosines[0].argmax() != cosines[1].argmax()


def test_the_angles_of_single_roots_come_in_order() -> None:
    rng = np.random.default_rng(3)
    wanted = rng.uniform(-np.pi, np.pi, (5, 2))
    M = np.array([singular(rng, null_vector(*pair)) for pair in wanted])
    index, found = null_angles(M, np.arange(5), rng.uniform(-3.0, 3.0, 5))
    assert index.tolist() == [0, 1, 2, 3, 4]
    np.testing.assert_allclose(found, wanted, atol=1e-9)


@pytest.mark.parametrize("same", [False, True])
def test_a_root_with_two_solutions_gives_both_and_is_taken_once(same: bool) -> None:
    """Rounding makes two roots of it, side by side; the same root of another pose is another one."""
    rng = np.random.default_rng(4)
    pair = np.array([[0.4, 1.1], [0.4 if same else -1.3, -2.0]])
    double = singular(rng, *(null_vector(*angles) for angles in pair))
    one = singular(rng, null_vector(2.0, 0.3))
    M = np.array([one, double, double, double])
    pose, t3 = np.array([0, 0, 0, 1]), np.array([-0.9, 0.5, 0.5 + 1e-8, 0.5])
    index, found = null_angles(M, pose, t3)
    assert sorted(index.tolist()) == [0, 1, 1, 3, 3]
    np.testing.assert_allclose(found[index == 0], [[2.0, 0.3]], atol=1e-9)
    for k in (1, 3):
        mine = found[index == k]
        np.testing.assert_allclose(mine[np.argsort(mine[:, 1])], pair[::-1], atol=1e-7)
    apart = null_angles(M[1:3], np.zeros(2, np.intp), np.array([0.5, 0.6]))[0]
    assert sorted(apart.tolist()) == [0, 0, 1, 1]
