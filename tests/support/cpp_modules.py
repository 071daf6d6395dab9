"""Solver modules to emit: robots of the IKBT suite and real arms, of the files in this repository."""

from __future__ import annotations

from pathlib import Path

from tests.support.module_facts import module_around

from ikgen.derivation.read import read
from ikgen.emit.solver_module import SolverModule
from ikgen.lowering.lower import lower
from ikgen.records.request import Request
from ikgen.solver import solve

__all__ = ["EXACT", "ROBOTS", "robot_file", "solver_module"]

TESTS = Path(__file__).resolve().parents[1]
FIXTURES = TESTS.parent / "urdf_fixtures"

EXACT = [
    "Puma",
    "UR5",
    "Olson13",
    "Raven-II",
    "Stanford",
    "kuka_kr6r900sixx",
    "scara_standard",
    "ur5e",
]
"""Robots whose Program is of their file's own geometry, but for rounding."""

ROBOTS = [*EXACT, "doosan_m1013"]


def robot_file(name: str) -> Path:
    """The table or URDF of a robot by its name."""
    places = (TESTS / "robots/tables" / f"{name}.toml", FIXTURES / f"{name}.toml")
    return next((p for p in places if p.is_file()), FIXTURES / f"{name}.urdf")


def solver_module(name: str) -> SolverModule:
    """The module of a robot by its name, for the whole pose."""
    dh = read(Request(robot_file(name))).dh
    graph = solve.solve_chain(dh)
    assert not graph.open_joints
    program = lower(graph, model_error=2.0 * max(dh.deviation))
    return module_around(program, dh, name=name.lower().replace("-", "_"))
