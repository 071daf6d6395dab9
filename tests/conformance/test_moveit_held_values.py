"""What the emitted MoveIt plugin says of poses that few values of held joints reach, or none."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
import tests.support.moveit_driver as driver
from numpy.typing import NDArray
from tests.support.moveit_arms import (
    FRANKA,
    Arm,
    made_arm,
    missing_tools,
    needs,
    running,
    with_joint,
)
from tests.support.moveit_driver import Plugin, Search
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.model.joint_tree import Limits

Array = NDArray[np.float64]

LONG = 60.0
"""A timeout (s) that no test waits for."""
SOON = 20.0
"""Until when an answer is early, also on a busy machine."""


def folder(factory: pytest.TempPathFactory, name: str) -> Path:
    if missing := missing_tools("g++"):
        pytest.skip(missing)
    return factory.mktemp(name)


@pytest.fixture(scope="module")
def turning(tmp_path_factory: pytest.TempPathFactory) -> Arm:
    """Three links in a plane, 0.3 m each, and a slide across it, without limits; the elbow j1 is held."""
    robot = folder(tmp_path_factory, "turning") / "turning.urdf"
    origins = [("0 0 0.2", "0 0 0"), *[("0.3 0 0", "0 0 0")] * 3]
    arm = made_arm(serial_urdf(robot, origins, slides={3: "0 0 1"}), task="position")
    assert arm.module.held == ("j1",)
    return arm


@pytest.fixture(scope="module")
def on_rail(tmp_path_factory: pytest.TempPathFactory) -> Arm:
    """Two links with a wrist on a rail; the rail j0 and the wrist j4 are held."""
    robot = folder(tmp_path_factory, "on_rail") / "on_rail.urdf"
    serial_urdf(
        robot,
        [(xyz, "0 0 0") for xyz in ("0 0 0", "0 0 0.3", "0 0 0.1", "0.4 0 0", "0.3 0 0")],
        axes=["1 0 0", "0 0 1", "0 1 0", "0 1 0", "0 1 0"],
        slides={0: "1 0 0"},
        limit=[(-1.0, 1.0), (-3.0, 3.0), (-1.5, 1.5), (-2.5, 2.5), (-2.5, 2.5)],
        tip=("0.2 0 0", "0 0 0"),
    )
    arm = made_arm(robot, task="position")
    assert arm.module.held == ("j0", "j4")
    return arm


def search(plugin: Plugin, arm: Arm, pose: Array, *words: str, **options: object) -> Search:
    """A search with a long timeout, of which every answer but TIMED_OUT is early."""
    seed = options.pop("seed", np.zeros(len(arm.joints)))
    start = time.perf_counter()
    found = plugin.search(pose, seed, *words, **{"timeout": LONG} | options)  # type: ignore[arg-type]
    assert found.code == driver.TIMED_OUT or time.perf_counter() - start < SOON
    return found


def at(x: float, y: float, z: float) -> Array:
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


# --- one held joint ---------------------------------------------------------------------------------


@needs(FRANKA)
def test_poses_that_only_values_outside_the_limits_reach_end_early(
    arm: Arm, tmp_path: Path
) -> None:
    """Limits of the robot model that are wider than the description's let nothing more in."""
    python = import_text(emit_module(arm.module), tmp_path)
    low, high = arm.bounds
    q = np.random.default_rng(12).uniform(low - 1.5, high + 1.5, (50, len(low)))
    poses = [pose for pose in arm.pose(q) if not python.self_motion(pose)]
    assert len(poses) > 3
    wider = arm.tree
    for name in arm.joints:
        wider = with_joint(wider, name, limits=Limits(-7.0, 7.0))
    for tree in (arm.tree, wider):
        with running(arm, tree) as plugin:
            assert plugin.initialize(arm.base, arm.tip).good
            for pose in poses:
                found = search(plugin, arm, pose, seed=0.5 * (low + high))
                assert found.code == driver.NO_IK_SOLUTION


def test_a_pose_that_a_narrow_interval_reaches_is_found(turning: Arm) -> None:
    """Nearly stretched: the elbow turns by 1e-5 and less. Its value is that on the seed's turn."""
    with running(turning) as plugin:
        assert plugin.initialize(turning.base, turning.tip).good
        for angle in np.linspace(-3.0, 3.0, 7):
            reach = 0.9 - 1e-12
            pose = at(reach * np.cos(angle), reach * np.sin(angle), 0.5)
            for turns in (0, -2, 3):
                seed = np.array([0.0, 1.0 + turns * 2.0 * np.pi, 0.0, 0.0])
                found = search(plugin, turning, pose, seed=seed, timeout=0.0)
                assert found.good
                assert np.abs(turning.pose(found.q)[:3, 3] - pose[:3, 3]).max() < 1e-9
                assert abs(found.q[1] - turns * 2.0 * np.pi) < 1e-4
            assert (
                search(plugin, turning, pose * [[1.001], [1.001], [1], [1]]).code
                == driver.NO_IK_SOLUTION
            )


