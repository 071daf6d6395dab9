"""The Program of an arm that only the general 6R elimination solves: one call, sixteen branches."""

from __future__ import annotations

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.lowering.frames import file_frames, operand_of
from ikgen.lowering.joint_values import first_row, joint_value, variable_lets
from ikgen.model.dh import DHChain
from ikgen.program.inputs import HeldValue, PoseEntry
from ikgen.program.liveness import trimmed
from ikgen.program.statements import Call, Comment, JointOutput, Let, Level, Program, Statement

__all__ = ["MOST_SOLUTIONS", "ROUTINE", "elimination_program"]

ROUTINE = "general_6r"
MOST_SOLUTIONS = 16


def elimination_program(dh: DHChain) -> Program:
    """All joints that are not held from one call of `general_6r` (Raghavan and Roth 1990)."""
    pose = tuple(PoseEntry(i, j) for i in range(3) for j in range(4))
    held = tuple(HeldValue(j) for j, joint in enumerate(dh.joints) if joint.name in dh.free)
    prelude: list[Let] = []
    given: list[str] = []
    for one in held:
        row, place = first_row(dh, one.joint), one.joint + 1
        names = (f"c{place}", f"s{place}") if row.revolute else (f"d{place}",)
        prelude += variable_lets(row, one.name, names)
        given += names
    moving = [j for j in range(dh.dof) if HeldValue(j) not in held]
    found = tuple(f"{x}{j + 1}" for j in moving for x in "cs")
    call = Call(ROUTINE, (*(entry.name for entry in pose), *given), found)
    values = [_value(dh, j) for j in moving]
    body: tuple[Statement, ...] = (
        Comment("all joints at once: the general 6R elimination"),
        *(Let(f"q{j + 1}", operand_of(e)) for j, e in zip(moving, values, strict=True)),
    )
    levels = (Level(1, None, None, ()), Level(MOST_SOLUTIONS, None, call, body))
    outputs = tuple(
        JointOutput(j, HeldValue(j).name if HeldValue(j) in held else f"q{j + 1}")
        for j in range(dh.dof)
    )
    return trimmed(
        Program(
            dh.robot, (), (), (*pose, *held), tuple(prelude), levels, outputs, (),
            frames=file_frames(dh),
        )
    )  # fmt: skip


def _value(dh: DHChain, joint: int) -> Expr:
    g = ExpressionGraph(1)
    pair = tuple(g.atom("input", f"{x}{joint + 1}", np.zeros(1), unknown=False) for x in "cs")
    return joint_value(g, first_row(dh, joint), pair)
