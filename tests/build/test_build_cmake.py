"""The CMake package, with the real CMake where there is one."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from ikgen import __version__
from ikgen.build.cmake import cmake_directory
from ikgen.emit.registry import EMITTERS
from ikgen.errors import MissingToolError
from ikgen.verify.runners.cpp_toolchain import find_eigen

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/cmake_only"
needs_cmake = pytest.mark.skipif(
    shutil.which("cmake") is None or shutil.which("g++") is None, reason="needs cmake and g++"
)


def test_the_package_files_agree_on_the_version() -> None:
    files = list(ROOT.glob("**/ikgenConfigVersion.cmake"))
    files = [path for path in files if ".venv" not in path.parts]
    assert len(files) == 3
    assert {re.search(r'"(.+)"', path.read_text()).group(1) for path in files} == {__version__}  # type: ignore[union-attr]


def call(*command: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run a command with the tools of this environment first on PATH."""
    tools = str(Path(sys.executable).parent)
    environment = {**os.environ, "PATH": tools + os.pathsep + os.environ["PATH"]}
    return subprocess.run(
        [str(word) for word in command], cwd=cwd, env=environment, text=True, capture_output=True
    )


def build(*command: object, cwd: Path) -> str:
    done = call(*command, cwd=cwd)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


@needs_cmake
@pytest.mark.skipif(
    "cpp" not in [emitter.name for emitter in EMITTERS], reason="needs the emitter of C++"
)
@pytest.mark.parametrize("generator", ["Ninja", "Unix Makefiles"])
def test_regenerates_when_an_included_file_changes(tmp_path: Path, generator: str) -> None:
    if generator == "Ninja" and shutil.which("ninja") is None:
        pytest.skip("needs ninja")
    shutil.copytree(EXAMPLE, tmp_path / "p")
    listing = tmp_path / "p/CMakeLists.txt"
    listing.write_text(listing.read_text().replace("VERIFY)", "SAMPLES 50 VERIFY)"))
    out = tmp_path / "p" / "b"
    build(
        "cmake", "-S", ".", "-B", out, "-G", generator, f"-Dikgen_DIR={cmake_directory()}",
        *_eigen(), cwd=tmp_path / "p",
    )  # fmt: skip
    made = "Generating inverse kinematics"
    assert made in build("cmake", "--build", out, cwd=tmp_path)
    assert made not in build("cmake", "--build", out, cwd=tmp_path)
    wrist = tmp_path / "p/urdf/wrist.xacro"
    wrist.write_text(wrist.read_text().replace("0.38", "0.39"))
    text = build("cmake", "--build", out, cwd=tmp_path)
    assert made in text and "reach" in text
    assert made not in build("cmake", "--build", out, cwd=tmp_path)
    if generator == "Ninja":
        build("ctest", "--output-on-failure", cwd=out)


def _eigen() -> list[str]:
    """Where CMake finds Eigen if the system has none of its own."""
    config = [*Path("/usr/share").glob("eigen3/cmake/Eigen3Config.cmake")]
    if config:
        return []
    try:
        return [f"-DCMAKE_PREFIX_PATH={find_eigen().parent.parent}"]
    except MissingToolError:
        pytest.skip("needs Eigen")


@needs_cmake
@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("ikgen_generate(arm)", "ROBOT <urdf-or-xacro> is missing"),
        ("ikgen_generate(arm ROBOT nothing.urdf)", "no such file"),
        ("ikgen_generate(arm ROBOT CMakeLists.txt COLOUR red)", "COLOUR"),
    ],
)
def test_wrong_calls(tmp_path: Path, line: str, said: str) -> None:
    text = "cmake_minimum_required(VERSION 3.16)\nproject(p NONE)\nfind_package(ikgen REQUIRED)\n"
    (tmp_path / "CMakeLists.txt").write_text(text + line + "\n")
    directory = f"-Dikgen_DIR={cmake_directory()}"
    done = call("cmake", "-S", ".", "-B", "b", directory, cwd=tmp_path)
    assert done.returncode != 0 and said in done.stderr
