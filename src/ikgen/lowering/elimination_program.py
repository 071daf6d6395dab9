"""The Program of an arm that only an elimination solves: one call, a branch for each root."""

from __future__ import annotations

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.kinematics.whole_turns import middle_of
from ikgen.lowering.frames import file_frames, operand_of
from ikgen.lowering.joint_values import joint_value, variable_lets
from ikgen.model.dh import DHChain
from ikgen.program.inputs import HeldValue, PoseEntry
from ikgen.program.liveness import trimmed
from ikgen.program.statements import Call, Comment, JointOutput, Let, Level, Program, Statement

__all__ = ["elimination_name", "elimination_program"]

_ROUTINES = ("general_6r", "one_slide", "two_slides", "three_slides")
_NAMES = ("6R", "5R1P", "4R2P", "3R3P")


def _slides(dh: DHChain) -> int:
    return sum(not row.revolute for row in dh.rows if dh.joints[row.driver].name not in dh.free)


def elimination_name(dh: DHChain) -> str:
    """The elimination's class: how many of the moving joints turn and slide."""
    return "coupled 6R" if _coupled(dh) else _NAMES[_slides(dh)]


def _coupled(dh: DHChain) -> bool:
    """Whether a joint moves several axes."""
    return len(dh.rows) > dh.dof


def elimination_program(dh: DHChain, most: int) -> Program:
    """All joints that are not held from one call of an elimination (Raghavan and Roth 1993), which has at
    `most` so many solutions."""
    pose = tuple(PoseEntry(i, j) for i in range(3) for j in range(4))
    held = tuple(HeldValue(j) for j in dh.free_indices)
    prelude: list[Let] = []
    given: list[str] = []
    for one in held:
        names = _names(dh, one.joint)
        prelude += variable_lets(dh.lead_row(one.joint), one.name, names)
        given += names
    moving = [j for j in range(dh.dof) if HeldValue(j) not in held]
    found = tuple(name for j in moving for name in _names(dh, j))
    routine = "coupled_6r" if _coupled(dh) else _ROUTINES[_slides(dh)]
    call = Call(routine, (*(entry.name for entry in pose), *given), found)
    values = [_value(dh, j) for j in moving]
    body: tuple[Statement, ...] = (
        Comment(f"all joints at once: the general {elimination_name(dh)} elimination"),
        *(Let(f"q{j + 1}", operand_of(e)) for j, e in zip(moving, values, strict=True)),
    )
    levels = (Level(1, None, None, ()), Level(most, None, call, body))
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


def _names(dh: DHChain, joint: int) -> tuple[str, ...]:
    """What the call gives of a joint: cosine and sine of its angle, or its length."""
    place = joint + 1
    return (f"c{place}", f"s{place}") if dh.lead_row(joint).revolute else (f"d{place}",)


def _value(dh: DHChain, joint: int) -> Expr:
    g = ExpressionGraph(1)
    names = _names(dh, joint)
    parts = tuple(g.atom("input", name, np.zeros(1), unknown=False) for name in names)
    return joint_value(g, dh.lead_row(joint), parts, middle_of(dh, joint))
