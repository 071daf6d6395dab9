"""`ikgen_generate(... COUPLE ...)`: the relations reach the command."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
from tests.support.telescopes import telescope_robot
from tests.support.tools import environment, needs_cmake

from ikgen.projects.cmake import cmake_directory
from ikgen.verify.runners.python_module import PythonModule

_PROJECT = """
cmake_minimum_required(VERSION 3.16)
project(coupled NONE)
find_package(ikgen REQUIRED)
ikgen_generate(arm ROBOT telescope.urdf TASK position EMIT python SAMPLES 20
  COUPLE stage_2=stage_1*1+0.01 stage_3=stage_1*1+0.02 stage_4=stage_1*0.5+0.03)
add_custom_target(all_arms ALL)
add_dependencies(all_arms arm_generate)
"""


@needs_cmake
def test_relations_reach_the_solver(tmp_path: Path) -> None:
    telescope_robot(tmp_path)
    (tmp_path / "CMakeLists.txt").write_text(_PROJECT)
    for command in (
        ["cmake", "-S", ".", "-B", "b", f"-Dikgen_DIR={cmake_directory()}"],
        ["cmake", "--build", "b"],
    ):
        done = subprocess.run(
            command, cwd=tmp_path, env=environment(), text=True, capture_output=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
    (made,) = tmp_path.glob("b/**/arm_ik.py")
    arm = PythonModule(made).module
    assert arm.JOINT_NAMES == ("lift", "stage_1", "yaw", "pitch")
    moved = arm.forward([0.0, 0.1, 0.0, 0.0])[:3, 3] - arm.forward(np.zeros(4))[:3, 3]
    assert abs(np.linalg.norm(moved) - 0.35) < 1e-12  # 1 + 1 + 1 + 0.5 of 0.1 m
