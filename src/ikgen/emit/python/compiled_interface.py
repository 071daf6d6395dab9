"""The Python part of a compiled package: the Python module's functions, which call the compiled ones."""

from __future__ import annotations

from ikgen.emit.python.branch_kinds import branch_kind
from ikgen.emit.python.bundle import bundle
from ikgen.emit.python.python_emitter import concrete_types, known_facts, shell_values
from ikgen.emit.python.settled_branches import SOME
from ikgen.emit.rendering import render
from ikgen.emit.solver_module import SolverModule

__all__ = ["emit_interface"]


def emit_interface(module: SolverModule) -> str:
    """The text of the package's `__init__.py`, beside which `_native` is compiled. Where rows are told
    apart by the closed form's branches, that is in it in arrays."""
    numbered = branch_kind(module) == "number"
    named = any(not isinstance(x, float) for F in module.program.frames for row in F for x in row)
    known = {"compiled": True, "numbered": numbered, "lengths": numbered or named}
    shell = render("python", "compiled.py.jinja", **known, **shell_values(module))
    facts = (*known_facts(module), ("branches_batch", SOME if numbered else None))
    types = {**concrete_types(module), ("arm.solved_arm", "Arm"): ("arm.told_arm", "Arm")}
    return bundle(shell, facts, types)
