"""Errors and derivatives of many poses in lanes are those of poses one by one."""

from __future__ import annotations

import numpy as np
import pytest
from tests.support.chains import rotation

from ikgen.runtime.python.arm.lane_tasks import PoseLanes
from ikgen.runtime.python.arm.whole_pose import PoseTask


@pytest.mark.parametrize("size", [1.0, 0.5])
def test_lanes_have_what_poses_have(size: float) -> None:
    rng = np.random.default_rng(1)
    pose, T = (
        np.array([rotation(rng.normal(size=3), rng.uniform(-3.0, 3.0)) for _ in range(20)])
        for _ in range(2)
    )
    pose[:, :3, 3], T[:, :3, 3] = rng.normal(size=(2, 20, 3))
    J = rng.normal(size=(20, 6, 4))
    wanted = PoseTask(size).error(pose, T), PoseTask(size).rows(pose, J)
    lanes = PoseLanes(size)
    upper = (np.ascontiguousarray(X[:, :3].transpose(1, 2, 0)) for X in (pose, T))
    np.testing.assert_allclose(lanes.error(*upper).T, wanted[0], atol=1e-14)
    rows = lanes.rows(pose[:, :3].transpose(1, 2, 0), J.transpose(2, 1, 0).copy())  # type: ignore[arg-type]
    np.testing.assert_allclose(rows.transpose(2, 1, 0), wanted[1], atol=1e-14)
