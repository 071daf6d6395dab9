"""Expanding xacro: packages, arguments, dependencies, and errors in words."""

from __future__ import annotations

import contextlib
import math
import shutil
from pathlib import Path

import pytest

from ikgen.errors import BadDescriptionError
from ikgen.importers import load_tree
from ikgen.importers.packages import PackageFinder, PackageNotFoundError
from ikgen.importers.xacro.expansion import expand

FIXTURES = Path(__file__).parents[3] / "urdf_fixtures"
AR4 = FIXTURES / "ar4_ros_driver/annin_ar4_description"
AR4_ARGUMENTS = {"ar_model": "mk3", "include_gripper": "false"}
OPEN = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "pkg" / "urdf" / "bot.urdf.xacro"
    path.parent.mkdir(parents=True)
    return path


def write(path, *lines):
    path.write_text(OPEN + "\n".join([*lines, '<link name="a"/>', "</robot>"]))
    return path


def package(directory, name=None):
    directory.mkdir(parents=True, exist_ok=True)
    name = name or directory.name
    (directory / "package.xml").write_text(f'<package format="3"><name>{name}</name></package>')
    return directory


def test_a_published_package():
    tree = load_tree(AR4 / "urdf/ar.urdf.xacro", arguments=AR4_ARGUMENTS)
    assert (tree.name, tree.root_link, tree.source.kind) == ("mk3", "world", "xacro")
    assert tree.joints[1].limits.lower == pytest.approx(math.radians(-170), abs=1e-15)
    assert tree.source.arguments == (("ar_model", "mk3"), ("include_gripper", "false"))
    assert [path.relative_to(AR4.resolve()).as_posix() for path in tree.source.dependencies] == [
        "urdf/ar.urdf.xacro",
        "urdf/ar_macro.xacro",
        "config/mk3.yaml",
    ]


def test_the_digest_is_the_same_wherever_the_package_lies(tmp_path):
    shutil.copytree(AR4, tmp_path / "elsewhere" / "copied")
    here = load_tree(AR4 / "urdf/ar.urdf.xacro", arguments=AR4_ARGUMENTS)
    there = load_tree(tmp_path / "elsewhere/copied/urdf/ar.urdf.xacro", arguments=AR4_ARGUMENTS)
    assert here.source.sha256 == there.source.sha256
    assert str(tmp_path) not in there.source.text


def test_a_missing_argument_is_named_with_its_line():
    with pytest.raises(BadDescriptionError, match="argument 'ar_model' has no value") as caught:
        load_tree(AR4 / "urdf/ar.urdf.xacro")
    assert caught.value.line == 2
    assert "--arg ar_model:=VALUE" in caught.value.hint


def test_a_robots_name_may_come_from_an_argument_declared_below(file):
    text = OPEN.replace('"r"', '"$(arg n)"') + '<xacro:arg name="n" default="arm"/><link name="a"/>'
    file.write_text(text + "</robot>")
    assert load_tree(file).name == "arm"
    assert load_tree(file, arguments={"n": "leg"}).name == "leg"


def test_an_argument_that_nothing_takes_is_a_warning(file):
    write(file, '<xacro:arg name="side" default="left"/>')
    tree = load_tree(file, arguments={"sied": "right"})
    words = "argument 'sied' is not used by the file; it takes: side"
    assert tree.source.warnings == (f"{file}: {words}",)


def test_expressions_yaml_units_and_environment(file, monkeypatch):
    monkeypatch.setenv("IKGEN_TEST_LENGTH", "0.25")
    (file.parent / "angles.yaml").write_text("j: {low: !degrees -90, high: !radians 1.5}\n")
    write(
        file,
        '<xacro:property name="y" value="${xacro.load_yaml(\'angles.yaml\')}"/>',
        '<link name="b"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/>',
        '<origin xyz="$(optenv IKGEN_TEST_LENGTH 1) ${2*pi} $(eval 1 + 2)"/>',
        "<limit lower=\"${y['j']['low']}\" upper=\"${y['j']['high']}\"/></joint>",
    )
    tree = load_tree(file)
    joint = tree.joints[0]
    assert joint.T_parent_child[:3, 3].tolist() == [0.25, 2 * math.pi, 3.0]
    assert (joint.limits.lower, joint.limits.upper) == (-math.pi / 2, 1.5)
    assert (file.parent / "angles.yaml").resolve() in tree.source.dependencies


REFUSED = {
    "xml": ("<link>", "not well-formed", "correct"),
    "missing package": (
        '<xacro:include filename="$(find nowhere)/a.xacro"/>',
        "package 'nowhere' not found",
        "--package-path",
    ),
    "missing package by url": (
        '<xacro:include filename="package://nowhere/a.xacro"/>',
        "package 'nowhere' not found",
        "--package-path",
    ),
    "missing include": ('<xacro:include filename="gone.xacro"/>', "gone.xacro", "check the path"),
    "missing yaml": (
        "<link name=\"${xacro.load_yaml('gone.yaml')}\"/>",
        "gone.yaml",
        "check the path",
    ),
    "undefined name": ('<link name="${width}"/>', "'width' is not defined", "expression"),
    "unknown macro": ("<xacro:gripper/>", "gripper", "macro"),
    "no default": ('<xacro:arg name="side"/>', '<xacro:arg name="side"> has no default', "--arg"),
    "no argument": ('<link name="$(arg side)"/>', "'side' has no value", "--arg side:=VALUE"),
    "endless": (
        '<xacro:macro name="m" params=""><xacro:m/></xacro:macro><xacro:m/>',
        "never end",
        "itself",
    ),
}


