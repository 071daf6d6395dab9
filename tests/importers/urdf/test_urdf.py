"""Reading URDF: what is refused, and with which words; what is bent, and with which warning."""

from __future__ import annotations

import hashlib
import math
import os
import time

import numpy as np
import pytest

from ikgen.errors import BadDescriptionError, UsageError
from ikgen.importers import load_tree
from ikgen.importers.xml_document import LARGEST_FILE
from ikgen.model.joint_tree import JointType, Mimic
from ikgen.verify.oracle import PinocchioOracle

INF = math.inf


def joint(inner="", *, name="j", type_="revolute", parent="a", child="b"):
    return (
        f'<joint name="{name}" type="{type_}"><parent link="{parent}"/><child link="{child}"/>'
        f"{inner}</joint>"
    )


LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def robot(*parts, links="ab", attributes='name="r"'):
    body = "\n".join([*(f'<link name="{link}"/>' for link in links), *parts])
    return f"<robot {attributes}>\n{body}\n</robot>"


@pytest.fixture
def read(tmp_path):
    def read(text, name="bot.urdf"):
        file = tmp_path / name
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
        return load_tree(file)

    return read


def test_a_joint_as_written(read):
    text = robot(
        joint(
            '<origin xyz="+1 .5 -2e-1" rpy="0 0 1.5708"/><axis xyz="0 0 -1"/>'
            '<limit lower="-2" upper="3"/>'
        )
    )
    tree = read(text)
    (only,) = tree.joints
    assert (tree.name, tree.root_link, tree.links) == ("r", "a", ("a", "b"))
    assert (only.name, only.type, only.parent, only.child) == ("j", JointType.REVOLUTE, "a", "b")
    assert only.T_parent_child[:3, 3].tolist() == [1.0, 0.5, -0.2]
    assert only.axis.tolist() == [0.0, 0.0, -1.0]
    assert (only.limits.lower, only.limits.upper, only.line) == (-2.0, 3.0, 4)
    assert tree.source.text == text and tree.source.warnings == ()
    assert tree.source.sha256 == hashlib.sha256(text.encode()).hexdigest()


QUATERNION = 'quat_xyzw="0.3 -0.4 0.5 0.8"'


@pytest.mark.parametrize("version", ["1.1", " 1.2"])
def test_quaternions_of_later_versions_are_rotations(read, version):
    text = robot(
        joint(f"<origin {QUATERNION}/>{LIMIT}"), attributes=f'name="r" version="{version}"'
    )
    tree = read(text)
    unit = np.array([0.3, -0.4, 0.5, 0.8]) / math.sqrt(1.14)
    cross = np.array([[0, -unit[2], unit[1]], [unit[2], 0, -unit[0]], [-unit[1], unit[0], 0]])
    expected = np.eye(3) + 2 * (unit[3] * cross + cross @ cross)
    assert np.abs(tree.joints[0].T_parent_child[:3, :3] - expected).max() < 1e-15
    assert tree.source.warnings == ()
    poses = PinocchioOracle(tree, "a", "b", ["j"]).forward(np.zeros((1, 1)))
    assert np.abs(poses[0, :3, :3] - expected).max() < 1e-12


@pytest.mark.parametrize("version", ["", 'version="1.0"'])
def test_quaternions_of_the_first_version_are_none(read, version, capfd):
    tree = read(robot(joint(f'<origin rpy="0 0 1" {QUATERNION}/>{LIMIT}'), attributes=version))
    assert tree.joints[0].T_parent_child[0, 0] == math.cos(1.0)
    assert [w for w in tree.source.warnings if "quat_xyzw of joint 'j' ignored" in w]
    poses = PinocchioOracle(tree, "a", "b", ["j"]).forward(np.zeros((1, 1)))
    assert np.abs(poses[0] - tree.joints[0].T_parent_child).max() < 1e-12
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(
    ("attributes", "said"),
    [
        (f'rpy="0 0 0" {QUATERNION}', "has both rpy and quat_xyzw"),
        ('quat_xyzw="0 0 0 0"', "quat_xyzw is zero"),
        ('quat_xyzw="1 0 0"', "has 3 numbers where 4 belong"),
    ],
)
def test_quaternions_that_tell_no_rotation_are_refused(read, attributes, said):
    with pytest.raises(BadDescriptionError, match=said) as caught:
        read(robot(joint(f"<origin {attributes}/>{LIMIT}"), attributes='version="1.1"'))
    assert caught.value.line == 4 and caught.value.hint


