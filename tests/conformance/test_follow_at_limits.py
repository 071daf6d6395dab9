"""Paths on from where several joints are at their limits."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.conformance.test_cpp_self_motion import in_both
from tests.support.held_arms import held_module
from tests.support.solving import NO_COMPILER

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

STEPS = (
    (
        (0.2669, 1.8879, -1.5683, -2.1, 2.9, -1.2016, 2.9),
        (0.2573, 1.8919, -1.5667, -2.1, 2.9, -1.2087, 2.8983),
    ),
    (
        (1.109, -0.7396, -3.0, -0.6898, 2.9, -2.0, -0.8044),
        (1.1098, -0.7481, -2.9935, -0.685, 2.8915, -2.0, -0.8132),
    ),
    (
        (-0.3101, -0.4528, -3.0, 1.3542, -0.2477, -2.0, -2.9),
        (-0.3115, -0.4606, -2.998, 1.3532, -0.2541, -2.0, -2.9),
    ),
    (
        (1.2527, -2.0, -3.0, -1.515, -2.4084, 2.0, -1.1132),
        (1.2594, -2.0, -2.9905, -1.5077, -2.4122, 1.9986, -1.1131),
    ),
)


@pytest.mark.long
def test_joints_stopped_first_are_let_go_where_others_have_to_stop(tmp_path: Path) -> None:
    """The shortest motion leaves the limits of several joints, by most that of one that has to move off
    its limit when another stays on its own; a row inside all limits is less than 0.01 rad away."""
    both = in_both(held_module("shoulder_elbow_wrist", tmp_path), tmp_path, "4")
    arm = both.arm
    for step in STEPS:
        ends = np.array(step)
        assert ((ends >= arm.LOWER) & (ends <= arm.UPPER)).all()
        poses = arm.forward(ends)
        status, _, rows = both.follow(ends[0], poses)
        path = arm.follow(poses, start=ends[0])
        assert status == "OK" and path.status is arm.Status.OK
        for q in (rows, path.q):
            assert np.abs(arm.forward(q) - poses).max() < 1e-9
            assert ((q >= arm.LOWER) & (q <= arm.UPPER)).all()
            assert np.abs(q - ends[0]).max() < 0.1
        assert np.abs(rows - path.q).max() < 1e-6


@pytest.mark.long
def test_a_joint_on_its_limit_is_no_singularity(tmp_path: Path) -> None:
    """Along lines by which joints come to their limits and stay there: the others make good of it, at a
    right angle to where all joints would go, and where they cannot the limits are the reason."""
    both = in_both(held_module("shoulder_elbow_wrist", tmp_path), tmp_path, "4")
    arm, rng, stopped = both.arm, np.random.default_rng(6), 0
    for _ in range(12):
        start = rng.uniform(arm.LOWER, arm.UPPER)
        poses = np.repeat(arm.forward(start)[None], 30, axis=0)
        poses[:, :3, 3] += np.linspace(0.0, 1.0, 30)[:, None] * rng.normal(0.0, 0.06, 3)
        path = arm.follow(poses, start=start)
        status, singular, rows = both.follow(start, poses)
        assert path.status.name == status and len(rows) == path.reached
        q = path.q[: path.reached]
        sigma = np.linalg.svd(arm.jacobian(q), compute_uv=False)[:, -1]
        assert status in ("OK", "LIMITS") or sigma.min() < 0.05, (status, sigma.min())
        assert not path.singular[: path.reached][sigma > 0.01].any()
        assert singular == path.singular.sum()
        stopped += int(np.count_nonzero((q == arm.LOWER) | (q == arm.UPPER)) > 5)
    assert stopped > 2
