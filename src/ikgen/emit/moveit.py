"""Emitter of a ROS 2 package: a MoveIt kinematics plugin over the C++ header."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.cpp.cpp_language import comment, literal, number
from ikgen.emit.rendering import render
from ikgen.emit.solver_module import SolverModule
from ikgen.errors import UsageError
from ikgen.model.maintainer import name_and_email

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.model.chain import Chain

__all__ = ["emit", "emit_derivation", "package_name"]

_FILES = {
    "package.xml": "package.xml",
    "CMakeLists.txt": "CMakeLists.txt",
    "README.md": "README.md",
    "regenerate.sh": "regenerate.sh",
    "test/solver_test.cpp": "solver_test.cpp",
    "plugin.xml": "plugin.xml",
    "config/kinematics.yaml": "kinematics.yaml",
    "src/kinematics_plugin.cpp": "kinematics_plugin.cpp",
    "src/robot_model.cpp": "robot_model.cpp",
}
_HEADERS = (
    "candidates",
    "group_joints",
    "search",
    "messages",
    "moveit_headers",
    "robot_model",
    "kinematics_plugin",
)


def emit_derivation(derivation: Derivation) -> dict[str, str]:
    """Relative path -> text of the package's folder, `<name>_ik_moveit/`."""
    if derivation.reading.parts:
        raise UsageError(
            f"{derivation.module.dh.robot}: a joint follows several others, and the MoveIt plugin does not "
            "serve that",
            hint="use the Python or C++ output",
        )
    return emit(derivation.module, derivation.reading.chain)


def emit(module: SolverModule, chain: Chain | None = None) -> dict[str, str]:
    """Relative path -> text: a whole ament package, the solver's header included.

    MoveIt wants the values of joints that follow others as well, which are those of `chain` (None: there
    are none). Raises UsageError where a joint of the solver is not between base and tip, or where DH rows
    follow others: MoveIt has no model of them.
    """
    group = _group(module, chain)
    package = package_name(module.name)
    include = f"{package}/include/{package}"
    headers = (*_HEADERS, "free_joints") if module.held else _HEADERS
    paths = {f"{package}/{path}": file for path, file in _FILES.items()}
    paths |= {f"{include}/{header}.hpp": f"{header}.hpp" for header in headers}
    values = _values(module, package) | group
    out = {path: render("moveit", f"{file}.jinja", **values) for path, file in paths.items()}
    return out | {f"{include}/{module.name}_ik.hpp": emit_header(module.on_joints)}


def _group(module: SolverModule, chain: Chain | None) -> dict[str, object]:
    """The joints between base and tip by name, with what moves them, and where the solver's joints are."""
    names = [joint.name for joint in module.dh.joints]
    if chain is not None:
        group = [(a.name, a.driver, a.multiplier, a.offset) for a in chain.file_axes or chain.axes]
    elif len(module.dh.rows) == module.dh.dof:
        group = [(name, j, 1.0, 0.0) for j, name in enumerate(names)]
    else:
        raise UsageError(
            f"{module.dh.robot}: rows of a DH table follow others, and MoveIt has no model of these",
            hint="give the robot's URDF, or use the Python or C++ output",
        )
    between = [name for name, *_ in group]
    outside = [name for name in names if name not in between]
    if outside:
        raise UsageError(
            f"{module.dh.robot}: the joint '{outside[0]}' moves the chain from outside of it, and the "
            "MoveIt plugin does not serve that: a planning group has the joints between base and tip",
            hint="use the Python or C++ output",
        )
    return {"group": group, "places": [between.index(name) for name in names]}


def package_name(name: str) -> str:
    """Name of the ROS package of a solver: lower case, no two underscores in a row (REP 144)."""
    return re.sub("_+", "_", f"{name.lower()}_ik_moveit")


def _values(module: SolverModule, package: str) -> dict[str, object]:
    """What the templates name."""
    joints = range(module.dh.dof)
    periods = [0.0 if j in module.free_indices else module.period(j) for j in joints]
    who, email = name_and_email(module.maintainer or "user <user@todo.todo>")
    return {
        "m": module,
        "who": who,
        "email": email,
        "package": package,
        "namespace": f"{module.name}_ik",
        "joint_names": tuple(joint.name for joint in module.dh.joints),
        "free_names": module.held,
        "periods": [number(period) for period in periods],
        "version": _version(module.generator_version),
        "comment": comment,
        "number": number,
        "quoted": literal,
        "xml": escape,
    }


def _version(generator: str) -> str:
    """The generator's version where ROS packages can have it: three numbers."""
    plain = re.match(r"\d+\.\d+\.\d+", generator)
    return plain.group() if plain else "0.0.0"
