"""Forward kinematics and Jacobian of the runtime against products of matrices and differences."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.runtime.arrays.test_orthonormal_columns import rotations

from ikgen.runtime.python.arm.chain_kinematics import Chain, chain_of, cross, forward, jacobian

Array = NDArray[np.float64]
MOTIONS = ((0, True, 1.0, 0.3), (1, False, -2.0, 0.1), (0, True, -1.0, 0.0), (2, True, 1.0, 0.7))


@pytest.fixture
def chain() -> Chain:
    """Four motions of three joints: one joint drives two of them, one slides."""
    frames = np.tile(np.eye(4), (5, 1, 1))
    frames[:, :3, :3] = rotations(5, seed=7)
    frames[:, :3, 3] = np.random.default_rng(8).standard_normal((5, 3))
    return chain_of(frames, MOTIONS, 3)


def motion(turning: bool, v: float) -> Array:
    T = np.eye(4)
    if turning:
        T[:2, :2] = [[np.cos(v), -np.sin(v)], [np.sin(v), np.cos(v)]]
    else:
        T[2, 3] = v
    return T


def test_forward_is_the_product(chain: Chain) -> None:
    q = np.random.default_rng(9).uniform(-2.0, 2.0, (4, 5, 3))
    poses = forward(chain, q)
    for index in np.ndindex(4, 5):
        T = chain.frames[0]
        for (joint, turning, scale, offset), F in zip(MOTIONS, chain.frames[1:], strict=True):
            T = T @ motion(turning, scale * q[index][joint] + offset) @ F
        assert np.abs(poses[index] - T).max() < 1e-13


def test_jacobian_is_the_derivative(chain: Chain) -> None:
    q, h = np.array([0.4, -0.2, 1.1]), 1e-6
    J = jacobian(chain, q)
    for j in range(3):
        step = h * np.eye(3)[j]
        change = (forward(chain, q + step) - forward(chain, q - step)) / (2.0 * h)
        W = change[:3, :3] @ forward(chain, q)[:3, :3].T
        assert np.abs(J[:3, j] - change[:3, 3]).max() < 1e-8
        assert np.abs(J[3:, j] - [W[2, 1], W[0, 2], W[1, 0]]).max() < 1e-8


def test_no_configurations_have_no_poses(chain: Chain) -> None:
    assert forward(chain, np.empty((0, 3))).shape == (0, 4, 4)
    assert jacobian(chain, np.empty((0, 3))).shape == (0, 6, 3)


def test_wrong_shapes(chain: Chain) -> None:
    for q in (1.0, [0.0, 0.0], np.zeros((2, 4))):
        with pytest.raises(ValueError, match="expected"):
            forward(chain, q)
        with pytest.raises(ValueError, match="expected"):
            jacobian(chain, q)


def test_cross() -> None:
    a, b = np.random.default_rng(1).standard_normal((2, 4, 5, 3))
    assert np.abs(cross(a, b) - np.cross(a, b)).max() < 1e-15
