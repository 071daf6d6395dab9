"""Emitter of a compiled Python package: the C++ header behind the interface of the Python module."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.emit.blanks import blanks
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.compiled_interface import emit_interface
from ikgen.emit.rendering import render
from ikgen.emit.solver_module import SolverModule

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["SOURCES", "emit", "emit_derivation", "package_folder"]

_FILES = ("pyproject.toml", "CMakeLists.txt", "README.md", "native.cpp")
_PACKAGE = ("_native.pyi", "py.typed")
SOURCES = Path(__file__).resolve().parents[1] / "runtime" / "nanobind"
"""What is the same for all arms."""


def package_folder(name: str) -> str:
    """The package of an arm, and its folder."""
    return f"{name}_ik_ext"


def emit_derivation(derivation: Derivation) -> dict[str, str]:
    """Relative path -> text of the package's folder, `<name>_ik_ext/`."""
    return emit(derivation.module)


def emit(module: SolverModule) -> dict[str, str]:
    """Relative path -> text: what `pip install ./<name>_ik_ext` needs, the header included."""
    package = package_folder(module.name)
    paths = {f"{package}/{file}": file for file in _FILES}
    paths |= {f"{package}/{package}/{file}": file for file in _PACKAGE}
    values = {
        "m": module,
        "package": package,
        "namespace": f"{module.name}_ik",
        "blanks": blanks(module),
        "elbow": module.dh.arm_angle,
        "version": _version(module.generator_version),
    }
    out = {path: render("nanobind", f"{file}.jinja", **values) for path, file in paths.items()}
    out[f"{package}/{package}/__init__.py"] = emit_interface(module)
    for path in sorted(SOURCES.glob("*.hpp")):
        out[f"{package}/{path.name}"] = path.read_text(encoding="utf-8")
    return out | {f"{package}/{module.name}_ik.hpp": emit_header(module)}


def _version(generator: str) -> str:
    """The generator's version where packages can have it (PEP 440)."""
    plain = re.fullmatch(r"\d+(\.\d+)*((a|b|rc|\.post|\.dev)\d+)*", generator)
    return generator if plain else "0"
