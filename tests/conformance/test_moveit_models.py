"""What the emitted MoveIt plugin makes of robot models, frames and bad input."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import tests.support.moveit_driver as driver
from tests.support.moveit_arms import (
    FRANKA,
    KUKA,
    MANIPULATOR,
    Arm,
    fixed,
    needs,
    offset,
    with_joint,
)
from tests.support.moveit_driver import Plugin

pytestmark = pytest.mark.usefixtures("solved_once")


@needs(KUKA)
def test_frames_may_differ_by_fixed_transforms(arm: Arm, plugin: Plugin) -> None:
    T_cell_base, T_base_table, T_tip_gripper = (
        offset(0.5, 0.7),
        offset(-0.3, 2.0),
        offset(0.1, -1.1),
    )
    joints = (
        fixed(arm.tree.root_link, "cell", T_cell_base),
        *arm.tree.joints,
        fixed("table", arm.base, T_base_table),
        fixed("gripper", arm.tip, T_tip_gripper),
        fixed("finger", "gripper", T_tip_gripper),
    )
    plugin.load(dataclasses.replace(arm.tree, joints=joints, root_link="cell"), frame="world")
    plugin.group("arm", arm.joints)
    T_base_root = np.linalg.inv(T_cell_base)
    q = np.array([0.3, -1.2, 1.4, 0.5, 0.7, 2.5])
    bases = {"cell": T_base_root, "world": T_base_root, "/table": T_base_table}
    tips = {"gripper": T_tip_gripper, "finger": T_tip_gripper @ T_tip_gripper}
    for base, T_chain_base in bases.items():
        for tip, T_chain_tip in tips.items():
            answer = plugin.initialize(base, tip)
            assert answer.good, answer.log
            pose = np.linalg.inv(T_chain_base) @ arm.pose(q) @ T_chain_tip
            good, (reached,) = plugin.forward([tip], q)
            assert good and np.abs(reached - pose).max() < 1e-12
            assert np.abs(plugin.get(pose, q + 0.01).values - q).max() < 1e-8
    _, log = plugin.ask("describe")
    assert log.split("\n")[-2] == "link finger" and log.count("joint") >= 6


@pytest.mark.long  # of another arm: test_moveit_followers.py
@needs(MANIPULATOR)
def test_a_task_that_leaves_the_orientation_open(arm: Arm, plugin: Plugin) -> None:
    T_tip_tool, T_cell_base = offset(0.1, 0.5), offset(0.5, 0.7)
    ends = (fixed("cell", arm.tree.root_link, T_cell_base), fixed("tool", arm.tip, T_tip_tool))
    plugin.load(dataclasses.replace(arm.tree, joints=(*arm.tree.joints, *ends)))
    plugin.group("arm", arm.joints)
    assert "leaves the tip's orientation open" in plugin.initialize(arm.base, "tool").log
    assert plugin.initialize("cell", arm.tip).good
    q = np.array([0.3, -0.4, 0.2, 0.5])
    answer, rows = plugin.get_all([np.linalg.inv(T_cell_base) @ arm.pose(q)], q)
    assert answer.good and len(rows) > 1 and np.abs(rows[0] - q).max() < 1e-8
    assert np.abs(arm.pose(rows)[:, :3, 3] - arm.pose(q)[:3, 3]).max() < 1e-8


@needs(KUKA)
def test_other_frames_are_refused(arm: Arm, plugin: Plugin) -> None:
    second = next(joint.child for joint in arm.tree.joints if joint.name == arm.joints[1])
    for base, tip, words in (
        (second, arm.tip, "moves between"),
        (arm.base, second, "moves between"),
        ("nowhere", arm.tip, "no link 'nowhere'"),
    ):
        answer = plugin.initialize(base, tip)
        assert not answer.good and words in answer.log
    assert "one tip" in plugin.initialize(arm.base, arm.tip, second).log
    assert "no such group" in plugin.initialize(arm.base, arm.tip, group="legs").log
    plugin.load(arm.tree, frame="world", root_joint="floating")
    plugin.group("arm", arm.joints)
    assert "no link 'world'" in plugin.initialize("world", arm.tip).log
    assert plugin.get(arm.pose(np.zeros(6)), np.zeros(6)).code == driver.NO_IK_SOLUTION
    assert plugin.get_all([arm.pose(np.zeros(6))], np.zeros(6))[0].code == 7
    assert not plugin.forward([arm.tip], np.zeros(6))[0]


@needs(KUKA)
def test_the_group_has_exactly_the_joints(arm: Arm, plugin: Plugin) -> None:
    for name, joints in (
        ("more", [*arm.joints, "finger"]),
        ("fewer", arm.joints[:-1]),
        ("turned", arm.joints[::-1]),
    ):
        plugin.group(name, joints)
        refused = plugin.initialize(arm.base, arm.tip, group=name)
        for answer in (refused, plugin.call("supports", name)):
            assert not answer.good
            assert f"'{name}' has the joints {', '.join(joints)}" in answer.log
            assert f"needs exactly {', '.join(arm.joints)}" in answer.log
    assert plugin.call("supports", "arm").good


@needs(KUKA)
def test_another_geometry_is_refused(arm: Arm, plugin: Plugin) -> None:
    joint = next(joint for joint in arm.tree.joints if joint.name == arm.joints[2])
    longer = joint.T_parent_child.copy()
    longer[0, 3] += 1e-3
    plugin.load(with_joint(arm.tree, joint.name, T_parent_child=longer))
    plugin.group("arm", arm.joints)
    answer = plugin.initialize(arm.base, arm.tip)
    assert not answer.good and "1 mm" in answer.log and "generate the solver again" in answer.log
    plugin.load(with_joint(arm.tree, joint.name, name="elbow"))
    plugin.group("arm", arm.joints)
    assert "'elbow' is between base and tip" in plugin.initialize(arm.base, arm.tip).log


@needs(KUKA, FRANKA)
def test_bad_input_is_refused(arm: Arm, plugin: Plugin) -> None:
    assert plugin.initialize(arm.base, arm.tip).good
    q = arm.configurations(12, 1)[0]
    pose = arm.pose(q)
    for seed in (q[:-1], [*q, 0.0], np.where(np.arange(len(q)) == 2, np.nan, q)):
        answer = plugin.get(pose, seed)
        assert not answer.good and answer.code == driver.NO_IK_SOLUTION and "seed" in answer.log
        assert not plugin.get_all([pose], seed)[0].good
    wrong = plugin.search(pose, q, "limits", limits=[1.0])
    assert not wrong.good and wrong.code == driver.NO_IK_SOLUTION
    assert not plugin.search(pose, q, "limits", limits=[float("nan")] * len(q), timeout=0.01).good
    assert plugin.get_all([], q)[0].code == 5
    assert plugin.get_all([pose, pose], q)[0].code == 4
    assert plugin.get_all([pose], q, driver.ALL_RANDOM_SAMPLED)[0].code == 2
    if not arm.module.free_indices:
        assert plugin.get_all([pose], q, driver.ALL_DISCRETIZED)[0].code == 2
    for numbers in ([np.nan, 0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0, 2]):
        answer = plugin.call("get", *numbers, len(q), *q)
        assert not answer.good and answer.code == driver.NO_IK_SOLUTION and "pose" in answer.log
    good, poses = plugin.forward([arm.tip, arm.tip], q)
    assert good and len(poses) == 2 and np.abs(poses[0] - pose).max() < 1e-12
    assert not plugin.forward([arm.base], q)[0] and not plugin.forward([arm.tip], q[:-1])[0]
