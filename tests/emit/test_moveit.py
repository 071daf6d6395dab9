"""The emitted MoveIt package through CMake: the real ament_cmake, and packages that have targets only."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from tests.support.solving import FIXTURES
from tests.support.tools import printed

from ikgen.derivation.derive import derive
from ikgen.emit.moveit import emit
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

STUBS = Path(__file__).resolve().parents[1] / "conformance" / "moveit_stubs"
PACKAGE = "kuka_kr6r900sixx_ik_moveit"
DEPENDENCIES = ("geometry_msgs", "moveit_core", "moveit_msgs", "pluginlib", "rclcpp")

# What pluginlib's own macro does at once, it leaves to ament_package() in part.
_PLUGINLIB = """
macro(pluginlib_export_plugin_description_file category file)
  install(FILES ${file} DESTINATION share/${PROJECT_NAME})
  ament_index_register_resource("${category}__pluginlib__plugin" CONTENT "share/${PROJECT_NAME}/${file}\\n")
endmacro()
"""
# Distributions from which ament_target_dependencies() was removed.
_NEWEST_AMENT = """
foreach(name ament_index_register_resource ament_export_targets ament_export_dependencies ament_package)
  cmake_language(EVAL CODE "function(${name})\\nendfunction()")
endforeach()
"""


def ament_python() -> str | None:
    """An interpreter that has what ament_cmake calls, where ament_cmake is installed."""
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep), "/usr"]
    if not any((Path(p) / "share/ament_cmake/cmake").is_dir() for p in prefixes if p):
        return None
    if importlib.util.find_spec("ament_package"):
        return sys.executable
    command = ["/usr/bin/python3", "-c", "import ament_package"]
    found = shutil.which(command[0]) and subprocess.run(command, capture_output=True, check=False)
    return command[0] if found and found.returncode == 0 else None


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """The package in `src`, its dependencies in `stub`: their headers are the stub interfaces."""
    if shutil.which("cmake") is None or shutil.which("g++") is None:
        pytest.skip("needs cmake and g++")
    module = derive(Request(FIXTURES / "kuka_kr6r900sixx.urdf")).module
    for path, text in emit(module).items():
        (tmp_path / "src" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "src" / path).write_text(text)
    for name in DEPENDENCIES:
        config(tmp_path, name, f"set({name}_INCLUDE_DIRS {STUBS}/common {STUBS}/hpp)\n")
    config(tmp_path, "pluginlib", _PLUGINLIB)
    return tmp_path


def config(workspace: Path, name: str, text: str) -> None:
    path = workspace / f"stub/share/{name}/cmake/{name}Config.cmake"
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a") as file:
        file.write(text)


def configure(workspace: Path, *words: str) -> None:
    prefix = f"-DCMAKE_PREFIX_PATH={workspace / 'stub'}"
    debug = "-DCMAKE_BUILD_TYPE=Debug"
    printed("cmake", "-S", f"src/{PACKAGE}", "-B", "build", prefix, debug, *words, cwd=workspace)


@pytest.mark.slow
def test_ament_builds_and_registers_the_plugin(workspace: Path) -> None:
    python = ament_python()
    if python is None:
        pytest.skip("needs ament_cmake")
    out = workspace / "out"
    configure(workspace, f"-DPython3_EXECUTABLE={python}", f"-DCMAKE_INSTALL_PREFIX={out}")
    printed("cmake", "--build", "build", cwd=workspace)
    printed("cmake", "--install", "build", cwd=workspace)
    tested = ("ctest", "--test-dir", "build", "--output-on-failure", "-R", "^solver$")
    assert "100% tests passed, 0 tests failed out of 1" in printed(*tested, cwd=workspace)
    resources = out / "share/ament_index/resource_index"
    listed = (resources / "moveit_core__pluginlib__plugin" / PACKAGE).read_text().strip()
    assert (out / listed).is_file() and (resources / "packages" / PACKAGE).is_file()
    assert (out / f"lib/lib{PACKAGE}.so").is_file()
    assert (out / f"include/{PACKAGE}/{PACKAGE}/search.hpp").is_file()
    assert (out / f"share/{PACKAGE}/config/kinematics.yaml").is_file()


def test_packages_with_targets_only_are_linked(workspace: Path) -> None:
    config(workspace, "ament_cmake", _NEWEST_AMENT)
    for name in DEPENDENCIES:
        target = f"{name}::{name}"
        define = f"INTERFACE_COMPILE_DEFINITIONS FROM_{name}"
        made = f"add_library({target} INTERFACE IMPORTED)\nset({name}_TARGETS {target})\n"
        config(workspace, name, f"{made}set_target_properties({target} PROPERTIES {define})\n")
    configure(workspace, "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
    commands = (workspace / "build/compile_commands.json").read_text()
    assert all(f"-DFROM_{name}" in commands for name in DEPENDENCIES)
