"""Poses beside the one that is asked for, at which an elimination is tried too."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.elimination.displaced_poses import ASIDE, CLOSE, FARTHER

Array = NDArray[np.float64]


@pytest.mark.parametrize(
    "moves, by", [(ASIDE, 1e-3), (FARTHER, 0.03), (CLOSE[0], 1e-6), (CLOSE[1], 1e-8)]
)
def test_poses_beside_are_a_small_rigid_motion_away_on_both_sides(
    moves: tuple[Array, Array], by: float
) -> None:
    there, back = moves
    np.testing.assert_allclose(there[:3, :3] @ there[:3, :3].T, np.eye(3), atol=1e-15)
    assert np.linalg.det(there[:3, :3]) == pytest.approx(1.0)
    turn = 0.5 * np.linalg.norm(there[:3, :3] - there[:3, :3].T) / np.sqrt(2.0)
    assert turn == pytest.approx(1.4 * by, rel=0.1)
    assert np.linalg.norm(there[:3, 3]) == pytest.approx(1.5 * by, rel=0.1)
    np.testing.assert_allclose(there @ back, np.eye(4), atol=1e-15)
