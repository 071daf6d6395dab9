"""Runners of emitted files for verification, made from the solver module they came from."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ikgen.emit.solver_module import SolverModule
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


def arm_constants(module: SolverModule) -> ArmConstants:
    """What verification has to know of the arm where the emitted code does not tell it."""
    from ikgen.verify.runners.runner import ArmConstants

    dh = module.dh
    return ArmConstants(
        tuple(j.name for j in dh.joints),
        np.array([j.limits.lower for j in dh.joints]),
        np.array([j.limits.upper for j in dh.joints]),
        dh.base_link,
        dh.tip_link,
        module.max_solutions,
        module.task,
        tuple(dh.joints[j].name for j in module.free),
    )


def python_runner(module: SolverModule, folder: Path) -> PythonModule:
    """The emitted Python module, imported."""
    from ikgen.verify.runners.python_module import PythonModule

    return PythonModule(folder / f"{module.name}_ik.py")


def cpp_runner(module: SolverModule, folder: Path) -> CppHeader:
    """The emitted header, compiled into a program that solves poses in bulk."""
    from ikgen.verify.runners.cpp_header import CppHeader

    return CppHeader(folder / f"{module.name}_ik.hpp", arm_constants(module))


def cpp_package_runner(module: SolverModule, folder: Path) -> CppHeader:
    """The header in the CMake package, as for `cpp_runner`."""
    from ikgen.emit.cpp.cpp_package import folder_name

    return cpp_runner(module, folder / folder_name(module.name) / "include")


def nanobind_runner(module: SolverModule, folder: Path) -> CppHeader:
    """The header in the package to compile, as for `cpp_runner`."""
    return cpp_runner(module, folder / f"{module.name}_ik_ext")


def moveit_runner(module: SolverModule, folder: Path) -> CppHeader:
    """The header in the ROS 2 package, as for `cpp_runner`."""
    from ikgen.emit.moveit import package_name

    package = package_name(module.name)
    return cpp_runner(module, folder / package / "include" / package)
