"""Searches of the emitted MoveIt plugin through stub interfaces, also for a held joint."""

from __future__ import annotations

import time

import numpy as np
import tests.support.moveit_driver as driver
from numpy.typing import NDArray
from tests.support.moveit_arms import FRANKA, KUKA, Arm, needs
from tests.support.moveit_driver import Plugin

Array = NDArray[np.float64]


@needs(KUKA, FRANKA)
def test_every_search_starts_with_the_nearest(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    wide = np.full(len(arm.joints), 20.0)
    for q in arm.configurations(5, 5):
        pose, seed = (
            arm.pose(q),
            q + 0.01 * (np.arange(len(q)) - 3.0) * (len(arm.module.free_indices) == 0),
        )
        nearest = plugin.get(pose, seed).values
        for overload in ("", "limits", "callback", "limits callback", "poses", "poses callback"):
            words = overload.split()
            limits = wide if "limits" in words or "poses" in words else ()
            found = plugin.search(pose, seed, *words, limits=limits)
            assert found.good and found.code == driver.SUCCESS, words
            assert np.array_equal(found.q, nearest)
            assert len(found.seen) == ("callback" in words)


@needs(KUKA, FRANKA)
def test_consistency_limits_are_kept(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    n = len(arm.joints)
    for q in 0.9 * arm.configurations(6, 10):
        low, high = arm.bounds
        q = np.clip(q, low + 0.11, high - 0.11)
        seed = q + 0.1 * np.cos(np.arange(n))
        within = plugin.search(arm.pose(q), seed, "limits", limits=np.full(n, 0.12), timeout=0.5)
        if not arm.module.free_indices:
            assert within.good and np.abs(within.q - q).max() < 1e-6
        elif within.good:
            assert np.abs(arm.pose(within.q) - arm.pose(q)).max() < 1e-8
        if within.good:
            assert np.abs(within.q - seed).max() <= 0.12 + 1e-9
        outside = plugin.search(
            arm.pose(q),
            seed,
            "limits",
            "callback",
            limits=[0.12] * (n - 2) + [1e-4, 0.12],
            timeout=0.0,
        )
        assert not outside.good and len(outside.seen) == 0 and len(outside.q) == 0
        expected = driver.TIMED_OUT if arm.module.free_indices else driver.NO_IK_SOLUTION
        assert outside.code == expected


@needs(KUKA, FRANKA)
def test_the_callback_sees_the_candidates_in_order(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    seed = arm.configurations(7, 1)[0]
    poses = [arm.pose(arm.held(q, seed)) for q in arm.configurations(8)]
    pose, rows = max(
        ((pose, plugin.get_all([pose], seed)[1]) for pose in poses), key=lambda pair: len(pair[1])
    )
    assert len(rows) > 2
    for rejections in range(len(rows)):
        found = plugin.search(pose, seed, "callback", "lock", rejections=rejections)
        assert found.good and found.code == driver.SUCCESS
        assert np.array_equal(found.q, rows[rejections])
        assert np.array_equal(found.seen, rows[: rejections + 1])
    none = plugin.search(pose, seed, "callback", "lock", rejections=1000)
    assert not none.good and none.code == driver.GOAL_IN_COLLISION
    assert np.array_equal(none.seen, rows) and len(none.q) == 0
    late = plugin.search(pose, seed, "callback", rejections=1000, wait=0.02, timeout=0.01)
    assert not late.good and late.code == driver.TIMED_OUT and len(late.seen) == 1


@needs(KUKA)
def test_unreachable_poses_have_no_solution(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    pose = arm.pose(np.zeros(6))
    pose[0, 3] = 5.0
    one, (several, rows) = plugin.get(pose, np.zeros(6)), plugin.get_all([pose], np.zeros(6))
    assert not one.good and one.code == driver.NO_IK_SOLUTION
    assert not several.good and several.code == 8 and len(rows) == 0 and several.values == [0.0]
    assert plugin.search(pose, np.zeros(6), "callback").code == driver.NO_IK_SOLUTION


# --- a held joint -----------------------------------------------------------------------------------


@needs(FRANKA)
def test_a_held_joint_leaves_the_seed_only_in_a_search(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip, resolution=0.05).good
    free = arm.module.free_indices[0]
    low, high = arm.bounds
    moved = 0
    for q, seed in zip(arm.configurations(9), arm.configurations(10), strict=True):
        pose = arm.pose(q)
        one = plugin.get(pose, seed)
        assert not one.good or one.values[free] == seed[free]
        if one.good:
            continue
        assert one.code == driver.NO_IK_SOLUTION
        assert plugin.search(pose, seed, "lock", timeout=0.2).code == driver.NO_IK_SOLUTION
        found = plugin.search(pose, seed, timeout=1.0)
        assert found.good and np.abs(arm.pose(found.q) - pose).max() < 1e-8
        assert (low <= found.q).all() and (found.q <= high).all() and found.q[free] != seed[free]
        moved += 1
    assert moved > 3


@needs(FRANKA)
def test_values_of_a_held_joint_spread_from_the_seeds(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip, resolution=0.05).good
    q = np.array([0.1, 0.2, -0.3, -2.0, 0.2, 1.8, 0.4])
    tried = plugin.search(arm.pose(q), q, "callback", rejections=10**6, timeout=0.2)
    assert not tried.good and tried.code == driver.TIMED_OUT
    values = tried.seen[:, arm.module.free_indices[0]]
    low, high = (bound[arm.module.free_indices[0]] for bound in arm.bounds)
    assert (values[: (values == values[0]).sum()] == q[6]).all() and values[0] == q[6]
    assert (low <= values).all() and (values <= high).all()
    gaps = np.diff(np.unique(values))
    assert gaps.max() < 0.05 and np.abs(values[:20] - q[6]).max() < 0.5
    assert np.abs(arm.pose(tried.seen) - arm.pose(q)).max() < 1e-8
    near = plugin.search(arm.pose(q), q, "callback", "limits", rejections=10**6, limits=[0.3] * 7)
    assert len(near.seen) > 10 and np.abs(near.seen - q).max() <= 0.3 + 1e-9


@needs(FRANKA)
def test_a_search_ends_where_no_value_of_the_held_joint_reaches_the_pose(
    arm: Arm, plugin: Plugin
) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    pose, seed = arm.pose(np.zeros(7)), arm.configurations(11, 1)[0]
    pose[0, 3] = 5.0
    for timeout in (0.0, 60.0):
        start = time.perf_counter()
        found = plugin.search(pose, seed, timeout=timeout)
        assert not found.good and found.code == driver.NO_IK_SOLUTION
        assert time.perf_counter() - start < 5.0
    assert plugin.search(arm.pose(seed), seed, timeout=-1.0).good
    assert plugin.search(arm.pose(seed), seed, timeout=float("nan")).good
