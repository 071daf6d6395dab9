"""Every warning that clang has, but a few named kinds: the emitted header gives none."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from tests.support.cpp_modules import robot_file
from tests.support.held_arms import held_module
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.records.request import Request
from ikgen.verify.runners.cpp_toolchain import find_eigen

pytestmark = pytest.mark.usefixtures("solved_once")

CLANG = shutil.which("clang++")
ARMS = ("ur5e", "doosan_m1013", "KawasakiRS05L")
"""Solved by rules, by rules and refinement, by an elimination."""
HELD = ("franka_fr3", "torso", "arm_angle")
"""One joint held, two, and the arm angle."""

ALLOWED = (
    "c++98-compat", "c++98-compat-pedantic",  # it is C++17
    "float-equal",  # what was put on a limit, or taken before, has its bits
    "padded",  # members stand in the order of their sense
    "unsafe-buffer-usage",  # arrays and pointers, in place of containers that allocate
    "switch-default",  # contradicts covered-switch-default
)  # fmt: skip
"""Kinds of warnings that are left on purpose."""


@pytest.mark.skipif(CLANG is None or bool(NO_COMPILER), reason=NO_COMPILER or "needs clang++")
@pytest.mark.parametrize("name", (*ARMS, *HELD))
def test_no_warning(name: str, tmp_path: Path) -> None:
    held = name in HELD
    module = held_module(name, tmp_path) if held else derive(Request(robot_file(name))).module
    (tmp_path / "arm_ik.hpp").write_text(emit_header(module), encoding="utf-8")
    call = f"{module.name}_ik::solve(Eigen::Isometry3d::Identity()).count"
    text = f'#include "arm_ik.hpp"\nint main() {{ return {call}; }}\n'
    (tmp_path / "main.cpp").write_text(text, encoding="utf-8")
    allowed = [f"-Wno-{kind}" for kind in (*ALLOWED, "unknown-warning-option")]
    command = [
        str(CLANG), "-std=c++17", "-Weverything", "-Werror", *allowed, "-isystem", str(find_eigen()),
        "-fsyntax-only", "main.cpp",
    ]  # fmt: skip
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[:3000]
