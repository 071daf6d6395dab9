"""What a request may ask of a description."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path

import pytest
from tests.support.small_robots import elbow_robot, write_robot
from tests.support.solving import FIXTURES

from ikgen.derivation.read import default_name, read, read_tree
from ikgen.errors import BadDescriptionError, UsageError
from ikgen.model.oddity import OddityKind
from ikgen.projects.config import load_config
from ikgen.records.request import Request


def test_locked_joints_keep_inside_their_limits(tmp_path: Path) -> None:
    robot = write_robot(tmp_path / "elbow.urdf")
    assert read(Request(robot, lock={"elbow": 2.5})).dh.dof == 2
    for value in (2.6, -1e9):
        with pytest.raises(UsageError, match=r"outside the joint's limits, -2\.5 to 2\.5"):
            read(Request(robot, lock={"elbow": value}))


def test_something_is_left_to_move(tmp_path: Path) -> None:
    robot = write_robot(tmp_path / "elbow.urdf")
    joints = [joint.name for joint in read(Request(robot)).dh.joints]
    some = read(Request(robot, free=dict.fromkeys(joints[:-1]))).dh
    assert len(some.free_indices) == some.dof - 1
    with pytest.raises(UsageError, match="every joint is held"):
        read(Request(robot, free=dict.fromkeys(joints)))


def test_a_joint_is_held_or_locked(tmp_path: Path) -> None:
    """However it is asked for: a config knows no options."""
    robot = write_robot(tmp_path / "elbow.urdf")
    config = tmp_path / "ikgen.toml"
    both = 'free = ["elbow"]\nlock = { elbow = 0.1 }\n'
    config.write_text(f'[[arm]]\nname = "arm"\nrobot = "{robot.name}"\n{both}')
    (arm,) = load_config(config)
    table = Request(FIXTURES / "scara_standard.toml")
    first = read(table).dh.joints[0].name
    for request in (arm.request, replace(table, free={first: None}, lock={first: 0.1})):
        with pytest.raises(UsageError, match=r"is both held \(free\) and locked") as caught:
            read(request)
        assert "leave one out" in caught.value.hint


def test_locked_joints_of_a_table(tmp_path: Path) -> None:
    table = tmp_path / "TABLE.TOML"  # whatever the case of the suffix
    text = (FIXTURES / "scara_standard.toml").read_text()
    table.write_text(text)
    dh = read(Request(table)).dh
    joint = next(j for j in dh.joints if abs(j.limits.upper) < 100)
    assert read(Request(table, lock={joint.name: joint.limits.upper})).dh.dof == dh.dof - 1
    with pytest.raises(UsageError, match=f"--lock {joint.name}=.*outside the joint's limits"):
        read(Request(table, lock={joint.name: joint.limits.upper + 0.1}))


def test_names_tell_chains_apart(tmp_path: Path) -> None:
    pair = write_robot(tmp_path / "pair.urdf", sides=("a_", "b_"))
    assert default_name(read(Request(pair, tip="a_tool0"))) == "pair_a_tool0"
    own = tmp_path / "own.urdf"  # a tip that has the robot's name already
    own.write_text(elbow_robot("pair", sides=("pair_a_", "pair_b_")))
    assert default_name(read(Request(own, tip="pair_a_tool0"))) == "pair_a_tool0"
    assert default_name(read(Request(write_robot(tmp_path / "elbow.urdf")))) == "elbow"


def test_arguments_are_listed_where_a_file_cannot_be_expanded(tmp_path: Path) -> None:
    (tmp_path / "parts.xacro").write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="hand" default="none"/>'
        "</robot>"
    )
    file = tmp_path / "arm.urdf.xacro"
    file.write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">\n'
        "<!-- <xacro:arg name='old' default='1'/> -->\n"
        "<xacro:arg default='ur5' name='model'/><xacro:include filename='parts.xacro'/>\n"
        '<link name="$(arg prefix)base"/></robot>'
    )
    with pytest.raises(BadDescriptionError, match="'prefix' has no value") as caught:
        read_tree(Request(file))
    listed = caught.value.hint.splitlines()[-1]
    assert listed == (
        "arguments that the file takes (--arg): model:=ur5, hand:=none, prefix (no default)"
    )
    with pytest.raises(BadDescriptionError) as caught:
        read_tree(Request(file, args={"prefx": "a_", "model": "ur3"}))
    assert caught.value.hint.endswith("prefix (no default); not among them: 'prefx'")


def test_what_is_odd_about_joints_that_do_not_move_the_chain_is_left_out(tmp_path: Path) -> None:
    robot = write_robot(tmp_path / "pair.urdf", sides=("a_", "b_"))
    odd = robot.read_text().replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0 2"/>')
    robot.write_text(odd)
    assert len(read_tree(Request(robot)).source.warnings) == 2
    (only,) = read(Request(robot, tip="b_tool0")).source.warnings
    assert "joint 'b_waist': axis of length 2 normalised" in only
    robot.write_text(odd.replace('<axis xyz="0 0 2"/>', '<axis xyz="0 0 1"/>' * 2))
    (only,) = read(Request(robot, tip="b_tool0")).source.warnings
    assert "joint 'b_waist' has two <axis> elements that say the same" in only


def test_what_decisions_go_by_is_not_read_from_words(tmp_path: Path) -> None:
    robot = write_robot(tmp_path / "elbow.urdf")
    robot.write_text(
        robot.read_text()
        .replace('"waist"', "\"it's: joint 'elbow': \"")
        .replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0 2"/>')
    )
    (odd,) = read(Request(robot)).source.warnings
    assert odd.joint == "it's: joint 'elbow': " and odd.kind is OddityKind.TOLD
    copied = pickle.loads(pickle.dumps(odd))
    assert copied == odd and (copied.joint, copied.kind) == (odd.joint, odd.kind)
