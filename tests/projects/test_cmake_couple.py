"""`ikgen_generate(... COUPLE ...)`: the relations reach the command."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from tests.support.telescopes import RELATIONS, telescope_robot
from tests.support.tools import needs_cmake, printed

from ikgen.projects.cmake import cmake_directory
from ikgen.verify.runners.python_module import PythonModule

_PROJECT = """
cmake_minimum_required(VERSION 3.16)
project(coupled NONE)
find_package(ikgen REQUIRED)
ikgen_generate(arm ROBOT telescope.urdf TASK position EMIT python SAMPLES 20
  COUPLE RELATIONS)
add_custom_target(all_arms ALL)
add_dependencies(all_arms arm_generate)
"""


@needs_cmake
def test_relations_reach_the_solver(tmp_path: Path) -> None:
    telescope_robot(tmp_path)
    relations = " ".join(f"{joint}={text}" for joint, text in RELATIONS.items())
    (tmp_path / "CMakeLists.txt").write_text(_PROJECT.replace("RELATIONS", relations))
    printed("cmake", "-S", ".", "-B", "b", f"-Dikgen_DIR={cmake_directory()}", cwd=tmp_path)
    printed("cmake", "--build", "b", cwd=tmp_path)
    (made,) = tmp_path.glob("b/**/arm_ik.py")
    arm = PythonModule(made).module
    assert arm.JOINT_NAMES == ("lift", "stage_1", "yaw", "pitch")
    moved = arm.forward([0.0, 0.1, 0.0, 0.0])[:3, 3] - arm.forward(np.zeros(4))[:3, 3]
    assert abs(np.linalg.norm(moved) - 0.35) < 1e-12  # 1 + 1 + 1 + 0.5 of 0.1 m
