"""Choosing a chain: its ends, mimic and locked joints, and the words where it cannot be had."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from tests.support.trees import tree_of

from ikgen.chains.arms import candidate_chains
from ikgen.chains.selection import select_chain
from ikgen.errors import (
    BadDescriptionError,
    UnknownNameError,
    UnsupportedJointError,
    UsageError,
)
from ikgen.importers import load_tree
from ikgen.importers.urdf.urdf_tree import parse_urdf

FIXTURES = Path(__file__).parents[2] / "urdf_fixtures"


def forward(chain, q):
    """T_base_tip (4, 4) of a chain at q (dof,), by its definition."""
    T = np.eye(4)
    for axis in chain.axes:
        value = axis.multiplier * q[axis.driver] + axis.offset
        motion = np.eye(4)
        if axis.kind == "prismatic":
            motion[:3, 3] = value * axis.axis
        else:
            K = np.array([np.cross(axis.axis, e) for e in np.eye(3)]).T
            motion[:3, :3] += math.sin(value) * K + (1.0 - math.cos(value)) * K @ K
        T = T @ axis.T_prev_axis @ motion
    return T @ chain.T_last_tip


def serial(*types, **inner):
    """A chain l0 .. ln of joints j1 .. jn."""
    return tree_of(
        *(
            (f"j{i}", type_, f"l{i - 1}", f"l{i}", inner.get(f"j{i}", ""))
            for i, type_ in enumerate(types, start=1)
        )
    )


def mimic(joint, multiplier=1.0, offset=0.0):
    return f'<mimic joint="{joint}" multiplier="{multiplier}" offset="{offset}"/>'


@pytest.mark.parametrize(
    ("name", "base", "tip", "dof"),
    [
        ("kuka_kr6r900sixx", "base_link", "tool0", 6),
        ("abb_irb2400", "base_link", "tool0", 6),
        ("ur5e", "base_link", "tool0", 6),
        ("doosan_m1013", "base", "link6", 6),
        ("franka_fr3", "fr3_link0", "fr3_hand_tcp", 7),
        ("open_manipulator_x", "world", "end_effector_link", 4),
        ("igus_robolink_rl_dp_5", "base_link", "tool0", 5),
    ],
)
def test_default_chain(name, base, tip, dof):
    chain = select_chain(load_tree(FIXTURES / f"{name}.urdf"))
    assert (chain.base_link, chain.tip_link, chain.dof) == (base, tip, dof)


def test_several_arms_are_listed_with_the_options_to_type():
    tree = load_tree(FIXTURES / "abb_yumi.urdf")
    assert [candidate.dof for candidate in candidate_chains(tree)] == [7, 7]
    with pytest.raises(UsageError, match="several chains") as caught:
        select_chain(tree)
    assert "--base yumi_base_link --tip gripper_l_base   (7 joints: " in caught.value.hint
    assert "--base yumi_base_link --tip gripper_r_base   (7 joints: " in caught.value.hint
    assert select_chain(tree, tip="gripper_l_base").dof == 7


def test_arms_on_a_torso_are_listed_with_and_without_it():
    arm = [
        (f"{s}{i}", "revolute", f"{s}{i - 1}" if i > 1 else "torso", f"{s}{i}")
        for s in "lr"
        for i in range(1, 7)
    ]
    tree = tree_of(("waist", "revolute", "pelvis", "torso"), *arm)
    ends = [(c.base, c.tip, c.dof) for c in candidate_chains(tree)]
    assert ends == [
        ("pelvis", "l6", 7),
        ("pelvis", "r6", 7),
        ("torso", "l6", 6),
        ("torso", "r6", 6),
    ]
    assert [c.tip for c in candidate_chains(tree, "torso")] == ["l6", "r6"]
    assert candidate_chains(tree)[2].why.endswith(
        ", behind 'waist', the last joint that arms share"
    )


def test_fingers_and_short_side_branches_are_no_arms():
    tree = tree_of(
        ("j1", "revolute", "base", "l1"),
        ("rod", "revolute", "l1", "rod"),
        *((f"j{i}", "revolute", f"l{i - 1}", f"l{i}") for i in range(2, 6)),
        ("palm", "fixed", "l5", "palm"),
        ("one", "prismatic", "palm", "one"),
        ("two", "prismatic", "palm", "two", mimic("one")),
    )
    (only,) = candidate_chains(tree)
    assert (only.base, only.tip, only.dof) == ("base", "palm", 5)


def test_joints_that_follow_others_are_marked():
    tree = serial("revolute", "revolute", "revolute", j2=mimic("j1", -2, 0.5))
    (only,) = candidate_chains(tree)
    assert (only.dof, only.words) == (2, "j1, j2 (follows j1), j3")


def test_default_base_lies_below_a_floating_joint():
    types = ["fixed", "floating", "fixed", "revolute", "revolute", "revolute"]
    (only,) = candidate_chains(serial(*types))
    assert (only.base, only.dof) == ("l2", 3)


def test_joints_above_a_floating_one_are_told():
    types = ["revolute", "fixed", "prismatic", "planar", "revolute", "revolute", "revolute"]
    (only,) = candidate_chains(serial(*types))
    assert only.joints == ("j5", "j6", "j7")
    assert only.left_out == (
        "'j1', 'j3' lie above the planar joint 'j4', through which no chain goes: left out; --tip l3 ends "
        "one before it"
    )
    (mobile,) = candidate_chains(serial("planar", "revolute", "revolute"))
    assert not mobile.left_out


def test_given_ends_are_taken_as_they_are():
    tree = serial("revolute", "revolute", "revolute", "fixed")
    chain = select_chain(tree, "l1", "l3")
    assert (chain.base_link, chain.tip_link) == ("l1", "l3")
    assert [joint.name for joint in chain.joints] == ["j2", "j3"]
    assert select_chain(tree, "l1").tip_link == "l4"
    assert select_chain(tree, tip="l2").base_link == "l0"


def test_fixed_joints_are_folded_into_the_transforms():
    tree = serial("fixed", "revolute", "fixed", "prismatic", "fixed")
    T = tree.joints[0].T_parent_child
    chain = select_chain(tree, "l0", "l5")
    assert [axis.kind for axis in chain.axes] == ["revolute", "prismatic"]
    for axis in chain.axes:
        np.testing.assert_allclose(axis.T_prev_axis, T @ T, atol=1e-16)
        assert not axis.T_prev_axis.flags.writeable
    np.testing.assert_array_equal(chain.T_last_tip, T)


def test_a_mimic_joint_follows_its_driver():
    tree = serial("revolute", "revolute", "revolute", j2=mimic("j1", -2, 0.5))
    chain = select_chain(tree)
    assert [joint.name for joint in chain.joints] == ["j1", "j3"]
    couplings = [(axis.driver, axis.multiplier, axis.offset) for axis in chain.axes]
    assert couplings == [(0, 1.0, 0.0), (0, -2.0, 0.5), (1, 1.0, 0.0)]
    free = select_chain(serial("revolute", "revolute", "revolute"))
    np.testing.assert_allclose(forward(chain, [0.3, 0.7]), forward(free, [0.3, -0.1, 0.7]))


def test_a_mimic_of_a_mimic_composes():
    tree = serial("revolute", "revolute", "revolute", j2=mimic("j1", 2, 0.5), j3=mimic("j2", 3, 1))
    axis = select_chain(tree, "l0", "l3").axes[2]
    assert (axis.driver, axis.multiplier, axis.offset) == (0, 6.0, 2.5)


def test_a_mimic_joint_before_its_driver():
    tree = serial("revolute", "revolute", "revolute", j1=mimic("j3", -1))
    chain = select_chain(tree, "l0", "l3")
    assert [joint.name for joint in chain.joints] == ["j2", "j3"]
    assert [axis.driver for axis in chain.axes] == [1, 0, 1]


def test_a_driver_outside_the_chain_is_listed_as_its_joint():
    tree = serial("revolute", "revolute", "revolute", j2=mimic("j1", -1))
    chain = select_chain(tree, "l1", "l3")
    assert [joint.name for joint in chain.joints] == ["j1", "j3"]
    assert (chain.axes[0].driver, chain.axes[0].multiplier) == (0, -1.0)


def test_a_mimic_multiplied_by_zero_is_a_constant():
    tree = serial("revolute", "revolute", "revolute", j2=mimic("j1", 0, 0.5))
    chain = select_chain(tree, "l0", "l3")
    free = select_chain(serial("revolute", "revolute", "revolute"), "l0", "l3")
    assert [axis.name for axis in chain.axes] == ["j1", "j3"]
    np.testing.assert_allclose(forward(chain, [0.3, 0.7]), forward(free, [0.3, 0.5, 0.7]))


def test_bad_mimics_matter_only_in_the_chain():
    tree = serial("revolute", "revolute", "revolute", j3=mimic("gone"))
    assert select_chain(tree, "l0", "l2").dof == 2
    with pytest.raises(BadDescriptionError, match=r"r\.urdf:4: joint 'j3' mimics 'gone'"):
        select_chain(tree, "l0", "l3")
    circle = serial("revolute", "revolute", j1=mimic("j2"), j2=mimic("j1"))
    with pytest.raises(BadDescriptionError, match="mimics itself"):
        select_chain(circle, "l0", "l2")
    with pytest.raises(BadDescriptionError, match="which is fixed"):
        select_chain(serial("fixed", "revolute", j2=mimic("j1")), "l0", "l2")


@pytest.mark.parametrize("driver", ["gone", "j3"])
def test_a_bad_mimic_is_not_taken_for_where_a_gripper_begins(driver):
    tree = serial(*["revolute"] * 6, j3=mimic(driver))
    with pytest.raises(BadDescriptionError, match="joint 'j3' mimics"):
        select_chain(tree)


@pytest.mark.parametrize("type_", ["revolute", "continuous", "prismatic"])
def test_a_locked_joint_becomes_a_constant(type_):
    tree = serial("revolute", type_, "revolute")
    chain = select_chain(tree, locked={"j2": 0.4})
    assert [joint.name for joint in chain.joints] == ["j1", "j3"]
    assert chain.locked == (("j2", 0.4),)
    expected = forward(select_chain(tree), [0.3, 0.4, 0.7])
    np.testing.assert_allclose(forward(chain, [0.3, 0.7]), expected, atol=1e-15)


def test_locking_a_driver_holds_what_mimics_it():
    tree = serial("revolute", "revolute", "revolute", j2=mimic("j1", -2, 0.5))
    chain = select_chain(tree, locked={"j1": 0.3})
    assert [axis.name for axis in chain.axes] == ["j3"]
    free = select_chain(serial("revolute", "revolute", "revolute"))
    np.testing.assert_allclose(forward(chain, [0.7]), forward(free, [0.3, -0.1, 0.7]), atol=1e-15)


def test_joints_that_cannot_be_locked():
    tree = serial("revolute", "revolute", "fixed", "revolute", "revolute", j2=mimic("j1"))
    with pytest.raises(UnknownNameError, match="no joint named 'j9'"):
        select_chain(tree, "l0", "l4", {"j9": 0.0})
    for name, message, hint in [
        ("j2", "mimics another joint", "--lock j1=VALUE"),
        ("j3", "is fixed already", "leave"),
        ("j5", "not between base and tip", "j1, j4"),
    ]:
        with pytest.raises(UsageError, match=message) as caught:
            select_chain(tree, "l0", "l4", {name: 0.0})
        assert hint in caught.value.hint
    with pytest.raises(UsageError, match="locked at nan"):
        select_chain(tree, "l0", "l4", {"j1": math.nan})
    with pytest.raises(UsageError, match="nothing moves"):
        select_chain(tree, "l0", "l4", {"j1": 0.0, "j4": 0.0})


def test_joints_are_listed_from_base_to_tip() -> None:
    tree = serial(*["revolute"] * 6)
    with pytest.raises(UnknownNameError) as unknown:
        select_chain(tree, "l0", "l6", {"j9": 0.0})
    assert unknown.value.hint == "there is: j1, j2, j3, j4, j5, j6"
    with pytest.raises(UsageError, match="not between") as outside:
        select_chain(tree, "l1", "l6", {"j1": 0.0})
    assert outside.value.hint == "joints of the chain: j2, j3, j4, j5, j6"


def test_links_that_are_not_there_list_the_closest_first():
    tree = load_tree(FIXTURES / "ur5e.urdf")
    with pytest.raises(UnknownNameError, match="no link named 'tool_0'") as caught:
        select_chain(tree, tip="tool_0")
    assert caught.value.hint.startswith("there is: tool0")
    with pytest.raises(UnknownNameError):
        select_chain(tree, base="bas")


def test_a_tip_that_is_not_below_the_base():
    tree = load_tree(FIXTURES / "abb_yumi.urdf")
    with pytest.raises(UsageError, match="is not below") as caught:
        select_chain(tree, "gripper_l_base", "yumi_body")
    assert "exchange" in caught.value.hint
    with pytest.raises(UsageError, match="is not below") as caught:
        select_chain(tree, "gripper_l_base", "gripper_r_base")
    assert "--base yumi_body" in caught.value.hint
    with pytest.raises(UsageError, match="nothing moves"):
        select_chain(tree, "yumi_body", "yumi_body")


@pytest.mark.parametrize("type_", ["floating", "planar"])
def test_joints_without_one_axis(type_):
    tree = serial(type_, "revolute", "revolute")
    with pytest.raises(UnsupportedJointError, match=rf"r\.urdf:2: .*'j1'.* is {type_}") as caught:
        select_chain(tree, "l0", "l3")
    assert "--base l1" in caught.value.hint
    assert select_chain(tree, "l1", "l3").dof == 2


def test_a_tree_without_moving_joints():
    with pytest.raises(UsageError, match="no joint moves"):
        select_chain(serial("fixed"))


def test_a_long_row_of_mimic_joints_that_grows_is_refused():
    inner = {f"j{i}": mimic(f"j{i - 1}", 1e2) for i in range(2, 5)}
    tree = serial("revolute", "revolute", "revolute", "revolute", **inner)
    with pytest.raises(
        BadDescriptionError, match=r"'j4' follows 'j1' as 1e\+06 \* value"
    ) as caught:
        select_chain(tree)
    assert caught.value.line is not None and "<mimic>" in caught.value.hint
    assert "multiplier 10000" in caught.value.hint
    fast = serial("revolute", "revolute", "revolute", j2=mimic("j1", -1e4))
    assert select_chain(fast).dof == 2


def test_a_mimic_joint_that_hardly_moves_is_refused():
    inner = {"j2": mimic("j1", 1e-3), "j3": mimic("j2", -1e-4)}
    with pytest.raises(BadDescriptionError, match="'j3' follows 'j1' as -1e-07") as caught:
        select_chain(serial("revolute", "revolute", "revolute", "revolute", **inner))
    assert "multiplier 0" in caught.value.hint
    for multiplier in (0.0, 1e-4):
        still = {"j2": mimic("j1", multiplier)}
        assert select_chain(serial("revolute", "revolute", "revolute", **still)).dof == 2


@pytest.mark.parametrize(
    ("joints", "base", "hint"),
    [
        ([], None, "the file has no joints: check that it is complete"),
        ([("f", "fixed", "a", "b")], None, "none of the file's joints is revolute, continuous or"),
        (
            [("f", "floating", "a", "b")],
            None,
            "none of the file's joints is revolute, continuous or",
        ),
        (
            [("f", "fixed", "a", "b"), ("j", "revolute", "a", "c")],
            "b",
            "choose other links by --base and --tip",
        ),
    ],
)
def test_where_no_joint_moves_the_way_out_is_one_that_there_is(joints, base, hint):
    bare = parse_urdf('<robot name="r"><link name="a"/></robot>', path=Path("r.urdf"))
    tree = tree_of(*joints) if joints else bare
    with pytest.raises(UsageError, match="no joint moves") as caught:
        select_chain(tree, base)
    assert caught.value.hint.startswith(hint)