def test_a_space_that_is_no_plain_one_is_named(read):
    with pytest.raises(BadDescriptionError, match="is not a number") as caught:
        read(robot(joint(f'<origin xyz="0.2\u00a00 0.1"/>{LIMIT}')))
    assert "no plain one" in caught.value.hint


def test_roll_pitch_yaw_turn_about_fixed_axes(read):
    roll, pitch, yaw = 0.3, -1.1, 2.7
    tree = read(robot(joint(f'<origin rpy="{roll} {pitch} {yaw}"/>' + LIMIT)))

    def turn(angle, i, j):
        R = np.eye(3)
        R[i, i] = R[j, j] = math.cos(angle)
        R[j, i] = math.sin(angle)
        R[i, j] = -R[j, i]
        return R

    expected = turn(yaw, 0, 1) @ turn(pitch, 2, 0) @ turn(roll, 1, 2)
    np.testing.assert_allclose(tree.joints[0].T_parent_child[:3, :3], expected, atol=4e-16)


REFUSED = {
    "trailing point": (robot(joint('<origin rpy="0 -1.57. 0"/>')), "-1.57.", "decimal point", 4),
    "comma": (robot(joint('<origin xyz="0.07, 0, 0"/>')), "0.07,", "comma", 4),
    "four numbers": (robot(joint('<origin rpy="0 0 0 1"/>')), "4 numbers where 3", "write 3", 4),
    "no number": (robot(joint('<origin xyz=""/>')), "0 numbers where 3", "write 3", 4),
    "nan": (robot(joint('<origin xyz="nan 0 0"/>')), "not a number", "decimal", 4),
    "underscore": (robot(joint('<origin xyz="1_0 0 0"/>')), "not a number", "decimal", 4),
    "infinite": (robot(joint('<origin xyz="inf 0 0"/>')), "not finite", "finite", 4),
    "huge": (robot(joint('<origin xyz="1e999 0 0"/>')), "not finite", "finite", 4),
    "xacro left": (robot(joint('<origin xyz="$(optenv X 0 0 0)"/>')), "xacro", ".urdf.xacro", 4),
    "limit": (robot(joint('<limit lower="-pi" upper="1"/>')), "lower: '-pi'", "decimal", 4),
    "axis without a direction": (robot(joint("<axis />")), "without xyz", 'xyz="..."', 4),
    "zero axis": (robot(joint('<axis xyz="0 0 0"/>')), "zero axis", "direction", 4),
    "endless axis": (robot(joint('<axis xyz="1e300 1e300 0"/>')), "axis of length", "unit", 4),
    "two axes": (
        robot(joint('<axis xyz="1 0 0"/><axis xyz="0 1 0"/>')),
        "'j' has two <axis> elements that differ",
        "ROS reads the first",
        4,
    ),
    "spherical": (robot(joint(type_="spherical")), "unknown type 'spherical'", "three", 4),
    "no type": (robot(joint(type_="")), "without type", "type=", 4),
    "no parent": (
        robot('<joint name="j" type="fixed"><child link="b"/></joint>'),
        "no <parent>",
        "<parent",
        4,
    ),
    "undefined link": (robot(joint(child="c")), "'c', which is not defined", "there is: a", 4),
    "duplicate link": (robot(links="aab"), "duplicate link 'a', first at line 2", "rename", 3),
    "duplicate joint": (
        robot(joint(), joint(parent="b", child="c"), links="abc"),
        "duplicate joint 'j', first at line 5",
        "rename",
        6,
    ),
    "two parents": (
        robot(joint(), joint(name="k", parent="c"), links="abc"),
        "'b' has two parents: joint 'j' (line 5) and joint 'k'",
        "remove one",
        6,
    ),
    "cycle": (robot(joint(), joint(name="k", parent="b", child="a")), "cycle: ", "closes", 4),
    "cycle beside a root": (
        robot(joint(parent="a", child="b"), joint(name="k", parent="b", child="a"), links="abc"),
        "cycle: ",
        "closes",
        5,
    ),
    "own parent": (robot(joint(child="a")), "cycle: j", "closes", 4),
    "no links": (robot(links=""), "no links", "complete", 1),
    "empty": ("", "empty", "", None),
    "blank": (" \n ", "empty", "", None),
    "text": ("hello", "not well-formed", "not XML", 1),
    "junk before": ("x <?xml version='1.0'?>" + robot(), "not well-formed", "before", 1),
    "two documents": (robot() + "\n" + robot(), "not well-formed", "two documents", 5),
    "cut off": ('<robot name="r">\n<link name="a"', "not well-formed", "correct", 2),
    "merge conflict": (robot("<<<<<<< HEAD"), "not well-formed", "merge conflict", 4),
    "lfs pointer": ("version https://git-lfs.github.com/spec/v1", "not well-formed", "lfs pull", 1),
    "sdf": ("<sdf><model/></sdf>", "<sdf>, not <robot>", "looks like an SDF file", 1),
    "mjcf": ("<mujoco/>", "<mujoco>, not <robot>", "looks like a MuJoCo MJCF file", 1),
    "web page": ("<!doctype html><html><body>404</body></html>", "not well-", "a web page", 1),
    "torn web page": ("\n<!-- 1 --><HTML><br></HTML>", "not well-formed", "a web page", 2),
    "closed web page": ("<html><body/></html>", "<html>, not <robot>", "a web page", 1),
    "xhtml": ('<!DOCTYPE html PUBLIC "-//W3C" "x"><html/>', "names a DTD", "a web page", 1),
    "xacro element": (
        robot("<xacro:include filename='x'/>", attributes='name="r" xmlns:xacro="http://x/xacro"'),
        "<xacro:include>",
        ".urdf.xacro",
        4,
    ),
    "insert_block": (
        robot(joint('<insert_block name="origin"/>')),
        "<insert_block> left in joint 'j'",
        "<xacro:insert_block>",
        4,
    ),
    "bytes": (b'<robot name="\xff\xfe"/>', "cannot decode", "UTF-8", None),
    "encoding": (b'<?xml version="1.0" encoding="nonesuch"?><robot/>', "decode", "UTF-8", None),
    "nul": (b"<robot>\0</robot>", "not well-formed", "correct", 1),
    "xacro undeclared": (robot("<xacro:include filename='x'/>"), "prefix xacro", "xmlns:xacro", 4),
    "undeclared and cut off": (robot("<sensor:camera>"), "mismatch", "correct", 5),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_with_place_and_hint(read, case):
    text, message, hint, line = REFUSED[case]
    with pytest.raises(BadDescriptionError) as caught:
        read(text)
    assert message in caught.value.message
    assert hint in caught.value.hint
    assert caught.value.file.endswith("bot.urdf")
    assert caught.value.line == line
    assert caught.value.exit_code == 2


@pytest.mark.parametrize("comment", ["<!-- a -- b -->", "<!--- a\n<!-- b --->", "<!-- c--->"])
def test_two_hyphens_in_a_comment_are_no_fault(read, comment):
    assert [one.name for one in read(robot(joint(LIMIT), comment)).joints] == ["j"]
    with pytest.raises(BadDescriptionError, match=r"mismatch") as caught:
        read(robot(comment, "<open>"))
    assert caught.value.line == 6 + comment.count("\n")


def test_a_comment_without_an_end_is_refused(read):
    with pytest.raises(BadDescriptionError, match=r"not well-formed"):
        read(robot(joint(LIMIT), "<!-- a -- b"))


BENT = {
    "no name": (robot(joint(LIMIT), attributes=""), "took 'bot' from the file's name"),
    "swapped": (robot(joint('<limit lower="2" upper="-1"/>')), "swapped"),
    "effort": (robot(joint('<limit lower="-1" upper="1" effort="-1"/>')), "negative effort"),
    "no limit": (robot(joint()), "no lower and upper limit"),
    "no range": (robot(joint('<limit effort="1" velocity="1"/>')), "no lower and upper limit"),
    "zero range": (robot(joint('<limit lower="0" upper="0"/>')), "lower = upper = 0"),
    "one value": (robot(joint('<limit lower="1" upper="1"/>')), "cannot move"),
    "half": (robot(joint('<limit upper="1"/>')), "no lower limit: taken as 0"),
    "endless": (
        robot(joint('<limit lower="-2" upper="1e9"/>')),
        "upper limit 1e+09 rad stands for none: taken as 12.5664",
    ),
    "degrees": (robot(joint('<limit lower="-170" upper="170"/>')), "look like degrees"),
    "few degrees": (robot(joint('<limit lower="-22.5" upper="15"/>')), "look like degrees"),
    "odd degrees": (robot(joint('<limit lower="-114.6" upper="0.3"/>')), "look like degrees"),
    "turned by degrees": (
        robot(joint('<origin rpy="0 -90 0"/>' + LIMIT)),
        "rpy 0 -90 0 looks like degrees: taken as rad",
    ),
    "millimetres": (
        robot(
            joint('<origin xyz="0 0 317"/>' + LIMIT),
            joint('<origin xyz="0 0 -450"/>' + LIMIT, name="k", parent="b", child="c"),
            links="abc",
        ),
        "joints lie up to 450 m apart: lengths look like mm or cm: kept as they are",
    ),
    "kilometres": (
        robot(joint('<origin xyz="0 0 3e-4"/>' + LIMIT)),
        "lengths add up to 0.3 mm: kept as they are, but are they in m?",
    ),
    "axis": (robot(joint('<axis xyz="1 0 0.5"/>' + LIMIT)), "axis of length 1.11803 normalised"),
    "twice": (
        robot(joint('<axis xyz="0 1 0"/><axis xyz="0 1 0"/>' + LIMIT)),
        "two <axis> elements that say the same",
    ),
    "axis rpy": (robot(joint('<axis xyz="1 0 0" rpy="0 0 0"/>' + LIMIT)), "has an rpy"),
    "roots": (robot(joint(LIMIT), links="cab"), "several root links: took 'a'"),
    "include": (
        robot(joint(LIMIT), '<include filename="x"/><property name="x" value="1"/>'),
        "<include> and 1 more not read: xacro no longer expands",
    ),
}


def test_one_far_joint_is_no_sign_of_millimetres(read):
    text = robot(joint('<origin xyz="0 0 317"/>' + LIMIT))
    assert read(text).source.warnings == ()


@pytest.mark.parametrize("type_", ["revolute", "prismatic"])
def test_a_slide_of_some_way_is_no_sign_of_kilometres(read, type_):
    text = robot(joint('<origin xyz="0 0 3e-4"/>' + LIMIT, type_=type_))
    assert bool(read(text).source.warnings) == (type_ == "revolute")


@pytest.mark.parametrize("turned", [16.7, 16.7551608, 12.5, 31.4159])
def test_wrists_of_several_turns_are_not_taken_for_degrees(read, turned):
    text = robot(joint(f'<limit lower="{-turned}" upper="{turned}"/>'))
    assert read(text).source.warnings == ()


def metres(*lengths, behind=""):
    """A robot of revolute joints so far from one another, the last two links fixed together."""
    links = "abcdefgh"[: len(lengths) + 1]
    parts = [
        joint(f'<origin xyz="0 {x} 0"/>{LIMIT}', name=f"j{i}", parent=links[i], child=links[i + 1])
        for i, x in enumerate(lengths)
    ]
    tool = joint(
        f'<origin xyz="{behind} 0 0"/>', name="t", type_="fixed", parent=links[-1], child="z"
    )
    return robot(*parts, *([tool] if behind else []), links=links + ("z" if behind else ""))


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (metres(0.4, 455, 0.1, -25, 0.3, 0.2), ["j1", "j3"]),
        (metres(0, 455, 0, 0.1, 0.2), ["j1"]),
        (metres(0.4, 0.3, 0.2, behind="80"), ["t"]),
        (metres(25, 3, 4, 1), []),  # a mast
        (metres(455, 0.1), []),
    ],
)
def test_joints_that_alone_look_like_millimetres_are_named(read, text, names):
    warnings = read(text).source.warnings
    assert [warning.partition("'")[2].partition("'")[0] for warning in warnings] == names
    assert all(warning.partition("bot.urdf:")[2][0].isdigit() for warning in warnings)
    assert all("looks like mm, others' like m: kept as it is" in warning for warning in warnings)


