"""By how much a pose misses another: the position over the size, and the turn between both."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.chains import rotation

from ikgen.runtime.python.arm.whole_pose import PoseTask

Array = NDArray[np.float64]


def poses(rng: np.random.Generator, axes: Array, angle: float) -> tuple[Array, Array]:
    """Poses, and others that are turned from them by an angle about axes of the base."""
    here = np.array(
        [rotation(axis, rng.uniform(-3.0, 3.0)) for axis in rng.normal(size=axes.shape)]
    )
    there = np.array([rotation(axis, angle) for axis in axes]) @ here
    here[:, :3, 3], there[:, :3, 3] = rng.normal(size=(2, len(axes), 3))
    return here, there


@pytest.mark.parametrize("angle", [0.0, 1e-7, 0.3, 1.5, -1.2])
def test_the_turn_is_its_axis_times_the_sine(angle: float) -> None:
    rng = np.random.default_rng(1)
    axes = np.concatenate([np.eye(3), rng.normal(size=(5, 3))])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    here, there = poses(rng, axes, angle)
    error = PoseTask(0.5).error(here, there)
    np.testing.assert_allclose(error[:, :3], (there - here)[:, :3, 3] / 0.5, atol=1e-15)
    np.testing.assert_allclose(error[:, 3:], math.sin(angle) * axes, atol=1e-15)


@pytest.mark.parametrize("angle", [1.6, 2.5, math.pi])
def test_more_than_a_quarter_turn_counts_whatever_its_sine(angle: float) -> None:
    rng = np.random.default_rng(2)
    axes = np.eye(3)
    here, there = poses(rng, axes, angle)
    error = PoseTask(1.0).error(here, there)[:, 3:]
    np.testing.assert_allclose(error, 1.0 + math.sin(angle) * axes, atol=1e-12)


def test_derivatives_are_in_the_units_of_errors() -> None:
    rng = np.random.default_rng(3)
    J = rng.normal(size=(4, 6, 6))
    found = PoseTask(0.25).rows(np.tile(np.eye(4), (4, 1, 1)), J)
    np.testing.assert_array_equal(found[:, :3], 4.0 * J[:, :3])
    np.testing.assert_array_equal(found[:, 3:], J[:, 3:])
