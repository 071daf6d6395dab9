"""Emitter of the C++ header as a CMake package of its own, with an example program."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.cpp.cpp_language import comment
from ikgen.emit.rendering import render
from ikgen.emit.solver_module import SolverModule

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["emit", "emit_derivation", "folder_name"]

_FILES = ("CMakeLists.txt", "example.cpp", "README.md")


def folder_name(name: str) -> str:
    """The folder of an arm's package."""
    return f"{name}_ik_cpp"


def emit_derivation(derivation: Derivation) -> dict[str, str]:
    """Relative path -> text of the package's folder, `<name>_ik_cpp/`."""
    return emit(derivation.module)


def emit(module: SolverModule) -> dict[str, str]:
    """Relative path -> text: header, INTERFACE target, install rules, package config, example."""
    folder, name = folder_name(module.name), f"{module.name}_ik"
    paths = {f"{folder}/{file}": file for file in _FILES}
    paths[f"{folder}/cmake/{name}Config.cmake.in"] = "config.cmake.in"
    values = {"m": module, "name": name, "comment": comment}
    out = {path: render("cpp", f"package/{file}.jinja", **values) for path, file in paths.items()}
    return out | {f"{folder}/include/{name}.hpp": emit_header(module)}