@pytest.mark.parametrize(
    ("lengths", "told"),
    [
        ((10, 12.5, 12, 6.5), True),  # cm
        ((0.2, 0.3, 0.2, 0.3, 0.2, 0.3, 0.1), False),
        ((18, 8, 7, 1), False),  # a crane
    ],
)
def test_links_that_add_up_to_more_than_an_arm_are_told(read, lengths, told):
    warnings = read(metres(*lengths)).source.warnings
    found = [one for one in warnings if "lengths look like mm or cm" in one]
    assert bool(found) == told


def test_where_a_robot_stands_is_no_length_of_it(read):
    fixed = joint('<origin xyz="4000 0 0"/>', name="w", type_="fixed", parent="z", child="a")
    text = metres(0.4, 0.3, 0.2).replace("</robot>", f'<link name="z"/>{fixed}</robot>')
    assert read(text).source.warnings == ()


@pytest.mark.parametrize("case", BENT)
def test_tolerated_with_a_warning(read, case):
    text, warning = BENT[case]
    warnings = read(text).source.warnings
    assert len(warnings) == 1 and warning in warnings[0]


@pytest.mark.parametrize(
    ("type_", "inner", "lower", "upper"),
    [
        ("revolute", '<limit lower="-1" upper="2"/>', -1.0, 2.0),
        ("revolute", '<limit lower="2" upper="-1"/>', -1.0, 2.0),
        ("revolute", '<limit upper="2"/>', 0.0, 2.0),
        ("revolute", "", -INF, INF),
        ("revolute", '<limit lower="0" upper="0"/>', -INF, INF),
        ("revolute", '<limit lower="1" upper="1"/>', 1.0, 1.0),
        ("revolute", '<limit lower="-inf" upper="inf"/>', -INF, INF),
        ("prismatic", "", -INF, INF),
        ("continuous", "", -INF, INF),
        ("continuous", '<limit lower="0" upper="0"/>', -INF, INF),
        ("continuous", '<limit lower="-4" upper="4"/>', -INF, INF),
        ("continuous", '<limit lower="1e300" upper="2e300"/>', -INF, INF),
        ("revolute", '<limit lower="-1e16" upper="1e16"/>', -INF, INF),
        ("revolute", '<limit lower="1e9" upper="2"/>', 2.0, 2.0 + 4 * math.pi),
        ("revolute", '<limit lower="2" upper="inf"/>', 2.0, 2.0 + 4 * math.pi),
        ("revolute", '<limit lower="-500" upper="500"/>', -500.0, 500.0),
        ("prismatic", '<limit lower="-1e5" upper="1e5"/>', -1e5, 1e5),
        ("fixed", '<limit lower="x" upper="4"/>', -INF, INF),
    ],
)
def test_limits(read, type_, inner, lower, upper):
    limits = read(robot(joint(inner, type_=type_))).joints[0].limits
    assert (limits.lower, limits.upper) == (lower, upper)


