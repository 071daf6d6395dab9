"""Roots of trigonometric polynomials by their values, all over the turn and near one angle."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.elimination.coupled_angle import (
    _FIRST_NODE,
    _NEAR,
    _NODES,
    _REAL,
    _close_roots,
    _roots,
    circle_roots,
)
from ikgen.runtime.python.elimination.hidden_angle import real_angles

Array = NDArray[np.float64]


def product(roots: Array, angle: Array) -> Array:
    """A trigonometric polynomial (N, n) of half as many harmonics as it has `roots` (N, r)."""
    return np.asarray(np.sin(0.5 * (angle - roots[:, :, None])).prod(axis=1))


def real(roots: NDArray[np.complex128]) -> tuple[NDArray[np.intp], Array]:
    """The poses (k,) and the angles (k,) of those that may be real."""
    pose, angle, _, _ = real_angles(np.tan(0.5 * roots), np.zeros(len(roots)), _REAL)
    return pose, angle


def real_within(roots: NDArray[np.complex128]) -> tuple[NDArray[np.intp], Array]:
    """The same of roots from a crowded angle, as far as they are near."""
    pose, i = np.nonzero((np.abs(roots.imag) < _REAL) & (np.abs(roots.real) <= _NEAR))
    return pose, roots.real[pose, i]


@pytest.mark.parametrize("degree", [1, 2, 5])
def test_all_real_roots_are_found_in_order(degree: int) -> None:
    wanted = np.sort(np.random.default_rng(degree).uniform(-np.pi, np.pi, (4, 2 * degree)), axis=1)
    nodes = _FIRST_NODE + 2.0 * np.pi / (2 * degree + 2) * np.arange(2 * degree + 2, dtype=float)
    values = product(wanted, nodes) * np.array([[1.0], [1e-9], [-3.0], [1e7]])
    roots, sure = _roots(values, degree)
    pose, angle = real(roots)
    assert sure.all()
    assert pose.tolist() == np.repeat(np.arange(4), 2 * degree).tolist()
    turned = np.sort(np.remainder(angle.reshape(4, -1) + np.pi, 2.0 * np.pi) - np.pi, axis=1)
    np.testing.assert_allclose(turned, wanted, atol=1e-7)


@pytest.mark.parametrize("degree", [1, 3, 16])
def test_roots_of_the_circle_s_polynomial_are_all_found(degree: int) -> None:
    """Half of them on the circle, and pairs that the circle mirrors."""
    rng = np.random.default_rng(degree)
    on = np.exp(1j * rng.uniform(-np.pi, np.pi, (3, degree - degree % 2)))
    pairs = rng.uniform(0.3, 0.9, (3, (degree + 1) // 2)) * np.exp(
        1j * rng.uniform(-np.pi, np.pi, (3, (degree + 1) // 2))
    )
    wanted = np.concatenate([on, pairs, 1.0 / pairs.conj()], axis=1)
    c = np.array([np.poly(row)[::-1] for row in wanted])
    c *= np.sqrt(
        c[:, :1].conj() / c[:, -1:]
    )  # the last is the first's conjugate, as of real values
    c /= np.sqrt(c[:, :1] * c[:, -1:])
    found = circle_roots(c)
    off = np.abs(found[:, :, None] / wanted[:, None, :] - 1.0).min(axis=1)
    assert found.shape == wanted.shape
    assert off.max() < 1e-6


def test_roots_at_nodes_and_far_from_the_circle_are_found() -> None:
    """Of `1 + cos t` and of `sin t`, which vanish at nodes, and of a constant: roots 0 and none."""
    c = np.array([[0.5, 1.0, 0.5], [0.5j, 0.0, -0.5j], [0.0, 1.0, 0.0]])
    found = circle_roots(c)
    np.testing.assert_allclose(found[0], -1.0, atol=1e-7)
    np.testing.assert_allclose(np.sort(found[1].real), [-1.0, 1.0], atol=1e-14)
    size = np.sort(np.abs(found[2]))
    assert size[0] < 1e-14 and size[1] > 1e14


def test_complex_pairs_count_where_they_are_nearly_real() -> None:
    """`cos(t - 1) = c` for c = cosh(imaginary part)."""
    nodes = _FIRST_NODE + 0.5 * np.pi * np.arange(4, dtype=float)
    for part, count in ((0.0, 2), (0.02, 2), (0.04, 0)):
        values = np.cos(nodes - 1.0)[None] - np.cosh(part)
        pose, angle = real(_roots(values, 1)[0])
        assert len(pose) == len(angle) == count
        np.testing.assert_allclose(angle, 1.0, atol=1e-6)


def test_a_polynomial_of_no_degree_has_no_roots() -> None:
    pose, _ = real(_roots(np.zeros((2, 4)), 1)[0])
    assert set(pose.tolist()) <= {0, 1}


def test_roots_near_an_angle_are_found_by_the_values_there() -> None:
    wanted = np.array([[-0.15, -0.011, 0.012, 0.19], [-0.1, 0.05, 0.3, 1.5]])
    roots, sure = _close_roots(product(wanted, _NEAR * _NODES) * np.array([[1.0], [1e-12]]))
    pose, x = real_within(roots)
    assert sure[(np.abs(roots.imag) < _REAL) & (np.abs(roots.real) <= _NEAR)].all()
    assert pose.tolist() == [0, 0, 0, 0, 1, 1]
    np.testing.assert_allclose(np.sort(x[:4]), wanted[0], atol=1e-9)
    np.testing.assert_allclose(np.sort(x[4:]), wanted[1, :2], atol=1e-9)


def test_as_many_roots_as_there_are_nodes_but_one_are_found() -> None:
    """Of Chebyshev's polynomial of degree 20, moved up."""
    pose, x = real_within(_close_roots((np.cos(20.0 * np.arccos(_NODES)) + 0.3)[None])[0])
    both = [sign * np.arccos(-0.3) + 2.0 * np.pi * np.arange(20) for sign in (1.0, -1.0)]
    wanted = np.unique(np.round(np.cos(np.concatenate(both) / 20.0), 12))
    np.testing.assert_allclose(np.sort(x), _NEAR * wanted, atol=1e-9)
    assert not pose.any() and len(wanted) == 20


