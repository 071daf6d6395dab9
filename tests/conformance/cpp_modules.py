"""Solver modules to emit: robots of the IKBT suite and real arms."""

from __future__ import annotations

import dataclasses
import json
import math
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from ikgen.emit.module import SolverModule
from ikgen.ir.lower import lower
from ikgen.kinematics.forward import row_constant
from ikgen.kinematics.modified_dh import to_dh
from ikgen.model.chain import ActuatedJoint
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.model.joint_tree import Limits
from ikgen.solver.run import solve_chain

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "unit"))
from arms import arm_chain
from benchmarks.collection import ARMS_FILE, load_arms

__all__ = ["EXACT", "ROBOTS", "solver_module"]

SUITE = ARMS_FILE.with_name("ikbt_robots.json")
_SUITE_ROBOTS = ["Puma", "UR5", "Olson13", "Raven-II", "Stanford"]
_REAL_ARMS = ["kuka_kr6r900sixx", "mitsubishi_rh6crh6020_scara", "ur5e"]

_FAR_FROM_EXACT = ["mycobot_pro630"]  # its Program is of another geometry than its file

EXACT = [*_SUITE_ROBOTS, *_REAL_ARMS] if ARMS_FILE.is_file() and SUITE.is_file() else []
ROBOTS = [*EXACT, *_FAR_FROM_EXACT] if EXACT else []


def solver_module(name: str) -> SolverModule:
    """The module of a robot by its name in either collection."""
    arms = {arm["name"]: arm for arm in load_arms()}
    dh = to_dh(arm_chain(arms[name])) if name in arms else _suite_chain(name)
    graph = solve_chain(dh)
    assert not graph.open_joints
    return SolverModule(
        name=name.lower().replace("-", "_"),
        program=lower(graph, slack=2.0 * max(dh.deviation)),
        dh=dh,
        task="pose",
        free=(),
        free_defaults=(),
        source_name=f"{name}.urdf",
        source_sha256="0" * 64,
        generator_version="test",
    )


def _suite_chain(name: str) -> DHChain:
    robots: list[dict[str, Any]] = json.loads(SUITE.read_text())
    robot = next(r for r in robots if r["name"] == name)
    constants = {**robot["params"], "pi": math.pi}
    for key, text in robot.get("params_exact", {}).items():
        constants[key] = eval(text, {"pi": math.pi})
    rows, joints = [], []
    for i, joint in enumerate(robot["joints"]):
        variable = joint.get("variable")
        values = {**constants, variable: 0.0}
        alpha, a, d, theta = (
            float(eval(str(joint[key]), values)) for key in ("alpha", "a", "d", "theta")
        )
        turns = joint["type"] == "revolute"
        joints.append(ActuatedJoint(variable, joint["type"], Limits(-math.inf, math.inf)))
        rows.append(
            DHRow(
                f"j{i + 1}", joint["type"], _angle(alpha, f"alpha_{i}"), _length(a, f"a_{i}"),
                _length(d if turns else 0.0, f"d_{i + 1}"),
                _angle(0.0 if turns else theta, f"theta_{i + 1}"), i, 1.0,
                _angle(theta, f"o_{i + 1}") if turns else _length(d, f"o_{i + 1}"),
            )
        )  # fmt: skip
    identity = np.eye(4)
    frames = (*(row_constant(row) for row in rows), identity)
    chain = DHChain(name, "base", "tip", tuple(joints), tuple(rows), identity, identity, frames)
    return dataclasses.replace(chain)


def _angle(value: float, name: str) -> Angle:
    turns = Fraction(round(value * 12 / math.pi), 12)
    return (
        Angle(value, turns)
        if abs(float(turns) * math.pi - value) < 1e-9
        else Angle(value, None, name)
    )


def _length(value: float, name: str) -> Length:
    return Length(value, name) if value else Length(0.0, None)
