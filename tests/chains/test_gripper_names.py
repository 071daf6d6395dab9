"""Joints named after a gripper: which turn all of it and are the arm's, and which open it."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.support.trees import serial_joints, tree_of

from ikgen.chains.arms import candidate_chains
from ikgen.chains.selection import select_chain
from ikgen.derivation.read import read
from ikgen.errors import UsageError
from ikgen.model.joint_tree import Limits
from ikgen.records.request import Request

ARM = serial_joints("base", *(f"joint{i}" for i in range(1, 6)))
PALM = "joint5_link"
NAMES = ["gripper_roll", "wrist_to_gripper", "joint6_gripper", "gripper_base_joint", "claw_rotate"]
FINGERS = [
    ("left_slide", "prismatic", "hand", "left_pad"),
    ("right_slide", "prismatic", "hand", "right_pad"),
]


def arm_with(name, *below, half=1.6):
    """A 6R arm whose last joint has the name and turns by `half` to both sides."""
    tree = tree_of(*ARM, (name, "revolute", PALM, "hand"), *below)
    joints = [replace(j, limits=Limits(-half, half)) if j.name == name else j for j in tree.joints]
    return replace(tree, joints=tuple(joints))


def only(tree):
    (arm,) = candidate_chains(tree)
    return arm


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(
    "below", [(), FINGERS, [("tool", "fixed", "hand", "tool0")]], ids=["bare", "fingers", "tool"]
)
def test_a_joint_that_turns_a_whole_gripper_is_the_arm_s(name, below):
    arm = only(arm_with(name, *below))
    assert (len(arm.joints), arm.joints[-1], arm.left_out) == (6, name, "")


def test_two_fingers_below_tell_an_arm_s_joint_however_little_it_turns():
    assert only(arm_with("gripper_pitch", *FINGERS, half=0.5)).tip == "hand"


@pytest.mark.parametrize("jaw", ["jaw", "gripper_finger", "thumb"])
def test_one_jaw_behind_the_joint_that_turns_a_gripper_is_no_joint_of_the_arm(jaw):
    arm = only(arm_with("gripper_roll", (jaw, "revolute", "hand", jaw)))
    assert (arm.tip, arm.joints[-1]) == ("hand", "gripper_roll")
    assert arm.left_out == f"'{jaw}' is left out as a gripper's joint: --tip {jaw} keeps it"


@pytest.mark.parametrize("name", ["left_jaw", "finger_joint", "thumb"])
def test_a_jaw_without_limits_that_say_how_far_it_opens_stays_one(name):
    assert only(arm_with(name, half=3.14)).tip == PALM


def test_a_gripper_s_joint_beside_another_one_opens_it():
    beside = ("camera_pan", "revolute", PALM, "camera")
    arm = only(arm_with("gripper_joint", beside))
    assert (arm.tip, arm.left_out) == (PALM, "")


def test_a_short_hand_s_joints_are_named_where_none_is_sure():
    sides = [(f"digit_{k}", "revolute", PALM, f"digit_{k}_link") for k in (1, 2)]
    arm = only(tree_of(*ARM, *sides))
    assert arm.left_out == (
        "'digit_1', 'digit_2' are left out as a gripper's joints: --tip digit_1_link keeps 'digit_1'"
    )


def test_the_fingers_of_a_hand_without_an_arm_are_whole():
    thumb = serial_joints("palm", *(f"thumb_{i}" for i in range(4)))
    index = serial_joints("palm", *(f"index_{i}" for i in range(4)))
    found = {(arm.tip, arm.dof) for arm in candidate_chains(tree_of(*thumb, *index))}
    assert found == {("thumb_3_link", 4), ("index_3_link", 4)}


def test_the_tip_is_the_palm_rather_than_a_finger_fixed_to_it():
    fixed = ("thumb_mount", "fixed", "hand", "thumb_base")
    fingers = [(f"finger_{k}", "revolute", "thumb_base", f"finger_{k}_link") for k in (1, 2)]
    assert only(arm_with("wrist_roll", fixed, *fingers)).tip == "hand"


def test_what_is_left_out_is_told_unless_the_tip_is_named(tmp_path):
    jaw = ("gripper", "revolute", PALM, "jaw")
    file = tmp_path / "r.urdf"
    file.write_text(tree_of(*ARM, jaw).source.text)
    word = "'gripper' is left out as a gripper's joint: --tip jaw keeps it"
    assert word in read(Request(file)).source.warnings
    assert word not in read(Request(file, tip=PALM)).source.warnings
    assert read(Request(file, tip="jaw")).dh.dof == 6


def test_it_is_told_of_each_arm_where_there_are_several():
    sides = [
        joint
        for side in "lr"
        for joint in (
            *serial_joints("base", *(f"{side}{i}" for i in range(5))),
            (f"{side}_gripper", "revolute", f"{side}4_link", f"{side}_jaw"),
        )
    ]
    with pytest.raises(UsageError) as caught:
        select_chain(tree_of(*sides))
    assert "'l_gripper' is left out" in caught.value.hint
    assert "--tip r_jaw keeps it" in caught.value.hint
