"""Solver modules around a Program, with facts that no test reads but those given."""

from __future__ import annotations

from typing import Any

from ikgen.emit.solver_module import SolverModule
from ikgen.model.dh import DHChain
from ikgen.program.statements import Program

__all__ = ["module_around"]


def module_around(
    program: Program, dh: DHChain, *, name: str = "arm", **given: Any
) -> SolverModule:
    """The module of a Program, what is held at 0 by default; `given` are fields of `SolverModule`."""
    facts: dict[str, Any] = {
        "task": "pose",
        "free_defaults": (0.0,) * len(dh.held),
        "source_name": f"{name}.urdf",
        "source_sha256": "0" * 64,
        "generator_version": "0",
    }
    return SolverModule(name=name, program=program, dh=dh, **(facts | given))
