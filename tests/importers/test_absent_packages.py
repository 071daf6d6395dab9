"""xacro files that name packages which are not there: an error only where a file of them is read."""

from __future__ import annotations

import pytest

from ikgen.errors import BadDescriptionError
from ikgen.importers import load_tree

FILE = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="pads" value="$(find pads)"/>
{}
<link name="a"><visual><geometry><mesh filename="file://$(find pads)/a.stl"/></geometry></visual></link>
<gazebo><parameters>${{pads}}/config/a.yaml</parameters></gazebo>
</robot>
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "elsewhere" / "bot.urdf.xacro"
    path.parent.mkdir()
    path.write_text(FILE.format(""))
    return path


@pytest.mark.parametrize("trust", [False, True])
def test_what_is_not_read_stays_a_package_s_address(file, trust):
    text = load_tree(file, trust=trust).source.text
    assert '"package://pads/a.stl"' in text
    assert ">package://pads/config/a.yaml<" in text


def test_the_text_is_the_same_where_the_package_is_there(file, tmp_path):
    absent = load_tree(file).source.sha256
    (tmp_path / "pads").mkdir()
    assert load_tree(file, package_paths=[tmp_path]).source.sha256 == absent


@pytest.mark.parametrize(
    "reading",
    [
        '<xacro:include filename="$(find pads)/a.xacro"/>',
        '<xacro:include filename="${pads}/*.xacro"/>',
        "<link name=\"${xacro.load_yaml(pads + '/a.yaml')}\"/>",
    ],
)
@pytest.mark.parametrize("trust", [False, True])
def test_a_file_of_it_that_is_read_is_an_error_that_says_what_to_give(file, reading, trust):
    file.write_text(FILE.format(reading))
    with pytest.raises(BadDescriptionError, match="package 'pads' not found") as caught:
        load_tree(file, trust=trust)
    assert (
        "DIR, the package's folder (named 'pads', or with a package.xml that says so)"
        in caught.value.hint
    )
    assert caught.value.line == 2


def test_a_package_path_is_the_package_or_has_it(file, tmp_path):
    file.write_text(FILE.format('<xacro:include filename="$(find pads)/urdf/a.xacro"/>'))
    other = tmp_path / "packages" / "pads" / "urdf" / "a.xacro"
    other.parent.mkdir(parents=True)
    other.write_text('<robot><link name="b"/></robot>')
    for path in (tmp_path / "packages", tmp_path / "packages" / "pads"):
        assert load_tree(file, package_paths=[path]).links