@pytest.mark.parametrize("type_", ["revolute", "continuous", "prismatic"])
def test_axes_are_unit_vectors(read, type_):
    tree = read(robot(joint('<axis xyz="0 3 -4"/>' + LIMIT, type_=type_)))
    np.testing.assert_allclose(tree.joints[0].axis, [0.0, 0.6, -0.8], atol=1e-16)


def test_an_absent_axis_is_x(read):
    assert read(robot(joint(LIMIT))).joints[0].axis.tolist() == [1.0, 0.0, 0.0]


@pytest.mark.parametrize("type_", ["fixed", "floating", "planar"])
def test_axis_of_joints_without_one_value_is_not_read(read, type_):
    tree = read(robot(joint('<axis xyz="0 0 0"/>', type_=type_)))
    assert tree.joints[0].type.value == type_


def test_mimic_is_kept_whatever_it_names(read):
    tree = read(robot(joint('<mimic joint="absent" multiplier="-2" offset="0.5"/>' + LIMIT)))
    assert tree.joints[0].mimic == Mimic("absent", -2.0, 0.5)


def test_a_link_and_a_joint_may_share_a_name_with_slashes_and_spaces(read):
    text = robot(
        joint(LIMIT, name="my /b", parent="my /a", child="my /b"), links=["my /a", "my /b"]
    )
    tree = read(text)
    assert tree.joints[0].name == tree.joints[0].child == "my /b"


