"""Arm angles at which joints come to their limits."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.held_arms import imported

from ikgen.runtime.python.arm.chain_kinematics import cross, joint_axes
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.held.arm_angle_motion import _ends, _harmonic, _roots, _turned

Array = NDArray[np.float64]
ELBOW = 3


@pytest.fixture(scope="module", params=["arm_angle", "offset_elbow"])
def arm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return imported(request.param, tmp_path_factory.mktemp("arm"))


def test_a_turned_axis_has_one_harmonic() -> None:
    rng = np.random.default_rng(1)
    line, n, m = (v / np.linalg.norm(v) for v in rng.normal(size=(3, 3)))
    a, b, c = _harmonic(line, n, m)
    for angle in (0.0, 0.4, 2.0, -1.3):
        turned = _turned(line, angle, m)
        assert n @ turned == pytest.approx(a * np.cos(angle) + b * np.sin(angle) + c, abs=1e-14)
        assert np.linalg.norm(turned) == pytest.approx(1.0) and line @ turned == pytest.approx(
            line @ m
        )
    about_z = _turned(np.array([0.0, 0.0, 1.0]), 0.3, np.array([1.0, 0.0, 2.0]))
    np.testing.assert_allclose(about_z, [np.cos(0.3), np.sin(0.3), 2.0])


def at_zero(arm: ModuleType, seed: int) -> tuple[Array, Array]:
    """A pose, and a row of it at arm angle 0."""
    rng = np.random.default_rng(seed)
    while True:
        pose = arm.forward(rng.uniform(-1.5, 1.5, 7))
        rows = arm.solve(pose, free=[0.0], limits=False).q
        if len(rows) and np.linalg.svd(arm.jacobian(rows[0]), compute_uv=False)[-1] > 0.05:
            return pose, rows[0]


def closest(arm: ModuleType, pose: Array, angle: float, joint: int, value: float) -> float:
    rows = arm.solve(pose, free=[angle], limits=False).q
    gap = np.remainder(rows[:, joint] - value + np.pi, 2.0 * np.pi) - np.pi
    return float(np.abs(gap).min())


@pytest.mark.parametrize("joint", [0, 1, 2, 4, 5, 6])
def test_the_angles_at_which_a_joint_has_a_value_are_found(arm: ModuleType, joint: int) -> None:
    """Those that a row at another angle shows, and no others."""
    motion, found = arm._ARM, 0
    sign = np.array([m[2] for m in motion.chain.motions])[:, None]
    for seed in range(4):
        pose, q = at_zero(arm, seed)
        x, y = motion.angle.plane(pose)
        axes = joint_axes(motion.chain, q[None])[:-1, 0][:, :3, 2] * sign
        for angle in (0.4, -0.9):
            there = arm.solve(pose, seed=q, free=[angle], limits=False).q[0]
            roots = list(_roots(cross(x, y), axes, joint, float(there[joint] - q[joint])))
            assert len(roots) == 2 and max(map(abs, roots)) <= np.pi + 1e-12
            assert min(closest(arm, pose, root, joint, there[joint]) for root in roots) < 1e-6
            found += min(abs(root - angle) for root in roots) < 1e-7
        assert not list(_roots(cross(x, y), axes, joint, float("nan")))
    assert found >= 6


def test_ends_are_where_some_joint_is_the_tolerance_outside(arm: ModuleType) -> None:
    count = 0
    for seed in range(4):
        pose, q = at_zero(arm, seed)
        assert _ends(arm._ARM, pose, q, False) == []
        for angle in _ends(arm._ARM, pose, q, True) or ():
            rows = arm.solve(pose, free=[angle], limits=False).q
            gap = np.minimum(np.abs(rows - arm.LOWER), np.abs(rows - arm.UPPER))
            gap[:, ELBOW] = np.inf
            count += gap.min() < 1e-6
    assert count > 8


def test_what_is_no_pose_has_no_intervals_and_a_pose_has_some(arm: ModuleType) -> None:
    pose, _ = at_zero(arm, 2)
    found = arm.self_motion(pose)
    assert found and all(-np.pi <= one.low < one.high <= np.pi for one in found)
    assert tuple(arm.self_motion(np.full((4, 4), np.nan))) == ()


def bounded(arm: ModuleType, joint: int, low: float, high: float, tolerance: float) -> Arm:
    """With limits of one joint alone."""
    lower, upper = [-4.0] * 7, [4.0] * 7
    lower[joint], upper[joint] = low, high
    policy = replace(arm._ARM.policy, limit_tolerance=tolerance)
    return replace(arm._ARM, lower=tuple(lower), upper=tuple(upper), policy=policy)


@pytest.mark.parametrize("joint", range(7))
def test_ends_are_half_the_tolerance_outside_a_limit_of_any_joint_but_the_elbow(
    arm: ModuleType, joint: int
) -> None:
    """The elbow's angle is the same at all arm angles."""
    count = 0
    for seed in range(3):
        pose, q = at_zero(arm, seed)
        low, high = (float(q[joint]) + by for by in (-0.2, 0.1))
        one = bounded(arm, joint, low, high, 1e-3)
        ends = _ends(one, pose, q, True)
        assert ends == [] or joint != ELBOW
        for angle in ends or ():
            value = arm.solve(pose, free=[angle], limits=False).q[:, joint]
            off = np.concatenate([value - (high + 5e-4), value - (low - 5e-4)])
            assert np.abs(np.remainder(off + np.pi, 2.0 * np.pi) - np.pi).min() < 1e-6
            count += 1
    assert count > 0 or joint == ELBOW
