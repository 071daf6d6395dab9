"""Normal equations are never singular, however far out a slide is."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.newton.refinement import damped, normal_inverse, of_normal

FAR_OUT = np.array(
    [[[1.00000000e+00, -2.20821717e+05, 7.65402351e+04, -3.99222707e+04, -4.54279916e-01, 8.90858984e-01],
      [-2.20821717e+05, 7.09510258e+16, 3.60386623e+13, -2.72943517e+16, -2.13895874e+08, -1.09342550e+08],
      [7.65402351e+04, 3.60386623e+13, 1.72400043e+16, -2.80986378e+16, 5.04019497e+07, 2.57652354e+07],
      [-3.99222707e+04, -2.72943517e+16, -2.80986378e+16, 5.62514019e+16, 1.01816847e-08, 7.21437498e-01],
      [-4.54279916e-01, -2.13895874e+08, 5.04019497e+07, 1.01816847e-08, 1.00000000e+00, -6.70714590e-18],
      [8.90858984e-01, -1.09342550e+08, 2.57652354e+07, 7.21437498e-01, -6.70714590e-18, 1.00000000e+00]]]
)  # fmt: skip
"""Of three slides and three turns, a slide at 1e8 m."""


def test_far_out_damping_is_more_than_rounding() -> None:
    assert np.linalg.eigvalsh(FAR_OUT[0]).min() < 0.0  # rounding
    found = damped(np.concatenate([FAR_OUT, FAR_OUT[:, ::-1, ::-1]]), 1e-14)
    assert (np.linalg.eigvalsh(found) > 0.0).all()
    assert np.isfinite(np.linalg.inv(found)).all()


def test_two_columns_far_out_that_are_the_same() -> None:
    rng = np.random.default_rng(0)
    for size in (1e3, 1e6, 1e9):
        slope = rng.uniform(-1, 1, (200, 6, 6))
        slope[:, :, 1] = np.round(slope[:, :, 1] * 64.0) * size
        slope[:, :, 2] = -slope[:, :, 1]
        slope[:, :, 3] = 2.0 * slope[:, :, 1]
        assert np.isfinite(normal_inverse(slope)).all()


def test_more_is_added_until_none_is_singular() -> None:
    """Beside 1e3 a damping of 1e-14 is rounded away; the others stay as they are."""
    J = np.random.default_rng(1).uniform(-1, 1, (3, 6, 6))
    normal = J.transpose(0, 2, 1) @ J
    normal[1] = 0.0
    normal[1, :2, :2] = 1e3
    right = np.ones((3, 6, 1))
    found = of_normal(np.linalg.solve, normal, right)
    assert np.isfinite(found).all()
    assert (found[[0, 2]] == np.linalg.solve(normal[[0, 2]], right[[0, 2]])).all()


def test_arms_of_some_metres_are_damped_as_they_were() -> None:
    J = np.random.default_rng(1).uniform(-3, 3, (50, 6, 6))
    square = J.transpose(0, 2, 1) @ J
    expected = square + 1e-14 * np.eye(6)
    np.testing.assert_array_equal(damped(square, 1e-14), expected)
    each = np.full(50, 1e-14)
    np.testing.assert_array_equal(damped(square, each), expected)
