"""Emitters by name: one row each; other packages add theirs by the entry-point group `ikgen.emitters`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ikgen.errors import UnknownNameError

if TYPE_CHECKING:
    from ikgen.emit.module import SolverModule

__all__ = ["EMITTERS", "Emitter", "find_emitter"]


@dataclass(frozen=True, slots=True)
class Emitter:
    """An output by name. `target` is "module:function", which takes the derivation and gives file
    name -> text; `runner_target` "module:function" takes the solver module and the folder of the
    finished files and gives a verification runner (none: the output is not run)."""

    name: str
    words: str
    target: str
    runner_target: str | None = None

    def emit(self, derivation: Any) -> dict[str, str]:
        """File name (relative) -> text."""
        texts: dict[str, str] = _load(self.target)(derivation)
        return texts

    def runner(self, module: SolverModule, folder: Path) -> Any | None:
        """What verification calls, or None."""
        return None if self.runner_target is None else _load(self.runner_target)(module, folder)


def _load(target: str) -> Callable[..., Any]:
    module, function = target.split(":")
    loaded: Callable[..., Any] = getattr(import_module(module), function)
    return loaded


EMITTERS: tuple[Emitter, ...] = (
    Emitter(
        "python",
        "a self-contained Python module, NumPy only",
        "ikgen.emit.python:emit_derivation",
        "ikgen.generate_runners:python_runner",
    ),
    Emitter(
        "cpp",
        "a C++17 header, Eigen only, with a CMake package around it",
        "ikgen.emit.cpp:emit_derivation",
        "ikgen.generate_runners:cpp_runner",
    ),
    Emitter(
        "nanobind",
        "the C++ header as a Python package to compile, with the Python module's interface",
        "ikgen.emit.nanobind:emit_derivation",
        "ikgen.generate_runners:nanobind_runner",
    ),
    Emitter(
        "moveit",
        "a ROS 2 package with a MoveIt kinematics plugin over the C++ header",
        "ikgen.emit.moveit:emit_derivation",
        "ikgen.generate_runners:moveit_runner",
    ),
    Emitter(
        "report",
        "how it was derived, as LaTeX and HTML, with the solution graph",
        "ikgen.emit.report:emit_derivation",
    ),
)


def find_emitter(name: str) -> Emitter:
    """The emitter of a name, ikgen's own or another package's."""
    for emitter in EMITTERS:
        if emitter.name == name:
            return emitter
    others = {entry.name: entry for entry in entry_points(group="ikgen.emitters")}
    if name in others:
        found = others[name].load()
        return found if isinstance(found, Emitter) else found()
    raise UnknownNameError("emitter", name, [*(e.name for e in EMITTERS), *others])
