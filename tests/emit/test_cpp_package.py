"""The C++ package stands alone: it builds its example, installs, and is found by another project."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from tests.support.held_arms import held_module
from tests.support.tools import needs_cmake

from ikgen.emit.cpp.cpp_package import emit
from ikgen.generation.generate import generate
from ikgen.generation.request import Outputs, Request

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"
STRICT = "-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror"
USER = """cmake_minimum_required(VERSION 3.15)
project(user LANGUAGES CXX)
find_package({name} REQUIRED)
add_executable(user user.cpp)
target_link_libraries(user PRIVATE {name}::{name})
"""
PROGRAM = """#include <{name}.hpp>
int main() {{
  namespace ik = {name};
  return ik::solve(ik::forward(ik::Joints::Constant(0.3))).status == ik::Status::Ok ? 0 : 1;
}}
"""


def sh(*command: object) -> str:
    """Run a command that has to succeed."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@needs_cmake
@pytest.mark.parametrize(
    ("robot", "free"), [("kuka_kr6r900sixx", {}), ("franka_fr3", {"fr3_joint7": 0.3})]
)
def test_package_builds_installs_and_is_found(
    robot: str, free: dict[str, float], tmp_path: Path
) -> None:
    request = Request(FIXTURES / f"{robot}.urdf", free=free, name="arm")
    made = generate(request, Outputs(emit=("cpp-package",), out=tmp_path, samples=60))
    assert made.reports["cpp-package"].passed
    package, build, prefix = tmp_path / "arm_ik_cpp", tmp_path / "build", tmp_path / "prefix"
    sh("cmake", "-S", package, "-B", build, f"-DCMAKE_CXX_FLAGS={STRICT}")
    sh("cmake", "--build", build)
    rows = sh(build / "example").splitlines()
    assert rows and all("off by" in row for row in rows)
    sh("cmake", "--install", build, "--prefix", prefix)
    user = tmp_path / "user"
    user.mkdir()
    (user / "CMakeLists.txt").write_text(USER.format(name="arm_ik"))
    (user / "user.cpp").write_text(PROGRAM.format(name="arm_ik"))
    sh("cmake", "-S", user, "-B", user / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    sh("cmake", "--build", user / "build")
    sh(user / "build/user")


def test_the_page_says_what_is_held(tmp_path: Path) -> None:
    for name, held in {"arm_angle": "arm_angle", "franka_fr3": "fr3_joint7"}.items():
        page = emit(held_module(name, tmp_path))[f"{name}_ik_cpp/README.md"]
        assert f"`Options::free`: `{held}`." in page
