"""The registry of importers, and what must not be imported before it is needed."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from ikgen.errors import BadDescriptionError, UsageError
from ikgen.importers import IMPORTERS, importer_of, load_tree, taken_arguments

FIXTURES = Path(__file__).parents[2] / "urdf_fixtures"


@pytest.mark.parametrize("row", IMPORTERS, ids=lambda row: row.kind)
def test_every_row_has_its_module_and_its_test(row):
    assert find_spec(row.module) is not None
    assert (Path(__file__).parent / row.kind / f"test_{row.kind}.py").is_file()


def test_rows_say_what_files_take_and_take_in(tmp_path):
    file = tmp_path / "arm.xacro"
    file.write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">'
        '<xacro:arg name="hand" default="none"/></robot>'
    )
    assert taken_arguments(file) == {"hand": "none"} and not importer_of(file).self_contained
    assert taken_arguments(FIXTURES / "ur5e.urdf") == {}
    assert importer_of(FIXTURES / "ur5e.urdf").self_contained
    assert taken_arguments(tmp_path / "arm.sdf") == {}


@pytest.mark.parametrize(
    ("name", "kind"),
    [("a.urdf", "urdf"), ("A.URDF", "urdf"), ("a.urdf.xacro", "xacro"), ("a.xacro", "xacro")],
)
def test_format_is_told_by_the_suffix(name, kind):
    assert importer_of(Path(name)).kind == kind


def test_unknown_suffix_lists_the_known_ones(tmp_path):
    (tmp_path / "robot.sdf").touch()
    with pytest.raises(UsageError, match=r"suffix '\.sdf'") as caught:
        importer_of(tmp_path / "robot.sdf")
    assert ".urdf" in caught.value.hint and ".xacro" in caught.value.hint


def test_importing_the_registry_loads_no_reader():
    heavy = "{'xacro', 'lxml', 'numpy', 'ikgen.importers.urdf.urdf_tree'}"
    code = f"import sys, ikgen.importers; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_missing_file_and_directory(tmp_path):
    with pytest.raises(BadDescriptionError, match="no such file"):
        load_tree(tmp_path / "absent.urdf")
    with pytest.raises(BadDescriptionError, match="no such file"):
        load_tree(tmp_path / "absent")
    (tmp_path / "folder.urdf").mkdir()
    with pytest.raises(BadDescriptionError, match="is a directory"):
        load_tree(tmp_path / "folder.urdf")
    with pytest.raises(BadDescriptionError, match="no such file"):
        load_tree(tmp_path / "absent.xacro")


@pytest.mark.parametrize("file", sorted(FIXTURES.glob("*.urdf")), ids=lambda path: path.stem)
def test_fixtures_are_read_without_complaint(file):
    tree = load_tree(file)
    assert tree.source.warnings == ()
    assert tree.source.dependencies == (file.resolve(),)
    for joint in tree.joints:
        assert not joint.axis.flags.writeable and not joint.T_parent_child.flags.writeable


def test_folder_is_told_as_one(tmp_path):
    with pytest.raises(UsageError, match="is a folder") as told:
        importer_of(tmp_path)
    assert str(tmp_path) in told.value.hint