@pytest.mark.parametrize("declared", ["utf-8", "iso-8859-1", "utf-16"])
def test_encodings(read, declared):
    text = f'<?xml version="1.0" encoding="{declared}"?>\n' + robot(attributes='name="café"')
    assert read(text.encode(declared)).name == "café"


def test_digest_does_not_depend_on_line_ends(read):
    text = robot(joint(LIMIT))
    assert read(text).source.sha256 == read(text.replace("\n", "\r\n")).source.sha256


def test_faults_beside_the_kinematics_are_none(read):
    visual = '<link name="c"><visual><geometry><mesh filename="package://no"/></geometry></visual>'
    text = robot(joint(LIMIT), visual + '<inertial><mass value="x"/></inertial></link>')
    assert read(text).links == ("a", "b", "c")


def test_limits_of_continuous_joints_are_one_warning(read):
    limit = '<limit lower="-6.28" upper="6.28"/>'
    joints = [
        joint(limit, name=f"j{i}", type_="continuous", parent="abcd"[i], child="abcd"[i + 1])
        for i in range(3)
    ]
    (warning,) = read(robot(*joints, links="abcd")).source.warnings
    said = "bot.urdf:6: limits of the continuous joint 'j0' and of 2 more ignored"
    assert warning.split("/")[-1].startswith(said)