def test_an_argument_without_default_is_named_where_all_stands_on_one_line(file):
    arguments = '<xacro:arg name="first" default="1"/><xacro:arg name="side"/>'
    file.write_text(OPEN.strip() + arguments + "</robot>")
    with pytest.raises(BadDescriptionError, match=r':1: <xacro:arg name="side"> has no default'):
        load_tree(file)


def test_what_a_comment_says_is_not_what_fails(file):
    write(file, '<!--\n<xacro:arg name="old"/> $(arg side) -->', '<link name="$(arg side)"/>')
    with pytest.raises(BadDescriptionError) as caught:
        load_tree(file)
    assert (
        caught.value.line == file.read_text().splitlines().index('<link name="$(arg side)"/>') + 1
    )
    write(file, '<!-- <xacro:arg name="old"/> --><xacro:arg name="side"/>')
    with pytest.raises(BadDescriptionError, match=r'<xacro:arg name="side"> has no default'):
        load_tree(file)


@pytest.mark.parametrize("case", REFUSED)
def test_refused_with_place_and_hint(file, case):
    text, message, hint = REFUSED[case]
    with pytest.raises(BadDescriptionError) as caught:
        load_tree(write(file, "", text))
    assert message in caught.value.message and hint in caught.value.hint
    assert "bot.urdf.xacro" in caught.value.file


def test_errors_in_an_included_file_name_that_file(file):
    write(file, '<xacro:include filename="part.xacro"/>')
    (file.parent / "part.xacro").write_text("<robot>\n<link>\n</robot>")
    with pytest.raises(BadDescriptionError, match=r"part\.xacro:3: not well-formed"):
        load_tree(file)


def test_errors_in_an_included_macro_name_the_line_of_its_expression(file):
    write(file, '<xacro:include filename="part.xacro"/>', "<xacro:m/>")
    body = '<xacro:macro name="m" params="">\n<link name="${width + 1}"/>\n</xacro:macro>'
    (file.parent / "part.xacro").write_text(OPEN + body + "</robot>")
    with pytest.raises(BadDescriptionError, match=r"part\.xacro:3: .*'width' is not defined"):
        load_tree(file)


