"""The ament package, by following the page on ROS 2 packages with real ament and colcon.

Debian: `apt install ament-cmake ament-cmake-python`. colcon is taken from PATH or the variable
COLCON, and wants an environment of its own:

    python3 -m venv build/colcon
    build/colcon/bin/pip install 'setuptools<80' colcon-common-extensions
    COLCON=$PWD/build/colcon/bin/colcon python -m pytest tests/projects/test_ament.py
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import junitparser
import pytest
from tests.support.snippets import blocks
from tests.support.tools import environment, needs_colcon

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/how-to/ros-package.md"
EXAMPLE = ROOT / "examples/ament_description"


class Workspace:
    """A workspace made by the page's steps; `sh` runs commands in it as the page tells to."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.failed = ""

    def sh(self, commands: str) -> subprocess.CompletedProcess[str]:
        """Run shell commands, with the python3 of ament first on PATH and ours last."""
        return subprocess.run(
            ["bash", "-euc", commands],
            cwd=self.folder,
            env=environment(ament=True),
            text=True,
            capture_output=True,
        )

    def passes(self, commands: str) -> str:
        """Run shell commands that have to succeed."""
        done = self.sh(commands)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout + done.stderr


def test_the_page_shows_the_example() -> None:
    shown = {block.title: block.text for block in blocks(PAGE) if block.is_file}
    assert len(shown) == 7
    for title, text in shown.items():
        file = EXAMPLE / title.removeprefix("src/arm_description/").replace(
            "arm_description/", "ament_description/"
        )
        assert file.read_text().replace("ament_description", "arm_description") == text, title


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    """From an empty directory through the page's steps up to its change of the description."""
    made = Workspace(tmp_path_factory.mktemp("ws"))
    for block in blocks(PAGE):
        if block.title == "change":
            break
        if block.is_file:
            (made.folder / block.title).write_text(block.text)
        elif block.language == "sh" and block.title != "install":
            made.passes(block.text)
    return made


@needs_colcon
def test_installs_headers_and_modules(workspace: Workspace) -> None:
    prefix = workspace.folder / "install/arm_description"
    assert (prefix / "include/arm_description/arm_ik.hpp").is_file()
    (module,) = prefix.glob("l*/**/arm_description/arm_ik.py")
    assert (module.parent / "py.typed").is_file()
    assert workspace.passes("colcon test-result").split("Summary: ")[1].startswith("4")


_USER_CMAKE = """
cmake_minimum_required(VERSION 3.16)
project(arm_user LANGUAGES CXX)
find_package(ament_cmake REQUIRED)
find_package(arm_description REQUIRED)
add_executable(reach reach.cpp)
target_link_libraries(reach PRIVATE arm_description::arm_kinematics)
install(TARGETS reach DESTINATION lib/arm_user)
ament_package()
"""


@needs_colcon
def test_another_package_uses_it(workspace: Workspace) -> None:
    user = workspace.folder / "src/arm_user"
    user.mkdir()
    shutil.copy(ROOT / "examples/cmake_only/src/reach.cpp", user)
    (user / "CMakeLists.txt").write_text(_USER_CMAKE)
    manifest = (EXAMPLE / "package.xml").read_text().replace("ament_description", "arm_user")
    (user / "package.xml").write_text(
        manifest.replace(
            "<build_depend>eigen", "<depend>arm_description</depend><build_depend>eigen"
        )
    )
    said = workspace.passes(
        "colcon build --packages-select arm_user; set +u; . install/setup.sh; set -u;"
        "install/arm_user/lib/arm_user/reach;"
        f"{sys.executable} -c 'from arm_description import arm_ik; print(arm_ik.JOINT_NAMES)'"
    )
    assert "solution 0" in said and "'elbow'" in said


@needs_colcon
@pytest.mark.slow
def test_a_millimetre_without_generating_fails(workspace: Workspace) -> None:
    (change,) = (block.text for block in blocks(PAGE) if block.title == "change")
    done = workspace.sh(change)
    assert done.returncode == 1, done.stdout + done.stderr
    (result,) = workspace.folder.glob("build/**/arm_kinematics_verify.xunit.xml")
    assert junitparser.JUnitXml.fromfile(str(result)).failures == 2  # the module and the header
    for said in ("by up to 1 mm and 0 rad", "ikgen build ikgen.toml"):
        assert said in result.read_text()
        assert said in done.stdout
    failed = workspace.sh("cd src/arm_description && ikgen verify")
    assert failed.returncode == 1
    assert "by up to 1 mm and 0 rad\nhint: ikgen build ikgen.toml\n" in "".join(
        line for line in failed.stderr.splitlines(keepends=True) if "arm_ik.py" not in line
    )
    workspace.passes("cd src/arm_description && ikgen build ikgen.toml")
    workspace.passes("colcon test && colcon test-result")


@needs_colcon
@pytest.mark.slow
def test_generates_during_the_build(workspace: Workspace) -> None:
    (call,) = (block.text for block in blocks(PAGE) if block.title.startswith("instead"))
    package = workspace.folder / "src/arm_description"
    listing = package / "CMakeLists.txt"
    lines = listing.read_text().splitlines()
    call = call.replace("EMIT", "SAMPLES 50 EMIT")
    kept = [call if line.startswith("ikgen_committed") else line for line in lines]
    listing.write_text("\n".join(kept))
    shutil.rmtree(package / "generated")
    commands = "colcon build --symlink-install --packages-select arm_description"
    workspace.passes(
        f"rm -rf build install; {commands.replace('--packages-select', '--packages-up-to')}"
    )
    (header,) = workspace.folder.glob("install/arm_description/include/**/arm_ik.hpp")
    before = header.read_text()
    workspace.passes(
        'sed -i \'s/"forearm" value="0.38"/"forearm" value="0.39"/\' '
        f"src/arm_description/urdf/dimensions.xacro; {commands}"
    )
    assert header.read_text() != before
    workspace.passes("colcon test --packages-select arm_description && colcon test-result")
