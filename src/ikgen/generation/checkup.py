"""What `ikgen doctor` looks for: packages, tools and the parts of other packages."""

from __future__ import annotations

import shlex
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from ikgen.errors import IkgenError, MissingToolError
from ikgen.importers.packages import AMENT, sourced
from ikgen.plugins import GROUPS, PlugIn, plug_ins

__all__ = ["Offer", "Thing", "offers", "packages", "tools"]

_PACKAGES = {
    "numpy": "arrays",
    "jinja2": "templates of the outputs",
    "click": "command line",
    "py_trees": "behavior tree",
    "lxml": "reads XML, with line numbers",
    "xacro": "expands xacro files",
    "pin": "Pinocchio: verifies",
}


_EXTRAS = {
    "sympy": ("symbolic solutions and exact proofs (verify --prove, report)", "symbolic"),
    "rich": ("a status line on terminals", "terminal"),
    "nanobind": ("ikgen.compile", "compile"),
    "example-robot-data": ("robots by name", "robots"),
    "viser": ("ikgen view", "view"),
    "distributed": ("arms, poses and maps on a dask cluster (build, verify, reach)", "dask"),
    "zarr": ("reachability maps as .zarr, from Python 3.11 on", "zarr"),
}
"""Packages that ikgen does without: what they are for, and the extra that brings them."""


@dataclass(frozen=True, slots=True)
class Thing:
    """A package or tool: its version or path (None: missing), what it is for, how to get it."""

    name: str
    found: str | None
    purpose: str
    remedy: str


@dataclass(frozen=True, slots=True)
class Offer:
    """A part of another package; `problem` says why it cannot be used ("": it can)."""

    plug_in: PlugIn
    problem: str


def packages() -> list[Thing]:
    """The Python packages that ikgen needs."""
    return [
        Thing(name, _version(name), purpose, f"pip install {name}")
        for name, purpose in _PACKAGES.items()
    ]


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def tools() -> list[Thing]:
    """Programs, headers and packages that some outputs and commands use."""
    from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

    return [
        *(
            Thing(name, _version(name), purpose, f"pip install 'ikgen[{extra}]'")
            for name, (purpose, extra) in _EXTRAS.items()
        ),
        _sought("C++ compiler", lambda: shlex.join(find_compiler()), "verifies the C++ header"),
        _sought("Eigen", lambda: str(find_eigen()), "the C++ header includes it"),
        _program("cmake", "ikgen_generate()", "apt-get install cmake, or pip install cmake"),
        _program("pdflatex", "the report as PDF", "apt-get install texlive-latex-base"),
        Thing(
            "ament_cmake",
            _ament(),
            "ROS 2 packages",
            "source /opt/ros/DISTRO/setup.sh, or apt-get install ament-cmake",
        ),
    ]


def _sought(name: str, find: Callable[[], str], purpose: str) -> Thing:
    """What verification would find, with its own words where it finds nothing."""
    try:
        return Thing(name, find(), purpose, "")
    except MissingToolError as error:
        return Thing(name, None, purpose, f"{error.message}: {error.hint}")


def _program(name: str, purpose: str, remedy: str) -> Thing:
    return Thing(name, shutil.which(name), purpose, remedy)


def _ament() -> str | None:
    """Where CMake's `find_package(ament_cmake)` would find it: the sourced prefixes, then /usr."""
    places = [prefix / "share/ament_cmake/cmake" for prefix in (*sourced(AMENT), Path("/usr"))]
    found = next((p for p in places if (p / "ament_cmakeConfig.cmake").is_file()), None)
    return None if found is None else str(found)


def offers() -> list[Offer]:
    """The parts of other packages, each loaded once to see that it works."""
    return [Offer(one, _problem(one)) for group in GROUPS for one in plug_ins(group)]


def _problem(plug_in: PlugIn) -> str:
    kind, own = _registry(plug_in.group)
    if plug_in.name in own:
        return "not used: ikgen has one of that name"
    try:
        plug_in.load(kind)
    except IkgenError as error:
        return error.message.removeprefix(plug_in.words).strip()
    if sum(other.name == plug_in.name for other in plug_ins(plug_in.group)) > 1:
        return "offered by several packages: keep one of them"
    return ""


def _registry(group: str) -> tuple[type, set[str]]:
    """What an entry of a group must be, and the names by which ikgen finds its own; imported as asked for,
    as packages that they need may be what is missing."""
    match group:
        case "ikgen.importers":
            from ikgen.importers import Importer

            return Importer, set()
        case "ikgen.emitters":
            from ikgen.generation.emitters import EMITTERS, Emitter

            return Emitter, {one.name for one in EMITTERS}
        case "ikgen.leaves":
            from ikgen.solver.leaves import Leaf

            return Leaf, set()
        case "ikgen.tasks":
            from ikgen.tasks import TASKS, Task

            return Task, {one.name for one in TASKS}
    from ikgen.solver.behavior_tree import Tree

    return Tree, set()
