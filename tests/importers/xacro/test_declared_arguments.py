"""The arguments of a xacro file, known without expanding it."""

from __future__ import annotations

from pathlib import Path

import pytest

from ikgen.importers.xacro.declared_arguments import declared_arguments

AR4 = Path(__file__).parents[3] / "urdf_fixtures/ar4_ros_driver/annin_ar4_description"
OPEN = '<robot name="$(arg name)" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'


def test_arguments_of_a_published_file():
    taken = declared_arguments(AR4 / "urdf/ar.urdf.xacro")
    assert taken == {"ar_model": None, "tf_prefix": "", "include_gripper": "true"}


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "bot.urdf.xacro"
    path.write_text(
        OPEN + '<xacro:arg name="side" default="left"/><xacro:include filename="part.xacro"/>'
        '<xacro:include filename="$(arg side).xacro"/><xacro:include filename="gone.xacro"/>'
        '<xacro:include filename="bot.urdf.xacro"/><xacro:include filename="/etc/hostname"/>'
        "<link name='${undefined}'/></robot>"
    )
    part = '<xacro:arg name="length" default="${2 * pi}"/><link name="$(arg bare)"/></robot>'
    (tmp_path / "part.xacro").write_text(OPEN + part)
    return path


def test_includes_are_followed_and_nothing_is_evaluated(file):
    taken = {"name": None, "side": "left", "length": "${2 * pi}", "bare": None}
    assert declared_arguments(file) == taken


def test_a_file_that_cannot_be_read_takes_none(tmp_path):
    assert declared_arguments(tmp_path / "gone.xacro") == {}
    (tmp_path / "bad.xacro").write_text("<robot")
    assert declared_arguments(tmp_path / "bad.xacro") == {}