MISTAKES = {
    "a parameter left out": '<xacro:m len="1" side="2"/>',
    "a parameter too many": '<xacro:m len="1" width="2" side="2" high="3"/>',
    "no such macro": "<xacro:mm/>",
    "no such block": '<xacro:insert_block name="origin"/>',
    "no condition": '<xacro:if value="maybe"/>',
    "no such variable": '<link name="$(env IKGEN_HAS_NO_SUCH)"/>',
    "no such instruction": '<link name="$(first second)"/>',
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_named_with_its_line(file, mistake):
    macro = '<xacro:macro name="m" params="len width side"/>'
    right = '<xacro:m len="1" width="2" side="3"/>'
    with pytest.raises(BadDescriptionError, match="xacro cannot expand the file") as caught:
        load_tree(write(file, macro, right, MISTAKES[mistake], right))
    assert caught.value.line == 4


def test_bad_yaml_names_its_line(file):
    write(file, "<link name=\"${xacro.load_yaml('bad.yaml')}\"/>")
    (file.parent / "bad.yaml").write_text("a: 1\nb: [1,\n")
    with pytest.raises(BadDescriptionError, match=r"bad\.yaml:3: not valid YAML"):
        load_tree(file)


def test_faults_of_the_expanded_text_are_told_as_such(file):
    write(file, '<link name="a"/>')
    with pytest.raises(BadDescriptionError, match=r"bot\.urdf\.xacro \(expanded\):\d+: duplicate"):
        load_tree(file)


def test_an_absent_optional_include_is_left_out(file):
    write(file, '<xacro:include filename="gone.xacro" optional="true"/>')
    assert load_tree(file).links == ("a",)


def test_xacro_is_left_as_it_was(file):
    import xacro
    from xacro import substitution_args

    names = ("all_includes", "filestack", "macrostack", "abs_filename_spec", "verbosity")
    before = [getattr(xacro, name) for name in names]
    finder = substitution_args._eval_find
    for text in ("", "${"):
        with contextlib.suppress(BadDescriptionError):
            expand(write(file, text), arguments={})
        assert [getattr(xacro, name) for name in names] == before
        assert substitution_args._eval_find is finder


class TestPackages:
    """Where packages are looked for."""

    def find(self, start, name, *paths, environment=()):
        return PackageFinder(start, paths, dict(environment)).find(name)

    def test_the_package_around_the_file(self, file):
        home = package(file.parents[1], "other_name")
        assert self.find(file, "other_name") == home

    def test_a_directory_of_that_name_without_a_manifest(self, file):
        assert self.find(file, "pkg") == file.parents[1]

    def test_a_sibling(self, file, tmp_path):
        package(file.parents[1])
        sibling = package(tmp_path / "folder", "sibling")
        assert self.find(file, "sibling") == sibling

    def test_a_path_that_is_the_package(self, file, tmp_path):
        there = package(tmp_path / "x/y", "wanted")
        assert self.find(file, "wanted", there) == there

    def test_a_path_that_holds_the_package(self, file, tmp_path):
        there = package(tmp_path / "ws/src/repo/folder", "wanted")
        assert self.find(file, "wanted", tmp_path / "ws") == there

    def test_the_file_s_own_package_comes_first(self, file, tmp_path):
        home = package(file.parents[1])
        package(tmp_path / "ws/pkg")
        assert self.find(file, "pkg", tmp_path / "ws") == home

    def test_the_ament_index(self, file, tmp_path):
        marker = tmp_path / "share/ament_index/resource_index/packages/wanted"
        marker.parent.mkdir(parents=True)
        marker.touch()
        environment = {"AMENT_PREFIX_PATH": f"/nowhere:{tmp_path}"}
        assert self.find(file, "wanted", environment=environment) == tmp_path / "share/wanted"

    def test_a_sourced_workspace_of_ros_1(self, file, tmp_path):
        there = package(tmp_path / "ws/src/repository/wanted")
        environment = {"ROS_PACKAGE_PATH": f":/nowhere:{tmp_path / 'ws/src'}"}
        assert self.find(file, "wanted", environment=environment) == there

    @pytest.mark.parametrize("name", ["../../marker", "/etc/hostname", "..", "", "a/b", ".hidden"])
    def test_a_path_is_no_name(self, file, tmp_path, name):
        (tmp_path / "share/ament_index/resource_index/packages").mkdir(parents=True)
        (tmp_path / "share/ament_index/marker").touch()
        with pytest.raises(PackageNotFoundError):
            self.find(file, name, environment={"AMENT_PREFIX_PATH": str(tmp_path)})

    def test_home_is_no_package_whatever_its_name(self, file, monkeypatch):
        assert self.find(file, "pkg") == file.parents[1]
        monkeypatch.setenv("HOME", str(file.parents[1]))
        with pytest.raises(PackageNotFoundError):
            self.find(file, "pkg")

    def test_not_found_says_where_it_looked(self, file, tmp_path):
        with pytest.raises(PackageNotFoundError, match="'wanted'") as caught:
            self.find(file, "wanted", tmp_path)
        assert str(tmp_path) in caught.value.searched


def test_the_spelling_of_the_first_xacro_is_named_where_it_defines_what_is_missing(file):
    limits = file.parent / "limits.xacro"
    limits.write_text('<robot>\n<!-- <macro/> -->\n<property name="most" value="2"/>\n</robot>')
    write(
        file,
        '<xacro:include filename="limits.xacro"/>',
        '<link name="b"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
        '<limit lower="0" upper="${most}"/></joint>',
    )
    with pytest.raises(BadDescriptionError, match="'most' is not defined") as caught:
        load_tree(file)
    assert "line 3 of limits.xacro has <property>" in caught.value.hint
    assert "write <xacro:property>" in caught.value.hint


def test_an_origin_that_is_inserted_without_the_prefix_is_never_taken_for_none(file):
    write(
        file,
        '<xacro:macro name="arm" params="*origin"><joint name="j" type="fixed">'
        '<insert_block name="origin"/><parent link="a"/><child link="b"/></joint></xacro:macro>',
        '<link name="b"/><xacro:arm><origin xyz="1 2 3"/></xacro:arm>',
    )
    with pytest.raises(BadDescriptionError, match="<insert_block> left in joint 'j'"):
        load_tree(file)


def test_a_file_of_macros_alone_names_them(file):
    file.write_text(
        f'{OPEN}<xacro:macro name="arm" params="prefix"><link name="a"/></xacro:macro>'
        '<xacro:macro name="hand" params=""><link name="b"/></xacro:macro></robot>'
    )
    with pytest.raises(BadDescriptionError, match="no links") as caught:
        load_tree(file)
    assert caught.value.hint == (
        "the file only defines macros (arm, hand): give the file that calls them, by <xacro:arm ...>"
    )
    file.write_text(f"{OPEN}</robot>")
    with pytest.raises(BadDescriptionError, match="no links") as caught:
        load_tree(file)
    assert caught.value.hint == "check that the file is complete"


@pytest.mark.parametrize("name", ["len", "float", "math.sin"])
def test_a_function_in_the_place_of_a_property_is_named(file, name):
    write(file, f'<xacro:property name="x" value="${{2 * 3}}"/>\n<link name="${{{name}}}"/>')
    with pytest.raises(BadDescriptionError) as caught:
        load_tree(file)
    assert f"'{name}' is a function, not a property of the file" in caught.value.message
    assert caught.value.line == 3
