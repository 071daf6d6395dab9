"""Where the way to the nearest pose starts: all over the limits."""

from __future__ import annotations

from math import inf, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ikgen.runtime.python.solving.projection import _clipped_step, _even_starts


def arm(turns: list[bool], size: float = 2.0) -> Any:
    return SimpleNamespace(
        period=tuple(2 * pi * one for one in turns),
        task=SimpleNamespace(size=size),
    )


@pytest.mark.parametrize("dof", [1, 3, 6, 7])
def test_they_are_multiples_of_powers_of_a_root(dof: int) -> None:
    low, high = np.linspace(-1.0, 0.5, dof), np.linspace(-0.5, 2.0, dof)
    starts = _even_starts(arm([True] * dof), low, high, 256)
    roots = np.roots([1.0, *[0.0] * (dof - 1), -1.0, -1.0])
    root = float(roots[(np.abs(roots.imag) < 1e-9) & (roots.real > 1.0)].real[0])
    part = (starts - low) / (high - low)
    for k in range(dof):
        wanted = (0.5 + np.arange(1, len(starts) + 1) * root ** -(k + 1.0)) % 1.0
        np.testing.assert_allclose(part[:, k], wanted, atol=1e-9)


@pytest.mark.parametrize(
    ("low", "high", "turns", "window"),
    [
        (-1.0, 2.0, True, (-1.0, 2.0)),
        (2.0, 5.0, True, (2.0, 5.0)),
        (-inf, inf, True, (-pi, pi)),
        (-9.0, 9.0, True, (-pi, pi)),
        (1.0, 20.0, True, (1.0, 1.0 + 2.0 * pi)),
        (-20.0, -1.0, True, (-1.0 - 2.0 * pi, -1.0)),
        (-1.0, 20.0, True, (-1.0, -1.0 + 2.0 * pi)),
        (-20.0, 0.5, True, (0.5 - 2.0 * pi, 0.5)),
        (0.1, 0.4, False, (0.1, 0.4)),
        (-inf, inf, False, (-2.0, 2.0)),
        (3.0, inf, False, (3.0, 7.0)),
        (-inf, -3.0, False, (-7.0, -3.0)),
    ],
)
def test_of_wide_limits_the_part_around_nothing_is_filled(
    low: float, high: float, turns: bool, window: tuple[float, float]
) -> None:
    """A turn of what turns, the arm's size to either side of what slides."""
    starts = _even_starts(arm([turns]), np.array([low]), np.array([high]), 256)[:, 0]
    width = window[1] - window[0]
    assert window[0] <= starts.min() < window[0] + 0.02 * width
    assert window[1] >= starts.max() > window[1] - 0.02 * width
    assert np.diff(np.sort(starts)).max() < 0.02 * width


def test_joints_at_a_limit_that_a_step_would_pass_stay() -> None:
    q, slope = np.array([[1.0, 0.0, -1.0]]), np.eye(3)[None]
    bounds = np.full(3, -1.0), np.ones(3)
    error, damping = np.array([[0.3, 0.2, 0.4]]), np.full(1, 1e-12)
    row, gain = _clipped_step(q, slope, error, damping, bounds)
    np.testing.assert_allclose(row, [[1.0, 0.2, -0.6]])
    np.testing.assert_allclose(gain, [0.2**2 + 0.4**2])  # of what is least, as far as it is linear
    row, _ = _clipped_step(q, slope, -error, damping, bounds)
    np.testing.assert_allclose(row, [[0.7, -0.2, -1.0]])
    far, _ = _clipped_step(0.0 * q, slope, 9.0 * error, damping, bounds)
    np.testing.assert_allclose(far, [[0.5, 0.5, 0.5]])  # the longest step
    half, _ = _clipped_step(0.0 * q, slope, error, np.ones(1), bounds)
    np.testing.assert_allclose(half, 0.5 * error)
