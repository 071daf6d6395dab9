"""Which chains of a tree are proposed as arms: not its fingers, wheels, rotors, heads and sensors."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest
from tests.support.trees import serial_joints, tree_of

from ikgen.chains.arms import candidate_chains
from ikgen.chains.selection import select_chain
from ikgen.errors import UsageError
from ikgen.model.joint_tree import Mimic


def ends(tree, base=None):
    return {(arm.base, arm.tip): len(arm.joints) for arm in candidate_chains(tree, base)}


def test_a_spine_of_middle_links_is_no_middle_finger():
    spine = serial_joints("pelvis", "middle_lumbar_Z", "middle_lumbar_X", "middle_thoracic_Z",
                          "middle_thoracic_X", "middle_thoracic_Y")  # fmt: skip
    chest = "middle_thoracic_Y_link"
    arms = [
        joint
        for side in ("left", "right")
        for joint in serial_joints(chest, *(f"{side}_arm_{i}" for i in range(7)))
    ]
    head = serial_joints(chest, "middle_cervical_Z", "middle_cervical_X", "middle_cervical_Y")
    assert ends(tree_of(*spine, *arms, *head)) == {
        ("pelvis", "left_arm_6_link"): 12,
        ("pelvis", "right_arm_6_link"): 12,
        (chest, "left_arm_6_link"): 7,
        (chest, "right_arm_6_link"): 7,
    }


def test_an_arm_ends_at_the_palm_where_some_fingers_are_held():
    arm = serial_joints("base", *(f"arm_{i}" for i in range(6)))
    gripper = [
        ("mount", "fixed", "arm_5_link", "gripper_base_link"),
        ("gripper_joint", "revolute", "gripper_base_link", "gripper_motor_link"),
        ("inner_joint", "fixed", "gripper_base_link", "gripper_inner_link"),
        ("tip_joint", "fixed", "gripper_inner_link", "gripper_fingertip_link"),
    ]
    assert ends(tree_of(*arm, *gripper)) == {("base", "gripper_base_link"): 6}


def test_a_frame_beside_the_fingers_may_be_the_tip():
    arm = serial_joints("base", *(f"arm_{i}" for i in range(5)))
    frame = ("frame_joint", "fixed", "arm_4_link", "grasp_frame")
    finger = ("gripper", "revolute", "arm_4_link", "moving_jaw")
    assert ends(tree_of(*arm, frame, finger)) == {("base", "grasp_frame"): 5}


@pytest.mark.parametrize("printed", ["link_aruco", "apriltag_link", "wrist_fiducial"])
def test_a_mark_for_cameras_is_no_tip_beside_a_link_of_the_tool(printed):
    arm = serial_joints("base", *(f"arm_{i}" for i in range(5)))
    mark = ("mark_joint", "fixed", "arm_4_link", printed)
    tool = ("tool_joint", "fixed", "arm_4_link", "spindle")
    assert ends(tree_of(*arm, mark, tool)) == {("base", "spindle"): 5}


def test_the_middle_of_a_grasp_is_the_tip_however_deep_other_frames_lie():
    arm = serial_joints("base", *(f"arm_{i}" for i in range(5)))
    middle = ("middle_joint", "fixed", "arm_4_link", "link_grasp_center")
    cover = ("cover_joint", "fixed", "arm_4_link", "cover")
    plate = ("plate_joint", "fixed", "cover", "plate")
    assert ends(tree_of(*arm, middle, cover, plate)) == {("base", "link_grasp_center"): 5}


@pytest.mark.parametrize("word", ["wheel", "front_caster", "Rotor", "propeller"])
def test_a_leg_ends_before_its_wheel(word):
    leg = serial_joints("base", *(f"leg_{i}" for i in range(5)))
    wheel = (f"{word}_joint", "continuous", "leg_4_link", f"{word}_link")
    assert ends(tree_of(*leg, wheel)) == {("base", "leg_4_link"): 5}


def test_rotors_of_a_leg_s_motors_are_no_propellers():
    leg = [
        ("hip", "revolute", "base", "hip_rotor"),
        ("thigh", "fixed", "hip_rotor", "knee_stator"),
        ("knee", "revolute", "knee_stator", "knee_rotor"),
        ("wheel", "continuous", "knee_rotor", "wheel_rotor"),
    ]
    assert ends(tree_of(*leg)) == {("base", "knee_rotor"): 2}


def test_an_arm_whose_joint_is_named_after_a_wheel_stays_one():
    arm = serial_joints("base", "wheel_1", *(f"arm_{i}" for i in range(5)))
    assert ends(tree_of(*arm)) == {("base", "arm_4_link"): 6}


def test_a_vehicle_has_no_arm_but_the_chain_that_is_asked_for():
    wheels = [(f"rotor_{i}_joint", "continuous", "base", f"rotor_{i}") for i in range(4)]
    tree = tree_of(*wheels)
    assert candidate_chains(tree) == ()
    with pytest.raises(UsageError, match="only fingers, wheels or rotors move") as caught:
        select_chain(tree)
    assert "--tip" in caught.value.hint
    assert select_chain(tree, tip="rotor_2").dof == 1


def test_ten_thousand_joints_are_answered_in_seconds():
    count = 10_000
    started = time.process_time()
    chain = tree_of(*serial_joints("base", *(f"j{i}" for i in range(count))))
    star = tree_of(*((f"j{i}", "revolute", "base", f"l{i}") for i in range(count)))
    with pytest.raises(UsageError, match="10000 joints move between 'base' and 'j9999_link'"):
        select_chain(chain)
    with pytest.raises(UsageError, match="several chains") as caught:
        select_chain(star)
    assert caught.value.hint.endswith("... and 9980 more")
    assert time.process_time() - started < 20.0  # both; 5 s on a quiet machine


def test_joints_beyond_the_longest_chain_may_be_locked():
    names = [f"j{i}" for i in range(17)]
    tree = tree_of(*serial_joints("base", *names))
    with pytest.raises(UsageError, match="17 joints move") as caught:
        select_chain(tree)
    assert "--lock" in caught.value.hint
    assert select_chain(tree, locked={"j3": 0.5}).dof == 16


def test_an_arm_may_begin_with_a_joint_that_follows_one_behind_it():
    arm = tree_of(*serial_joints("base", *(f"arm_{i}" for i in range(6))))
    first, *others = arm.joints
    coupled = replace(arm, joints=(replace(first, mimic=Mimic("arm_2", -0.5, 0.0)), *others))
    assert ends(coupled) == {("base", "arm_5_link"): 6}
    assert [chain.dof for chain in candidate_chains(coupled)] == [5]


def test_a_leg_whose_hip_follows_the_other_leg_s_is_no_finger():
    left = serial_joints("base", *(f"left_{i}" for i in range(6)))
    right = serial_joints("base", *(f"right_{i}" for i in range(6)))
    legs = tree_of(*left, *right)
    joints = [
        replace(joint, mimic=Mimic("left_0", 1.0, 0.0)) if joint.name == "right_0" else joint
        for joint in legs.joints
    ]
    assert ends(replace(legs, joints=tuple(joints))) == {
        ("base", "left_5_link"): 6,
        ("base", "right_5_link"): 6,
    }
