"""The program that solves blocks of a map, compiled from the emitted header for speed."""

from __future__ import annotations

from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.solver_module import SolverModule
from ikgen.processes.scratch_folder import ScratchFolder
from ikgen.reach.engine import Compiled
from ikgen.reach.map_driver import map_driver
from ikgen.verify.runners.cpp_toolchain import compile_program

__all__ = ["compiled_engine"]

_FAST = ("-O2", "-fpeel-loops", "-ffp-contract=off")
"""Peeled, small loops of a known length go, as by -O3, which takes twice as long to compile."""


def compiled_engine(
    module: SolverModule,
    rows: tuple[int, int],
    moving: tuple[int, ...],
    size: float,
    *,
    portable: bool,
) -> Compiled:
    """`portable`: for any processor of this kind, not this one alone. Raises `MissingToolError` without a
    compiler or Eigen."""
    name = f"{module.name}_ik"
    with ScratchFolder("ikgen-") as folder:
        (folder / f"{name}.hpp").write_text(emit_header(module), encoding="utf-8")
        source, program = folder / "map.cpp", folder / "map"
        text = map_driver(module, rows=rows, moving=moving, size=size)
        source.write_text(text, encoding="utf-8")
        flags = _FAST if portable else (*_FAST, "-march=native")
        compile_program(source, program, [folder], flags)
        return Compiled(program.read_bytes())
