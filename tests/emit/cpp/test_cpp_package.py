"""The C++ package stands alone: it builds its example, installs, and is found by another project."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.support.held_arms import held_module
from tests.support.precompiled import OPTIONS
from tests.support.sampled import sampled
from tests.support.solving import NO_COMPILER
from tests.support.tools import needs_cmake, printed

from ikgen.emit.cpp.cpp_package import emit
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request
from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

pytestmark = pytest.mark.usefixtures("solved_once")

FIXTURES = Path(__file__).resolve().parents[3] / "urdf_fixtures"
STRICT = "-Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Werror"
DEBUG = (
    "-DCMAKE_BUILD_TYPE=Debug",
    f"-DCMAKE_CXX_FLAGS_DEBUG={OPTIONS}",
)  # compiles in half the time
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


HELD: dict[str, dict[str, float]] = {"kuka_kr6r900sixx": {}, "franka_fr3": {"fr3_joint7": 0.3}}


@needs_cmake
@pytest.mark.parametrize("robot", sampled(HELD, ["kuka_kr6r900sixx"]))
def test_package_builds_installs_and_is_found(robot: str, tmp_path: Path) -> None:
    request = Request(FIXTURES / f"{robot}.urdf", free=HELD[robot], name="arm")
    made = generate(request, Outputs(emit=("cpp-package",), out=tmp_path, samples=60))
    assert made.reports["cpp-package"].passed
    package, build, prefix = tmp_path / "arm_ik_cpp", tmp_path / "build", tmp_path / "prefix"
    printed("cmake", "-S", package, "-B", build, f"-DCMAKE_CXX_FLAGS={STRICT}", *DEBUG)
    printed("cmake", "--build", build)
    rows = printed(build / "example").splitlines()
    assert rows and all("off by" in row for row in rows)
    printed("cmake", "--install", build, "--prefix", prefix)
    user = tmp_path / "user"
    user.mkdir()
    (user / "CMakeLists.txt").write_text(USER.format(name="arm_ik"))
    (user / "user.cpp").write_text(PROGRAM.format(name="arm_ik"))
    printed("cmake", "-S", user, "-B", user / "build", f"-DCMAKE_PREFIX_PATH={prefix}", *DEBUG)
    printed("cmake", "--build", user / "build")
    printed(user / "build/user")


def test_the_page_says_what_is_held(tmp_path: Path) -> None:
    for name, held in {"arm_angle": "arm_angle", "franka_fr3": "fr3_joint7"}.items():
        page = emit(held_module(name, tmp_path))[f"{name}_ik_cpp/README.md"]
        assert f"`Options::free`: `{held}`." in page


@pytest.mark.long
@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
def test_release_builds_of_later_standards_have_no_warnings(tmp_path: Path) -> None:
    """At -O3 compilers look for values that were never set, and C++20 deprecates much that C++17 takes."""
    request = Request(FIXTURES / "doosan_m1013.urdf", name="arm")
    made = generate(request, Outputs(emit=("cpp",), out=tmp_path, verify=False))
    assert made.derivation.module.rounded
    (tmp_path / "user.cpp").write_text(PROGRAM.format(name="arm_ik"))
    printed(
        *find_compiler(), "-std=c++20", "-O3", *STRICT.split(), "-isystem", find_eigen(),
        "-c", tmp_path / "user.cpp", "-I", tmp_path, "-o", tmp_path / "user.o",
    )  # fmt: skip
