"""The C++ program that solves a block of a map through an emitted header."""

from __future__ import annotations

from ikgen.emit.cpp.cpp_twist_chain import twist_lines
from ikgen.emit.cpp.header_bundle import bundle
from ikgen.emit.rendering import render
from ikgen.emit.solver_module import SolverModule

__all__ = ["map_driver"]


def map_driver(
    module: SolverModule, *, rows: tuple[int, int], moving: tuple[int, ...], size: float
) -> str:
    """Text of the program for the module's header: `rows` are the first row of the Jacobian and how many,
    `moving` its columns, `size` (m) what lengths are relative to."""
    return render(
        "reach",
        "map.cpp.jinja",
        header=f"{module.name}_ik.hpp",
        namespace=f"{module.name}_ik",
        runtime=bundle(["reach/solved_block.hpp"]),
        chain=twist_lines(module),
        rows=rows,
        moving=moving,
        size=repr(float(size)),
    )