def test_values_that_limits_or_reach_leave_out_do_not_count(turning: Arm) -> None:
    pose = at(0.9 - 1e-6, 0.0, 0.5)  # the elbow is within 0.003 of 0
    for limits, good in (((-1.0, 1.0), True), ((0.1, 3.0), False), ((6.0, 7.0), True)):
        narrow = with_joint(turning.tree, "j1", limits=Limits(*limits))
        with running(turning, narrow) as plugin:
            assert plugin.initialize(turning.base, turning.tip).good
            found = search(plugin, turning, pose)
            assert (found.good, found.code == driver.NO_IK_SOLUTION) == (good, not good)
            assert not good or limits[0] <= found.q[1] <= limits[1]
    with running(turning) as plugin:
        assert plugin.initialize(turning.base, turning.tip).good
        for reach, good in ((1.1, True), (0.9, False)):
            near = {"limits": [10.0, reach, 10.0, 10.0], "seed": np.array([0.0, 1.0, 0.0, 0.0])}
            found = search(plugin, turning, pose, "limits", **near)
            assert (found.good, found.code == driver.NO_IK_SOLUTION) == (good, not good)


def test_limits_of_other_joints_end_a_search_by_time(turning: Arm) -> None:
    """Rows at values inside are shown to be outside the narrower limits one by one only."""
    narrow = with_joint(turning.tree, "j0", limits=Limits(2.0, 2.5))
    with running(turning, narrow) as plugin:
        assert plugin.initialize(turning.base, turning.tip).good
        found = search(plugin, turning, at(0.85, 0.0, 0.5), timeout=0.05)
        assert found.code == driver.TIMED_OUT


# --- several ----------------------------------------------------------------------------------------


def test_with_two_held_joints_unreachable_poses_end_early(on_rail: Arm) -> None:
    with running(on_rail) as plugin:
        assert plugin.initialize(on_rail.base, on_rail.tip).good
        for pose in (at(5.0, 0.0, 0.4), at(0.0, 0.0, 2.0), at(0.5, 0.95, 0.4), at(-2.5, 0.1, 0.3)):
            found = search(plugin, on_rail, pose, "callback")
            assert found.code == driver.NO_IK_SOLUTION and len(found.seen) == 0
            assert search(plugin, on_rail, pose, timeout=0.0).code == driver.TIMED_OUT
            assert search(plugin, on_rail, pose, "lock").code == driver.NO_IK_SOLUTION


def test_with_two_held_joints_poses_near_the_end_of_reach_are_found(on_rail: Arm) -> None:
    """Seeds whose values and those beside them reach nothing."""
    seed = np.array([-1.0, 0.0, 0.0, 0.0, 2.5])
    with running(on_rail) as plugin:
        assert plugin.initialize(on_rail.base, on_rail.tip).good
        for short in (1e-2, 1e-4, 1e-6):
            pose = at(1.9 - short, 0.0, 0.4)
            found = search(plugin, on_rail, pose, seed=seed)
            assert found.good and np.abs(on_rail.pose(found.q)[:3, 3] - pose[:3, 3]).max() < 1e-9


def test_with_two_held_joints_rejections_go_on_to_the_end_of_time(on_rail: Arm) -> None:
    pose = at(0.6, 0.3, 0.5)
    with running(on_rail) as plugin:
        assert plugin.initialize(on_rail.base, on_rail.tip).good
        rejected = search(plugin, on_rail, pose, "callback", rejections=10**6, timeout=0.2)
        assert rejected.code == driver.TIMED_OUT and len(rejected.seen) > 1000
        assert np.abs(on_rail.pose(rejected.seen)[:, :3, 3] - pose[:3, 3]).max() < 1e-9
        late = search(plugin, on_rail, pose, "callback", rejections=700)
        assert late.good and len(late.seen) == 701
        reach = [0.3] * 5
        near = search(plugin, on_rail, pose, "callback", "limits", limits=reach, seed=late.q)
        assert near.good and np.abs(near.q - late.q).max() <= 0.3 + 1e-9
