"""How far an arm reaches, poses beyond it, and inputs that are no pose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.fake_arms import six_axis_oracle, six_axis_urdf, tree_of
from tests.support.task_spaces import TASK_SPACES

from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.oracle import PinocchioOracle
from ikgen.verify.reach import farthest_configuration, invalid_poses, unreachable_poses
from ikgen.verify.task_space import TaskSpace

Array = NDArray[np.float64]
SLIDE = six_axis_urdf().replace('name="j3" type="revolute"', 'name="j3" type="prismatic"')


def arm(task: str = "pose", text: str = "", joints: int = 6) -> ArmUnderTest:
    if not text and joints == 6:
        oracle = six_axis_oracle()
    else:
        names = [f"j{k + 1}" for k in range(joints)]
        oracle = PinocchioOracle(tree_of(text or six_axis_urdf()), "l0", f"l{joints}", names)
    return arm_under_test(oracle, TASK_SPACES[task], (oracle.lower, oracle.upper), ())


def reach_of(a: ArmUnderTest) -> float:
    q = farthest_configuration(a, np.random.default_rng(1))
    assert q is not None and q.shape == (a.dof,)
    return float(np.linalg.norm(a.oracle.forward(q[None])[0, :3, 3]))


def drawn_reach(a: ArmUnderTest) -> float:
    """The farthest of many configurations, revolute limits disregarded."""
    q = a.uniform(np.random.default_rng(2), 4_000, limits=False)
    return float(np.linalg.norm(a.oracle.forward(q)[:, :3, 3], axis=1).max())


@pytest.mark.parametrize("joints", [2, 3, 6])
def test_the_farthest_configuration_is_farther_than_any_drawn(joints: int) -> None:
    a = arm(joints=joints)
    assert drawn_reach(a) - 1e-9 <= reach_of(a) < 1.05 * drawn_reach(a)


def test_a_slide_reaches_to_one_of_its_limits() -> None:
    a = arm(text=SLIDE)
    for low, high in ((-0.4, 0.1), (-0.1, 0.6)):
        lower, upper = a.lower.copy(), a.upper.copy()
        lower[2], upper[2] = low, high
        bounded = arm_under_test(a.oracle, a.task, (lower, upper), ())
        assert drawn_reach(bounded) - 1e-9 <= reach_of(bounded) < 1.1 * drawn_reach(bounded)
        q = farthest_configuration(bounded, np.random.default_rng(1))
        assert q is not None and q[2] in (low, high)


def test_what_reads_no_position_or_slides_without_limits_has_no_reach() -> None:
    rng = np.random.default_rng(1)
    assert farthest_configuration(arm("rotation"), rng) is None
    a = arm(text=SLIDE)
    for low, high in ((-np.inf, 1.0), (0.0, np.inf), (-1e6, 1e6)):
        lower, upper = a.lower.copy(), a.upper.copy()
        lower[2], upper[2] = low, high
        endless = replace(a, lower=lower, upper=upper)
        assert farthest_configuration(endless, rng) is None


def test_poses_beyond_the_reach() -> None:
    a = arm()
    radius = reach_of(a)
    sets = unreachable_poses(a, 8, np.random.default_rng(1))
    assert list(sets) == ["far outside", "slightly outside"]
    far, slight = (np.linalg.norm(poses[:, :3, 3], axis=1) for poses in sets.values())
    np.testing.assert_allclose(far, 5.0 * radius + 1.0, rtol=1e-6)
    np.testing.assert_allclose(slight, radius * np.linspace(1.02, 1.12, 8), rtol=1e-6)
    away = sets["far outside"][:, :3, 3] / far[:, None]
    assert np.abs(away @ away.T - np.eye(8)).max() < 1.0 - 1e-3  # no two the same way
    for poses in sets.values():
        R = poses[:, :3, :3]
        np.testing.assert_allclose(
            R @ R.transpose(0, 2, 1), np.tile(np.eye(3), (8, 1, 1)), atol=1e-12
        )


def test_poses_off_the_manifold_of_few_joints() -> None:
    a = arm(joints=3)
    poses = unreachable_poses(a, 9, np.random.default_rng(1))["off the manifold"]
    R = poses[:, :3, :3]
    np.testing.assert_allclose(R @ R.transpose(0, 2, 1), np.tile(np.eye(3), (9, 1, 1)), atol=1e-12)
    assert len(poses) == 9 and np.linalg.det(R).min() > 0.999
    near = a.oracle.forward(a.uniform(np.random.default_rng(5), 4_000))
    gap = np.abs(poses[:, None, :3] - near[None, :, :3]).max(axis=(2, 3)).min(axis=1)
    assert gap.min() > 0.02 and gap.max() < 0.6


def test_a_tip_that_stays_where_it_is_has_nothing_slightly_outside() -> None:
    turning = six_axis_urdf().replace('<origin xyz="0 0 0.4"', '<origin xyz="0 0 0.0"')
    for text, sets in ((turning, {"far outside"}), ("", {"far outside", "slightly outside"})):
        found = unreachable_poses(arm(text=text, joints=1), 3, np.random.default_rng(1))
        assert set(found) == {*sets, "off the manifold"}


def changed(task: str) -> dict[str, NDArray[np.bool_]]:
    """Which entries of a pose are others in each input that is none."""
    pose = six_axis_oracle().forward(np.full((1, 6), 0.4))[0]
    before = pose.copy()
    found = invalid_poses(TASK_SPACES[task], pose)
    np.testing.assert_array_equal(pose, before)
    return {label: ~np.isclose(bad, pose, atol=1e-9) for label, bad in found.items()}


def test_inputs_that_are_no_pose_are_so_in_what_the_task_reads() -> None:
    found = changed("pose")
    assert len(found) == 9
    assert found["all NaN"].all()
    assert found["all infinite"][:3].all() and not found["all infinite"][3].any()
    places = {label: np.argwhere(at).tolist() for label, at in found.items()}
    assert places["NaN position"] == [[1, 3]] and places["infinite position"] == [[2, 3]]
    for label in ("NaN rotation", "scaled rotation", "zero rotation"):
        assert found[label][:3, :3].all() and found[label].sum() == 9, label
    assert found["reflection"].any(axis=0).tolist() == [False, False, True, False]
    assert places["sheared rotation"] == [[0, 1], [1, 0], [2, 2]]


@pytest.mark.parametrize(("task", "count"), [("position", 4), ("rotation", 7), ("direction", 5)])
def test_other_tasks_have_those_of_what_they_read(task: str, count: int) -> None:
    found = changed(task)
    assert len(found) == count
    space: TaskSpace = TASK_SPACES[task]
    assert ("NaN position" in found) == space.position
    assert ("NaN rotation" in found) == bool(space.orientation)


def test_wrong_rotations_are_wrong_by_as_much_as_told() -> None:
    pose = six_axis_oracle().forward(np.full((1, 6), 0.4))[0]
    found = invalid_poses(TASK_SPACES["pose"], pose)
    R = {label: bad[:3, :3] for label, bad in found.items()}
    np.testing.assert_allclose(np.linalg.svd(R["scaled rotation"])[1], 1.5)
    np.testing.assert_allclose(np.linalg.det(R["reflection"]), -1.0)
    assert 0.02 < np.abs(R["sheared rotation"] @ R["sheared rotation"].T - np.eye(3)).max() < 0.2
    assert not R["zero rotation"].any() and found["infinite position"][2, 3] == -np.inf
