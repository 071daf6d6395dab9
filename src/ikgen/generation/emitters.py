"""Emitters by name: one row each; other packages add theirs by the entry-point group `ikgen.emitters`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.errors import UnknownNameError, UsageError
from ikgen.plugins import PlugIn, blaming, find_plug_in, named_object, plug_ins

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.generation.emitted_arm import EmittedArm
    from ikgen.verify.runners.runner import Runner
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["EMITTERS", "Emitter", "find_emitter", "solver_files"]

GROUP = "ikgen.emitters"


@dataclass(frozen=True, slots=True)
class Emitter:
    """An output by name. `target` is "module:function", which takes the derivation (and, where it
    `tells_verification`, the reports of the other outputs by name) and gives file name -> text;
    `runner_target` "module:function" takes the `EmittedArm` and the folder of the finished files
    and gives a verification runner (none: the output is not run), which of one that is `compiled`
    starts a compiler: such an output comes first, others meanwhile. `main_file` is the file that has the
    solver, `{name}` the arm's and `*` any part of a name; `with_report` offers it to `ikgen report`.
    `plug_in` is set for an emitter of another package, which its failures then name; `beyond` says which of
    `SolverModule.beyond` that one writes: arms that need others are refused."""

    name: str
    words: str
    target: str
    runner_target: str | None = None
    tells_verification: bool = False
    plug_in: PlugIn | None = None
    compiled: bool = False
    beyond: tuple[str, ...] = ()
    main_file: str = ""
    with_report: bool = False

    def emit(
        self, derivation: Derivation, reports: Mapping[str, VerificationReport] | None = None
    ) -> dict[str, str]:
        """File name (relative) -> text. Raises `UsageError` for an arm that needs more than another
        package's emitter says that it writes."""
        needed = derivation.module.beyond.items()
        left = [words for name, words in needed if name not in self.beyond]
        if self.plug_in is not None and left:
            raise UsageError(
                f"the {self.plug_in.words} does not write {' and '.join(left)}, which this arm needs",
                hint="emit python or cpp, or ask its package for it",
            )
        more = (reports or {},) if self.tells_verification else ()
        with blaming(self.plug_in):
            texts: dict[str, str] = named_object(self.target)(derivation, *more)
        return texts

    def runner(self, arm: EmittedArm, folder: Path) -> Runner | None:
        """What verification calls, or None."""
        if self.runner_target is None:
            return None
        with blaming(self.plug_in):
            runner: Runner = named_object(self.runner_target)(arm, folder)
        return runner

    def main_among(self, files: Iterable[str], name: str) -> str | None:
        """The file (relative) of the arm `name` that has its solver; None where none of these is."""
        wanted = self.main_file.format(name=name).split("/")
        for file in files:
            parts = file.split("/")
            if len(parts) == len(wanted) and all(map(fnmatchcase, parts, wanted)):
                return file
        return None


EMITTERS: tuple[Emitter, ...] = (
    Emitter(
        "python",
        "a self-contained Python module, NumPy only",
        "ikgen.emit.python.python_emitter:emit_derivation",
        "ikgen.generation.emitted_runners:python_runner",
        main_file="{name}_ik.py",
    ),
    Emitter(
        "cpp",
        "a C++17 header, Eigen only",
        "ikgen.emit.cpp.cpp_emitter:emit_derivation",
        "ikgen.generation.emitted_runners:cpp_runner",
        compiled=True,
        main_file="{name}_ik.hpp",
    ),
    Emitter(
        "cpp-package",
        "the C++ header as a CMake package of its own, with an example program",
        "ikgen.emit.cpp.cpp_package:emit_derivation",
        "ikgen.generation.emitted_runners:cpp_package_runner",
        compiled=True,
        main_file="*/include/{name}_ik.hpp",
    ),
    Emitter(
        "nanobind",
        "the C++ header as a Python package to compile, with the Python module's interface",
        "ikgen.emit.nanobind:emit_derivation",
        "ikgen.generation.emitted_runners:nanobind_runner",
        compiled=True,
        main_file="*/{name}_ik.hpp",
    ),
    Emitter(
        "moveit",
        "a ROS 2 package with a MoveIt kinematics plugin over the C++ header",
        "ikgen.emit.moveit:emit_derivation",
        "ikgen.generation.emitted_runners:moveit_runner",
        compiled=True,
        main_file="*/include/*/{name}_ik.hpp",
    ),
    Emitter(
        "report",
        "how it was derived, as LaTeX and HTML, with the solution graph (PDF: ikgen report)",
        "ikgen.report:emit_report",
        tells_verification=True,
    ),
    Emitter(
        "sympy",
        "its solutions and equations as a Python module of SymPy expressions",
        "ikgen.symbolic.sympy_module:emit_derivation",
        main_file="{name}_sympy.py",
        with_report=True,
    ),
)


def solver_files(name: str) -> tuple[str, ...]:
    """The files of the arm `name` that are a solver by themselves, beside its record."""
    mains = (row.main_file for row in EMITTERS if row.runner_target is not None)
    return tuple(main.format(name=name) for main in mains if "/" not in main)


def find_emitter(name: str) -> Emitter:
    """The emitter of a name, ikgen's own or another package's."""
    for emitter in EMITTERS:
        if emitter.name == name:
            return emitter
    plug_in = find_plug_in(GROUP, name)
    if plug_in is not None:
        return replace(plug_in.load(Emitter), plug_in=plug_in)
    raise UnknownNameError("emitter", name, emitter_names())


def emitter_names() -> list[str]:
    """Names of ikgen's own emitters and those of other packages."""
    return [*(emitter.name for emitter in EMITTERS), *(one.name for one in plug_ins(GROUP))]
