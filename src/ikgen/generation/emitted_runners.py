"""Runners of emitted files for verification, made from what is known of their arm."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ikgen.generation.emitted_arm import EmittedArm
    from ikgen.verify.runners.cpp_header import CppHeader
    from ikgen.verify.runners.python_module import PythonModule
    from ikgen.verify.runners.runner import ArmConstants

__all__ = [
    "arm_constants",
    "cpp_package_runner",
    "cpp_runner",
    "moveit_runner",
    "nanobind_runner",
    "python_runner",
]


def arm_constants(arm: EmittedArm) -> ArmConstants:
    """What verification has to know of the arm where the emitted code does not tell it."""
    from ikgen.verify.runners.runner import ArmConstants

    dh = arm.dh
    return ArmConstants(
        tuple(j.name for j in dh.joints),
        np.array([j.limits.lower for j in dh.joints]),
        np.array([j.limits.upper for j in dh.joints]),
        dh.base_link,
        dh.tip_link,
        arm.max_solutions,
        arm.task,
        dh.held,
    )


def python_runner(arm: EmittedArm, folder: Path) -> PythonModule:
    """The emitted Python module, imported."""
    from ikgen.verify.runners.python_module import PythonModule

    return PythonModule(folder / f"{arm.name}_ik.py")


def cpp_runner(arm: EmittedArm, folder: Path) -> CppHeader:
    """The emitted header, compiled into a program that solves poses in bulk."""
    from ikgen.verify.runners.cpp_header import CppHeader

    return CppHeader(folder / f"{arm.name}_ik.hpp", arm_constants(arm))


def cpp_package_runner(arm: EmittedArm, folder: Path) -> CppHeader:
    """The header in the CMake package, as for `cpp_runner`."""
    from ikgen.emit.cpp.cpp_package import folder_name

    return cpp_runner(arm, folder / folder_name(arm.name) / "include")


def nanobind_runner(arm: EmittedArm, folder: Path) -> CppHeader:
    """The header in the package to compile, as for `cpp_runner`."""
    return cpp_runner(arm, folder / f"{arm.name}_ik_ext")


def moveit_runner(arm: EmittedArm, folder: Path) -> CppHeader:
    """The header in the ROS 2 package, as for `cpp_runner`."""
    from ikgen.emit.moveit import package_name

    package = package_name(arm.name)
    return cpp_runner(arm, folder / package / "include" / package)
