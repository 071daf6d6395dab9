"""Configs that `ikgen init` writes: every arm of a robot, paths and arguments as the config sees them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from tests.support.redundant_arms import serial_urdf

from ikgen.errors import UsageError
from ikgen.projects.config import load_config
from ikgen.projects.new_config import add_to_config, config_path, robot_arms, write_config
from ikgen.records.request import Request

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"
AR4 = FIXTURES / "ar4_ros_driver/annin_ar4_description/urdf/ar.urdf.xacro"


def written(request: Request, path: Path) -> Path:
    write_config(path, request, robot_arms(request), ["python"], force=False)
    return path


def test_arguments_and_paths_are_recorded(tmp_path: Path) -> None:
    packages = FIXTURES / "ar4_ros_driver"
    arguments = {"ar_model": "mk3", "include_gripper": "false", "tf_prefix": "a_"}
    request = Request(AR4, args=arguments, package_paths=(packages,))
    (arm,) = load_config(written(request, tmp_path / "ikgen.toml"))
    assert arm.request.robot.resolve() == AR4 and arm.request.args == arguments
    assert [p.resolve() for p in arm.request.package_paths] == [packages]
    assert arm.outputs.out == tmp_path / "generated"
    assert not Path(robot_entry(tmp_path / "ikgen.toml")).is_absolute()


def robot_entry(path: Path) -> str:
    """The robot's path as the config has it."""
    return path.read_text().partition('robot = "')[2].partition('"')[0]


def test_texts_are_quoted(tmp_path: Path) -> None:
    robot = tmp_path / "robot.xacro"
    robot.write_text((FIXTURES / "ur5e.urdf").read_text())
    request = Request(robot, args={'odd "name"': 'a \\ "b"\t\x7f'})
    arms = robot_arms(request)
    write_config(tmp_path / "ikgen.toml", request, arms, ["python"], force=False)
    assert load_config(tmp_path / "ikgen.toml")[0].request.args == request.args


def test_table_is_one_arm(tmp_path: Path) -> None:
    path = written(Request(FIXTURES / "scara_standard.toml"), tmp_path / "ikgen.toml")
    (arm,) = load_config(path)
    assert arm.name == "scara" and arm.request.base is None and arm.request.tip is None


def test_arms_that_share_a_trunk_begin_where_they_part(tmp_path: Path) -> None:
    arms = "".join(
        branch(side, ("shoulder", "upper", "elbow", "fore", "wrist")) for side in ("left", "right")
    )
    path = tmp_path / "torso.urdf"
    path.write_text(
        f'<robot name="t"><link name="base_link"/>{joint("waist", "base_link")}{arms}</robot>'
    )
    found = robot_arms(Request(path))
    assert [(a.name, a.base, a.dof, a.trunk) for a in found] == [
        (f"t_{side}_wrist_link", "waist_link", 5, "base_link") for side in ("left", "right")
    ]
    text = written(Request(path), tmp_path / "ikgen.toml").read_text()
    assert 'base = "waist_link"  # with the joints that arms share: "base_link"' in text
    assert len(load_config(tmp_path / "ikgen.toml")) == 2


def joint(name: str, parent: str, axis: str = "0 0 1") -> str:
    return (
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{name}_link"/>'
        f'<origin xyz="0.1 0.2 0.3"/><axis xyz="{axis}"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        f'<link name="{name}_link"/>'
    )


def branch(side: str, names: tuple[str, ...], second: str = "1 0 0") -> str:
    """Joints about the y axis, the second one about another."""
    parents = ("waist_link", *(f"{side}_{name}_link" for name in names))
    axes = ["0 1 0", second, *["0 1 0"] * (len(names) - 2)]
    return "".join(map(joint, (f"{side}_{n}" for n in names), parents, axes))


def test_branches_that_move_in_a_plane_have_the_joint_that_turns_it(tmp_path: Path) -> None:
    """The two sides of a palletizer's parallelogram part behind its column."""
    arms = "".join(branch(side, ("x", "y", "z", "end"), "0 1 0") for side in ("rod", "arm"))
    path = tmp_path / "palletizer.urdf"
    path.write_text(
        f'<robot name="t"><link name="base_link"/>{joint("waist", "base_link")}{arms}</robot>'
    )
    assert [(a.base, a.dof, a.trunk) for a in robot_arms(Request(path))] == [
        ("base_link", 5, "") for _ in range(2)
    ]


def test_names_that_tips_share_are_told_apart(tmp_path: Path) -> None:
    arms = joint("waist", "base_link") + branch("a", ("x", "y", "z", "end"))
    arms += branch("a-", ("x", "y", "z", "end")).replace("a-_end", "a-end")
    path = tmp_path / "twins.urdf"
    path.write_text(f'<robot name="t"><link name="base_link"/>{arms}</robot>')
    names = [arm.name for arm in robot_arms(Request(path))]
    assert names == ["t_a_end_link", "t_a_end_link_2"]


