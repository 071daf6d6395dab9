"""Helpers of tests that need an emitted module in memory."""

from __future__ import annotations

import importlib.util
import itertools
import sys
from pathlib import Path
from types import ModuleType

from tests.support.module_facts import module_around

from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.errors import MissingToolError
from ikgen.lowering.lower import lower
from ikgen.model.dh import DHChain
from ikgen.solver import solve
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

try:
    find_compiler(), find_eigen()
    NO_COMPILER = ""
except MissingToolError as error:
    NO_COMPILER = error.message
"""What is missing to compile the C++ header; empty where nothing is."""

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"
_count = itertools.count()


def solver_module(dh: DHChain, *, name: str = "arm") -> SolverModule:
    """A solver module of a chain, free joints at 0."""
    return module_of(dh, solve.solve_chain(dh), name=name)


def module_of(dh: DHChain, graph: SolutionGraph, *, name: str = "arm") -> SolverModule:
    """The solver module of a solution graph, free joints at 0."""
    assert not graph.open_joints
    program = lower(graph, model_error=2.0 * max(dh.deviation))
    return module_around(program, dh, name=name)


def import_text(text: str, folder: Path) -> ModuleType:
    """A module from its text."""
    path = folder / f"emitted_{next(_count)}_ik.py"
    path.write_text(text)
    return module_from(path)


def module_from(path: Path) -> ModuleType:
    """The module of a file, which no import finds."""
    name = path.stem
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def emitted(dh: DHChain, folder: Path) -> ModuleType:
    """The emitted Python module of a chain, imported."""
    return import_text(emit_module(solver_module(dh)), folder)
