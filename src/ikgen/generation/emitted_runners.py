"""Runners of emitted files for verification, made from what is known of their arm."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np

if TYPE_CHECKING:
    from ikgen.generation.emitted_arm import EmittedArm
    from ikgen.verify.runners.cpp_header import CppHeader
    from ikgen.verify.runners.joint_runner import JointRunner
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


def python_runner(arm: EmittedArm, folder: Path) -> PythonModule | JointRunner:
    """The emitted Python module, imported."""
    from ikgen.verify.runners.python_module import PythonModule

    return _with_joints(PythonModule(folder / f"{arm.name}_ik.py"), arm)


def cpp_runner(arm: EmittedArm, folder: Path) -> CppHeader | JointRunner:
    """The emitted header, compiled into a program that solves poses in bulk."""
    return _with_joints(_header(arm, folder), arm)


def _header(arm: EmittedArm, folder: Path) -> CppHeader:
    from ikgen.verify.runners.cpp_header import CppHeader

    return CppHeader(folder / f"{arm.name}_ik.hpp", arm_constants(arm))


_R = TypeVar("_R", "PythonModule", "CppHeader")


def _with_joints(runner: _R, arm: EmittedArm) -> _R | JointRunner:
    """With values of joints, where the code's are those of motors."""
    if arm.dh.transmission is None:
        return runner
    from ikgen.verify.runners.joint_runner import JointRunner

    return JointRunner(runner, arm.dh.transmission)


def cpp_package_runner(arm: EmittedArm, folder: Path) -> CppHeader | JointRunner:
    """The header in the CMake package, as for `cpp_runner`."""
    from ikgen.emit.cpp.cpp_package import folder_name

    return cpp_runner(arm, folder / folder_name(arm.name) / "include")


def nanobind_runner(arm: EmittedArm, folder: Path) -> CppHeader | JointRunner:
    """The header in the package to compile, as for `cpp_runner`."""
    from ikgen.emit.nanobind import package_folder

    return cpp_runner(arm, folder / package_folder(arm.name))


def moveit_runner(arm: EmittedArm, folder: Path) -> CppHeader:
    """The header in the ROS 2 package, as for `cpp_runner`, with values of joints."""
    from ikgen.emit.moveit import package_name

    package = package_name(arm.name)
    return _header(arm, folder / package / "include" / package)
