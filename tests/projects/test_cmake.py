"""The CMake package, with the real CMake where there is one."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

import pytest
from tests.support.precompiled import OPTIONS
from tests.support.sampled import sampled
from tests.support.tools import finished, needs_cmake, printed

import ikgen
from ikgen import __version__
from ikgen.errors import MissingToolError
from ikgen.generation.emitters import EMITTERS
from ikgen.projects.cmake import ament_directory, cmake_directory
from ikgen.verify.runners.cpp_toolchain import find_eigen

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/cmake_only"


def test_the_package_files_agree_on_the_version() -> None:
    files = list(ROOT.glob("**/ikgenConfigVersion.cmake"))
    files = [path for path in files if ".venv" not in path.parts]
    assert len(files) == 3
    assert {re.search(r'"(.+)"', path.read_text()).group(1) for path in files} == {__version__}  # type: ignore[union-attr]
    assert f"<version>{__version__}</version>" in (ament_directory() / "package.xml").read_text()


@needs_cmake
@pytest.mark.skipif(
    "cpp" not in [emitter.name for emitter in EMITTERS], reason="needs the emitter of C++"
)
@pytest.mark.parametrize("generator", sampled(["Ninja", "Unix Makefiles"], ["Ninja"]))
def test_regenerates_when_an_included_file_changes(tmp_path: Path, generator: str) -> None:
    if generator == "Ninja" and shutil.which("ninja") is None:
        pytest.skip("needs ninja")
    shutil.copytree(EXAMPLE, tmp_path / "p")
    listing = tmp_path / "p/CMakeLists.txt"
    text = listing.read_text().replace("VERIFY)", "SAMPLES 50)")
    listing.write_text(text.replace("EMIT cpp python", "EMIT cpp"))
    out = tmp_path / "p" / "b"
    printed(
        "cmake", "-S", ".", "-B", out, "-G", generator, f"-Dikgen_DIR={cmake_directory()}",
        f"-DCMAKE_CXX_FLAGS={OPTIONS}", *_eigen(), cwd=tmp_path / "p",
    )  # fmt: skip
    made = "Generating inverse kinematics"
    generate = ("cmake", "--build", out, "--target", "arm_kinematics_generate")
    assert made in printed(*generate, cwd=tmp_path)
    assert made not in printed(*generate, cwd=tmp_path)
    wrist = tmp_path / "p/urdf/wrist.xacro"
    wrist.write_text(wrist.read_text().replace("0.38", "0.39"))
    text = printed("cmake", "--build", out, cwd=tmp_path)
    assert made in text and "reach" in text
    assert made not in printed("cmake", "--build", out, cwd=tmp_path)


def _eigen() -> list[str]:
    """Where CMake finds Eigen if the system has none of its own."""
    config = [*Path("/usr/share").glob("eigen3/cmake/Eigen3Config.cmake")]
    if config:
        return []
    try:
        return [f"-DCMAKE_PREFIX_PATH={find_eigen().parent.parent}"]
    except MissingToolError:
        pytest.skip("needs Eigen")


_TWO_ARMS = """
cmake_minimum_required(VERSION 3.16)
project(two NONE)
find_package(ikgen REQUIRED)
enable_testing()
ikgen_generate(left ROBOT arm.urdf.xacro ARGS upper_arm:=0.42 EMIT python SAMPLES 20)
ikgen_generate(right ROBOT scara.urdf TASK position-yaw EMIT python SAMPLES 20)
ikgen_committed(third DIRECTORY committed NAME arm CONFIG ikgen.toml SAMPLES 20 VERIFY)
add_custom_target(both ALL)
add_dependencies(both left_generate right_generate)
"""
_CONFIG = """
[[arm]]
name = "arm"
robot = "arm.urdf.xacro"
out = "committed"
samples = 20
"""
_TOOLCHAIN = """
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_FIND_ROOT_PATH "${CMAKE_CURRENT_LIST_DIR}/sysroot")
foreach(kind PROGRAM LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()
"""


@pytest.fixture
def two_arms(tmp_path: Path) -> Path:
    """A project with two generated arms and a committed one."""
    shutil.copytree(EXAMPLE / "urdf", tmp_path, dirs_exist_ok=True)
    shutil.copy(ROOT / "examples/hatch_robot/urdf/scara.urdf", tmp_path)
    (tmp_path / "CMakeLists.txt").write_text(_TWO_ARMS)
    (tmp_path / "ikgen.toml").write_text(_CONFIG)
    printed("ikgen", "build", "--no-verify", "-q", cwd=tmp_path)
    return tmp_path


@needs_cmake
@pytest.mark.long
@pytest.mark.parametrize("generator", ["Ninja", "Unix Makefiles"])
def test_only_the_affected_arm_is_generated_again(two_arms: Path, generator: str) -> None:
    if generator == "Ninja" and shutil.which("ninja") is None:
        pytest.skip("needs ninja")
    directory = f"-Dikgen_DIR={cmake_directory()}"
    printed("cmake", "-S", ".", "-B", "b", "-G", generator, directory, cwd=two_arms)
    left, right = "inverse kinematics left_ik", "inverse kinematics right_ik"
    first = printed("cmake", "--build", "b", cwd=two_arms)
    assert left in first and right in first
    (two_arms / "wrist.xacro").touch()
    again = printed("cmake", "--build", "b", cwd=two_arms)
    assert left in again and right not in again
    (two_arms / "scara.urdf").touch()
    again = printed("cmake", "--build", "b", cwd=two_arms)
    assert right in again and left not in again
    nothing = printed("cmake", "--build", "b", cwd=two_arms)
    assert left not in nothing and right not in nothing


@needs_cmake
@pytest.mark.long  # that a depfile has the version: test_config.py
@pytest.mark.skipif(shutil.which("ninja") is None, reason="needs ninja")
def test_an_update_generates_again(two_arms: Path) -> None:
    """Stands for an installation: a copy of the package, whose version changes."""
    package = Path(ikgen.__file__).parent
    copy = two_arms / "installed/src/ikgen"
    shutil.copytree(package, copy)
    shutil.copytree(ROOT / "templates", two_arms / "installed/templates")
    command = two_arms / "installed/ikgen"
    command.write_text(
        f'#!/bin/sh\nPYTHONPATH="{copy.parent}" exec "{sys.executable}" -m ikgen "$@"\n'
    )
    command.chmod(0o755)
    found = (f"-Dikgen_DIR={cmake_directory()}", f"-DIKGEN_EXECUTABLE={command}")
    printed("cmake", "-S", ".", "-B", "b", "-G", "Ninja", *found, cwd=two_arms)
    build = ("cmake", "--build", "b", "--target", "right_generate")
    made = "inverse kinematics right_ik"
    assert made in printed(*build, cwd=two_arms)
    assert made not in printed(*build, cwd=two_arms)
    stated = copy / "__init__.py"
    stated.write_text(stated.read_text().replace(f'"{__version__}"', '"99.0"'))
    assert made in printed(*build, cwd=two_arms)
    assert '"99.0"' in (two_arms / "b/ikgen/right/right_ik.py").read_text()
    assert made not in printed(*build, cwd=two_arms)


@needs_cmake
def test_committed_outputs_fail_when_the_description_changes(two_arms: Path) -> None:
    printed("cmake", "-S", ".", "-B", "b", f"-Dikgen_DIR={cmake_directory()}", cwd=two_arms)
    printed("ctest", "--output-on-failure", cwd=two_arms / "b")
    wrist = two_arms / "wrist.xacro"
    wrist.write_text(wrist.read_text().replace("0.38", "0.379"))
    done = finished("ctest", "--output-on-failure", cwd=two_arms / "b")
    assert done.returncode != 0
    assert "by up to 1 mm and 0 rad" in done.stdout and "ikgen build ikgen.toml" in done.stdout
    assert list((two_arms / "b/ikgen/third").glob("*.xunit.xml"))


@needs_cmake
def test_a_toolchain_file_does_not_hide_the_command(two_arms: Path) -> None:
    (two_arms / "cross.cmake").write_text(_TOOLCHAIN)
    printed(
        "cmake", "-S", ".", "-B", "b", "-G", "Unix Makefiles",
        "-DCMAKE_TOOLCHAIN_FILE=cross.cmake", f"-DCMAKE_MAKE_PROGRAM={shutil.which('make')}",
        f"-Dikgen_DIR={cmake_directory()}", cwd=two_arms,
    )  # fmt: skip
    assert "left_ik" in printed("cmake", "--build", "b", "--target", "left_generate", cwd=two_arms)
    cache = (two_arms / "b/CMakeCache.txt").read_text()
    program = re.search(r"IKGEN_EXECUTABLE:FILEPATH=(.+)", cache)
    assert program is not None and Path(program.group(1)).is_file()


@needs_cmake
@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("ikgen_generate(arm)", "ROBOT <urdf-or-xacro> is missing"),
        ("ikgen_generate(arm ROBOT nothing.urdf)", "no such file"),
        ("ikgen_generate(arm ROBOT CMakeLists.txt COLOUR red)", "unknown arguments: COLOUR"),
        ("ikgen_generate(arm ROBOT CMakeLists.txt BASE)", "no value for: BASE"),
        ("ikgen_generate(arm ROBOT CMakeLists.txt PACKAGE_PATH no)", "no such directory"),
        ("ikgen_committed(arm)", "DIRECTORY <dir> is missing"),
        ("ikgen_committed(arm DIRECTORY generated)", "no outputs of ikgen"),
        ("ikgen_committed(arm DIRECTORY generated ROBOT a.urdf)", "unknown arguments: ROBOT"),
    ],
)
def test_wrong_calls(tmp_path: Path, line: str, said: str) -> None:
    text = "cmake_minimum_required(VERSION 3.16)\nproject(p NONE)\nfind_package(ikgen REQUIRED)\n"
    (tmp_path / "CMakeLists.txt").write_text(text + line + "\n")
    directory = f"-Dikgen_DIR={cmake_directory()}"
    done = finished("cmake", "-S", ".", "-B", "b", directory, cwd=tmp_path)
    said_there = " ".join(done.stderr.split())
    assert done.returncode != 0 and said in said_there and "hint: " in said_there


_READER = """
cmake_minimum_required(VERSION 3.16)
project(reader CXX)
find_package(ikgen REQUIRED)
ikgen_committed(arm DIRECTORY committed)
add_executable(reader main.cpp)
target_link_libraries(reader PRIVATE ikgen::arm)
"""


@needs_cmake
@pytest.mark.parametrize("found", [True, False])
def test_headers_of_ikgen_s_own_stand_in_for_an_eigen_that_cmake_does_not_find(
    tmp_path: Path, found: bool
) -> None:
    include = tmp_path / "own/include"
    (include / "Eigen").mkdir(parents=True)
    (include / "Eigen/Core").write_text("#define EIGEN_OF_IKGEN 1\n")
    tool = tmp_path / "ikgen"
    told = f'"Eigen": "{include}"' if found else '"Eigen": null'
    tool.write_text(f"#!/bin/sh\ncat <<'END'\n{{ {told} }}\nEND\n")
    tool.chmod(0o755)
    (tmp_path / "committed").mkdir()
    (tmp_path / "committed/arm_ik.hpp").write_text("#include <Eigen/Core>\n")
    (tmp_path / "committed/arm_ik.json").write_text("{}")
    (tmp_path / "CMakeLists.txt").write_text(_READER)
    (tmp_path / "main.cpp").write_text(
        '#include "arm_ik.hpp"\nint main() { return EIGEN_OF_IKGEN - 1; }\n'
    )
    configure = (
        "cmake", "-S", ".", "-B", "b", f"-Dikgen_DIR={cmake_directory()}",
        f"-DIKGEN_EXECUTABLE={tool}", "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON",
    )  # fmt: skip
    done = finished(*configure, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    if found:
        assert f"using the headers in {include}" in done.stdout
        printed("cmake", "--build", "b", cwd=tmp_path)
    else:
        assert "Eigen was not found" in done.stderr and "libeigen3-dev" in done.stderr