def test_roots_far_from_the_real_axis_are_left_out() -> None:
    at = _NEAR * _NODES
    for part, count in ((0.02, 2), (0.04, 0)):
        _, x = real_within(_close_roots(((at - 0.05) ** 2 + part**2)[None])[0])
        np.testing.assert_allclose(x, [0.05] * count, atol=1e-6)


def test_angles_of_half_tangents_come_by_row_and_size() -> None:
    about = np.array([0.3, -0.2])
    angles = np.array([[1.2, -0.4, np.pi], [0.1, -0.1, 2.0]])
    t = np.tan(0.5 * angles).astype(complex)
    t[1, 2] = np.tan(0.5 * (2.0 + 0.05j))
    row, angle, real, clear = real_angles(t, about, accept=0.01)
    assert row.tolist() == [0, 0, 0, 1, 1] and real.tolist() == [3, 2]
    np.testing.assert_allclose(angle, [-0.1, 1.5, 0.3 + np.pi, -0.3, -0.1], atol=1e-12)
    assert clear[0]
    more, wide, _, doubt = real_angles(t, about, accept=0.1, doubtful=0.06)
    assert more.tolist() == [0, 0, 0, 1, 1, 1] and wide[-1] == pytest.approx(1.8)
    assert doubt.tolist() == [True, False]
    assert real_angles(np.array([[-1j, 1j, 0.0]]), about[:1], accept=0.01)[0].tolist() == [0]


def test_roots_that_rounding_may_move_are_not_sure() -> None:
    """Halves of a double root."""
    nodes = _FIRST_NODE + 2.0 * np.pi / 6.0 * np.arange(6, dtype=float)
    _, sure = _roots(product(np.array([[0.4, 0.4, -1.0, 2.0]]), nodes), 2)
    assert sure.sum() == 2
    nodes = _FIRST_NODE + 0.5 * np.pi * np.arange(4, dtype=float)
    _, sure = _roots(product(np.array([[0.3, 0.3]]), nodes), 1)
    assert not sure.any()
    _, sure = _close_roots(product(np.array([[0.05, 0.05, 0.1, -0.1]]), _NEAR * _NODES))
    assert not sure.all()