def test_turned_axes_are_one_warning(read):
    axis = f'<axis xyz="0 0 1" rpy="0 0 0"/>{LIMIT}'
    joints = [
        joint(axis, name=f"j{i}", parent="abcd"[i], child="abcd"[i + 1], type_=kind)
        for i, kind in enumerate(("fixed", "revolute", "revolute"))
    ]
    (warning,) = read(robot(*joints, links="abcd")).source.warnings
    assert warning.endswith("the <axis> of joint 'j1' and of 1 more has an rpy, which URDF ignores")


DOCTYPES = {
    "a bomb": '[<!ENTITY a "x"><!ENTITY b "&a;&a;"><!ENTITY c "&b;&b;">]',
    "a parameter": '[<!ENTITY % p "x">]',
    "a file": '[<!ENTITY e SYSTEM "/etc/hostname">]',
    "an address": '[<!ENTITY e SYSTEM "http://127.0.0.1:9/e">]',
    "a DTD": 'SYSTEM "http://127.0.0.1:9/robot.dtd"',
}


@pytest.mark.parametrize("case", DOCTYPES)
def test_document_types_that_declare_something_are_refused(read, case):
    with pytest.raises(BadDescriptionError, match=r"bot\.urdf:2: <!DOCTYPE> declares") as caught:
        read(f"<?xml version='1.0'?>\n<!DOCTYPE robot {DOCTYPES[case]}>\n" + robot())
    assert "remove it" in caught.value.hint


def test_a_bare_document_type_is_harmless(read):
    assert read("<!DOCTYPE robot>" + robot()).links == ("a", "b")


def test_a_bomb_of_entities_in_an_attribute_ends_at_once(read):
    layers = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 20}">' for i in range(1, 12))
    text = (
        f'<!DOCTYPE robot [<!ENTITY e0 "x">{layers}]><robot name="&e11;"><link name="a"/></robot>'
    )
    with pytest.raises(BadDescriptionError):
        read(text)