def test_a_config_is_not_replaced(tmp_path: Path) -> None:
    request = Request(FIXTURES / "scara_standard.toml")
    path = written(request, config_path(tmp_path))
    assert path == tmp_path / "ikgen.toml"
    before = path.read_text()
    with pytest.raises(UsageError, match="is there already"):
        written(request, path)
    assert path.read_text() == before


def test_arms_are_added_to_a_config(tmp_path: Path) -> None:
    table, path = Request(FIXTURES / "scara_standard.toml"), tmp_path / "ikgen.toml"
    written(table, path)
    path.write_text("# mine\n" + path.read_text().rstrip("\n"))
    before = path.read_text()
    other = tmp_path / "scara_standard.toml"
    other.write_bytes(table.robot.read_bytes())
    (first,) = load_config(path)
    (added,) = add_to_config(path, Request(other), robot_arms(Request(other)), ["cpp"])
    assert path.read_text().startswith(before + "\n\n[[arm]]\n")
    assert [arm.name for arm in load_config(path)] == [first.name, added.name]
    assert added.name == f"{first.name}_2"
    assert load_config(path)[1].outputs.emit == ("cpp",)
    with pytest.raises(UsageError, match=f"lists this arm already, as {first.name}"):
        add_to_config(path, table, robot_arms(table), ["python"])
    with pytest.raises(UsageError, match="not of ikgen alone"):
        add_to_config(tmp_path / "pyproject.toml", table, robot_arms(table), ["python"])


def test_variants_of_one_description_are_arms_of_their_own(tmp_path: Path) -> None:
    robot, path = tmp_path / "arm.urdf.xacro", config_path(tmp_path)
    robot.write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="one">'
        '<xacro:arg name="variant" default="short"/><link name="waist_link"/>'
        f"{branch('m', ('x', 'y', 'z', 'end'))}</robot>"
    )
    written(Request(robot), path)
    other = Request(robot, args={"variant": "long"})
    (added,) = add_to_config(path, other, robot_arms(other), ["python"])
    names = [arm.name for arm in load_config(path)]
    assert names[1] == added.name != names[0]
    with pytest.raises(UsageError, match=f"lists this arm already, as {added.name}"):
        add_to_config(path, other, robot_arms(other), ["python"])


def test_another_chain_of_a_robot_is_added_by_its_tip(tmp_path: Path) -> None:
    """Of a robot with one arm names have no tip; a number would not say what it is."""
    robot = tmp_path / "arm.urdf"
    links = branch("m", ("x", "y", "z", "end"))
    robot.write_text(f'<robot name="one"><link name="waist_link"/>{links}</robot>')
    path = config_path(tmp_path)
    written(Request(robot), path)
    chain = Request(robot, base="m_x_link", tip="m_z_link")
    (added,) = add_to_config(path, chain, robot_arms(chain), ["python"])
    other = replace(chain, base="m_y_link")
    (again,) = add_to_config(path, other, robot_arms(other), ["python"])
    assert (added.name, again.name) == ("one_m_z_link", "one_m_z_link_2")


def test_arms_between_links_that_are_named() -> None:
    yumi = Request(FIXTURES / "abb_yumi.urdf")
    every = robot_arms(yumi)
    assert len(every) == 2
    for arm in every:
        assert arm.base is not None and arm.tip is not None
        assert robot_arms(replace(yumi, tip=arm.tip)) == (arm,)
    elbow = replace(yumi, base="yumi_body", tip="yumi_link_4_l")
    (part,) = robot_arms(elbow)
    assert (part.base, part.tip, part.dof) == ("yumi_body", "yumi_link_4_l", 4)
    assert part.name.endswith("yumi_link_4_l")
    (left,) = robot_arms(replace(yumi, base="yumi_link_1_l"))
    assert left.base == "yumi_link_1_l" and left.tip in {arm.tip for arm in every}
    with pytest.raises(UsageError, match="a DH table is one chain"):
        robot_arms(Request(FIXTURES / "scara_standard.toml", base="a"))
    with pytest.raises(UsageError, match="no arm found in 'yumi' below 'gripper_l_finger_r'"):
        robot_arms(replace(yumi, base="gripper_l_finger_r"))


def test_an_arm_that_is_too_long_is_refused(tmp_path: Path) -> None:
    joints = [(f"j{k}", "revolute", "0 0 1", "0.1 0 0", (-1.0, 1.0)) for k in range(40)]
    path = tmp_path / "snake.urdf"
    path.write_text(serial_urdf("snake", joints))
    with pytest.raises(UsageError, match="40 joints move between"):
        robot_arms(Request(path))


def test_robot_without_an_arm_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "box.urdf"
    path.write_text('<robot name="box"><link name="base_link"/></robot>')
    with pytest.raises(UsageError, match="no arm found in 'box'"):
        robot_arms(Request(path))
