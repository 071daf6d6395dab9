"""The files of the emitted MoveIt package."""

from __future__ import annotations

import dataclasses
import warnings
from pathlib import Path
from xml.etree import ElementTree

import pytest
from tests.support.moveit_arms import (
    FRANKA,
    KUKA,
    MANIPULATOR,
    missing_tools,
    module_of,
    write_package,
)
from tests.support.moveit_driver import own_test, warnings_of
from tests.support.sampled import sampled

from ikgen.emit.moveit import emit, package_name

pytestmark = pytest.mark.usefixtures("solved_once")

NO_CLANG = missing_tools("clang++")


@pytest.mark.parametrize("name", [KUKA, FRANKA])
def test_the_files_fit_together(name: str) -> None:
    module = module_of(name)
    package = package_name(module.name)
    files = emit(module)
    assert files == emit(module)
    assert all(path.startswith(f"{package}/") for path in files)
    manifest = ElementTree.fromstring(files[f"{package}/package.xml"])
    assert manifest.get("format") == "3" and manifest.findtext("name") == package
    library = ElementTree.fromstring(files[f"{package}/plugin.xml"])
    exported = library[0].attrib
    assert library.get("path") == package
    assert exported["base_class_type"] == "kinematics::KinematicsBase"
    source = files[f"{package}/src/kinematics_plugin.cpp"]
    assert f"PLUGINLIB_EXPORT_CLASS({exported['type']}, {exported['base_class_type']})" in source
    assert f"kinematics_solver: {exported['name']}\n" in files[f"{package}/config/kinematics.yaml"]
    assert exported["name"] in files[f"{package}/README.md"]
    cmake = files[f"{package}/CMakeLists.txt"]
    sources = [word.rstrip(")") for word in cmake.split() if ".cpp" in word]
    assert len(sources) == 3 and all(f"{package}/{path}" in files for path in sources)


def test_odd_names_stay_inside_their_files(tmp_path: Path) -> None:
    odd = 'tool <0> & "--" \n é'
    module = module_of(KUKA)
    module = dataclasses.replace(module, maintainer="A & B <a@b.c>", license="<&>")
    dh = dataclasses.replace(module.dh, tip_link=odd, robot=odd)
    files = emit(dataclasses.replace(module, dh=dh, name="My__Arm", generator_version="1.2.3.dev4"))
    manifest = ElementTree.fromstring(files["my_arm_ik_moveit/package.xml"])
    assert f"of {odd}, {dh.base_link} to {odd}, as" in manifest.findtext("description", "")
    assert manifest.findtext("version") == "1.2.3" and manifest.findtext("license") == "<&>"
    maintainer = manifest.find("maintainer")
    assert maintainer is not None
    assert (maintainer.text, maintainer.get("email")) == ("A & B", "a@b.c")
    ElementTree.fromstring(files["my_arm_ik_moveit/plugin.xml"])


def test_ros_accepts_the_manifest(tmp_path: Path) -> None:
    catkin = pytest.importorskip("catkin_pkg.package", reason="needs catkin_pkg")
    package = write_package(module_of(KUKA), tmp_path)
    problems: list[str] = []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parsed = catkin.parse_package(str(package), warnings=problems)
    assert not problems and parsed.get_build_type() == "ament_cmake"
    assert {d.name for d in parsed.build_depends} >= {"moveit_core", "pluginlib", "rclcpp"}


@pytest.mark.skipif(bool(missing_tools("g++")), reason=missing_tools("g++"))
@pytest.mark.parametrize("name", sampled([FRANKA, MANIPULATOR], [FRANKA]))
def test_its_own_test_passes(name: str, tmp_path: Path) -> None:
    done = own_test(write_package(module_of(name), tmp_path), tmp_path / "own")
    assert done.returncode == 0 and " 0 of them wrong" in done.stdout, done.stdout


@pytest.mark.skipif(bool(missing_tools("g++")), reason=missing_tools("g++"))
def test_its_own_test_tells_missing_solutions(tmp_path: Path) -> None:
    package = write_package(module_of(MANIPULATOR), tmp_path)
    candidates = package / "include" / package.name / "candidates.hpp"
    text = candidates.read_text()
    broken = text.replace("&& within_reach(q, query)", "&& rows.size() > 1000")
    assert broken != text
    candidates.write_text(broken)
    assert own_test(package, tmp_path / "own").returncode == 1


@pytest.mark.skipif(bool(NO_CLANG), reason=NO_CLANG)
@pytest.mark.parametrize(
    ("name", "style"), [pytest.param(KUKA, "h", marks=pytest.mark.long), (FRANKA, "hpp")]
)
def test_the_other_compiler_has_nothing_to_say(name: str, style: str, tmp_path: Path) -> None:
    assert warnings_of("clang++", write_package(module_of(name), tmp_path), style) == ""