def test_prefixes_that_nothing_declares_belong_to_the_name(read):
    limited = joint(f'<ns:axis xyz="1 1 1"/><axis xyz="0 1 0" ns:xyz="1 0 0"/>{LIMIT}')
    tree = read(robot('<sensor:camera name="rgb"><ns:joint/></sensor:camera>', limited))
    assert tree.joints[0].axis.tolist() == [0.0, 1.0, 0.0]
    assert (tree.joints[0].line, tree.links) == (5, ("a", "b"))


def test_deep_nesting_is_refused_with_its_line(read):
    with pytest.raises(BadDescriptionError, match=r"bot\.urdf:\d+: not well-formed") as caught:
        read("<robot>\n" + "<a>" * 100_000 + "</a>" * 100_000 + "</robot>")
    assert "nest" in caught.value.hint


def test_a_file_too_big_is_refused_before_it_is_read(tmp_path):
    file = tmp_path / "bot.urdf"
    with file.open("wb") as stream:
        stream.truncate(LARGEST_FILE + 1)  # sparse: takes no room
    with pytest.raises(BadDescriptionError, match="MB, more than 16 MB"):
        load_tree(file)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes on this system")
def test_pipes_and_devices_are_refused(tmp_path):
    os.mkfifo(tmp_path / "bot.urdf")
    (tmp_path / "zero.urdf").symlink_to("/dev/zero")
    for name in ("bot.urdf", "zero.urdf"):
        with pytest.raises(BadDescriptionError, match="no regular file"):
            load_tree(tmp_path / name)


LARGE = {
    "length": (joint('<origin xyz="1e308 0 0"/>'), "is beyond 10000"),
    "many digits": (joint(f'<origin xyz="{"1" * 5_000_000}x 0 0"/>'), "5000005 characters"),
    "other digits": (joint('<origin xyz="0 0 ٠.٥"/>'), "'٠.٥' in '0 0 ٠.٥' is not a number"),
    "digits in a word": (joint(f'<origin xyz="{"1" * 2000} 0 0"/>'), "is not finite"),
    "multiplier": (joint('<mimic joint="k" multiplier="1e308"/>' + LIMIT), "beyond 1e+06"),
    "offset": (joint('<mimic joint="k" offset="-1e17"/>' + LIMIT), "beyond 1e+06"),
    "limits far out": (joint('<limit lower="1e15" upper="1e16"/>'), "hold no value"),
    "limits at infinity": (joint('<limit lower="inf" upper="inf"/>'), "hold no value"),
    "axis": (joint('<axis xyz="0 0 1e308"/>' + LIMIT), "axis of length 1e+308"),
    "denormal axis": (joint('<axis xyz="0 0 5e-324"/>' + LIMIT), "zero axis"),
    "name": (joint(LIMIT, name="j" * 1_000_000), "has 1000000 characters"),
}


@pytest.mark.parametrize("case", LARGE)
def test_numbers_without_a_meaning_are_refused_with_their_line(read, case):
    text, message = LARGE[case]
    started = time.process_time()
    with pytest.raises(BadDescriptionError) as caught:
        read(robot(text))
    assert time.process_time() - started < 2.0
    assert message in caught.value.message and caught.value.line == 4 and caught.value.hint
    assert len(caught.value.message) < 500


def test_denormal_lengths_and_angles_are_read(read):
    tree = read(robot(joint('<origin xyz="5e-324 1e-310 0" rpy="5e-324 0 0"/>' + LIMIT)))
    assert np.abs(tree.joints[0].T_parent_child - np.eye(4)).max() < 1e-300


def test_a_cycle_of_ten_thousand_joints_is_named_in_short(read):
    count = 10_000
    joints = [
        joint(LIMIT, name=f"j{i}", parent=f"l{i}", child=f"l{(i + 1) % count}")
        for i in range(count)
    ]
    with pytest.raises(
        BadDescriptionError, match=r"cycle: j1 -> j2 .* 9988 more .* -> j0"
    ) as caught:
        read(robot(*joints, links=[f"l{i}" for i in range(count)]))
    assert len(caught.value.message) < 500


def test_urdf_takes_no_arguments(tmp_path):
    file = tmp_path / "bot.urdf"
    file.write_text(robot())
    with pytest.raises(UsageError, match="takes no arguments"):
        load_tree(file, arguments={"x": "1"})
