"""A solver module whose Program is made by hand: every kind of input, level and statement is in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from tests.support.module_facts import module_around
from tests.support.tables import table

from ikgen.emit.solver_module import SolverModule
from ikgen.model.joint_tree import Limits
from ikgen.program.inputs import HeldValue, PoseEntry, SeedValue
from ikgen.program.ops import Op, Operand
from ikgen.program.routines import TRIG_QUARTIC
from ikgen.program.statements import (
    Call,
    Comment,
    Constant,
    JointOutput,
    Let,
    Level,
    Program,
    Require,
)

__all__ = ["made_module", "made_program", "with_limits"]


def _square(name: str) -> Operand:
    return Op("mul", (name, name))


def made_program() -> Program:
    """Of two angles and a length that is held: a sign tells the first angle's branches apart, the second is
    a root. It solves no arm."""
    first = Level(
        1, None, None,
        (
            Comment("the sides"),
            Let("x1", Op("add", (_square("t03"), _square("t13")))),
            Require(Op("gt", ("x1", "k1")), True),
            Let("near", Op("gt", (Op("mul", (4.0, "k1")), "x1")), True),
        ),
    )  # fmt: skip
    middle = Level(
        2, "sigma_1", None,
        (
            Comment("theta_1: made up"),
            Let("x2", Op("sqrt", (Op("sub", ("x1", "k1")),))),
            Let("c1", Op("div", (Op("mul", ("sigma_1", "x2")), Op("sqrt", ("x1",))))),
            Let("s1", Op("select", ("near", "seed_s1", Op("div", ("a_1", Op("sqrt", ("x1",))))))),
            Require(Op("gt", (2.0, Op("sub", ("c1", "t13")))), True),
        ),
        ("c1", "s1"),
    )  # fmt: skip
    call = Call(TRIG_QUARTIC, (0.25, "d3", "c1", Op("neg", ("s1",)), 0.1), ("c2", "s2"))
    last = Level(
        4, None, call,
        (
            Comment("theta_2: made up"),
            Require(Op("or", (Op("gt", ("c2", -0.8)), Op("gt", ("s2", "t03"))))),
            Let("off", Op("mul", (_square("c2"), 1e-19))),
        ),
    )  # fmt: skip
    outputs = (
        JointOutput(0, Op("atan2", ("s1", "c1"))),
        JointOutput(1, Op("atan2", ("s2", "c2"))),
        JointOutput(2, "held_q3"),
    )
    return Program(
        "made", (Constant("a_1", 0.5),), (Let("k1", Op("mul", ("a_1", "a_1"))),),
        (PoseEntry(0, 3), PoseEntry(1, 3), SeedValue(0), HeldValue(2)),
        (Let("seed_s1", Op("sin", ("seed_q1",))), Let("d3", Op("add", ("held_q3", 0.3)))),
        (first, middle, last), outputs, ("near",), ("off",),
    )  # fmt: skip


def made_module() -> SolverModule:
    """Of `made_program`, with a chain of two turning joints and a sliding one that is held."""
    dh = table(("R", "0", 0.0, 0.0), ("R", "1", 0.5, 0.0), ("P", "1", 0.0, 0.0))
    dh = replace(dh, free=("q2",))
    return module_around(made_program(), dh, name="made", task="position")


def with_limits(module: SolverModule, *limits: tuple[float, float]) -> SolverModule:
    """The module with other limits (rad or m) of its joints, base to tip."""
    joints = tuple(
        replace(joint, limits=Limits(low, high))
        for joint, (low, high) in zip(module.dh.joints, limits, strict=True)
    )
    return replace(module, dh=replace(module.dh, joints=joints, free=module.dh.free))


POSES = np.array([[0.9, 0.8], [0.3, 0.2], [-1.4, 0.3], [0.55, 0.4], [2.5, -1.5]])
"""Positions (x, y) in the plane: of several rows, none, and of a continuum."""
