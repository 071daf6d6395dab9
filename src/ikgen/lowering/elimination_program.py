"""The Program of an arm that only an elimination solves: one call, a branch for each root."""

from __future__ import annotations

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.elimination.elimination_table import EliminationRoutine
from ikgen.kinematics.whole_turns import middle_of
from ikgen.lowering.frames import file_frames, operand_of
from ikgen.lowering.joint_values import joint_expression, variable_lets
from ikgen.model.dh import DHChain
from ikgen.program.inputs import HeldValue, PoseEntry
from ikgen.program.liveness import trimmed
from ikgen.program.ops import Op
from ikgen.program.statements import Call, Comment, JointOutput, Let, Level, Program, Statement

__all__ = ["elimination_program"]


def elimination_program(
    dh: DHChain, routine: EliminationRoutine, most: int, tool: int | None = None
) -> Program:
    """All joints that are not held from one call of the `routine` (Raghavan and Roth 1993), which has at
    `most` so many solutions. `tool`: the tool's axis (0: x) whose direction alone is read beside the
    position; the last joint that the elimination finds turns about it, and is none of the arm's."""
    columns = range(4) if tool is None else (tool, 3)
    pose = tuple(PoseEntry(i, j) for i in range(3) for j in columns)
    completed, entries = _whole_pose(tool)
    held = tuple(HeldValue(j) for j in dh.free_indices)
    prelude: list[Let] = []
    given: list[str] = []
    for one in held:
        names = _names(dh, one.joint)
        prelude += variable_lets(dh.lead_row(one.joint), one.name, names)
        given += names
    moving = [j for j in range(dh.dof) if HeldValue(j) not in held]
    found = tuple(name for j in moving for name in _names(dh, j))
    if tool is not None:
        found += (f"c{dh.dof + 1}", f"s{dh.dof + 1}")
    call = Call(routine.called, (*entries, *given), found)
    values = [_value(dh, j) for j in moving]
    body: tuple[Statement, ...] = (
        Comment(f"all joints at once: the general {routine.words} elimination"),
        *(Let(f"q{j + 1}", operand_of(e)) for j, e in zip(moving, values, strict=True)),
    )
    levels = (Level(1, None, None, completed), Level(most, None, call, body))
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


def _whole_pose(tool: int | None) -> tuple[tuple[Statement, ...], tuple[str, ...]]:
    """The pose's upper rows by name, and the statements that complete a direction of the tool's axis `tool`
    to a rotation (Duff et al. 2017)."""
    rows = [[PoseEntry(i, j).name for j in range(4)] for i in range(3)]
    if tool is None:
        return (), tuple(name for row in rows for name in row)
    x, y, z = (row[tool] for row in rows)
    first, second = (tool + 1) % 3, (tool + 2) % 3
    for i in range(3):
        rows[i][first], rows[i][second] = f"u{i + 1}", f"v{i + 1}"
    lets = [
        Let("side", Op("select", (Op("gt", (z, 0.0)), 1.0, -1.0))),
        Let("share", Op("div", (-1.0, Op("add", ("side", z))))),
        Let("skew", Op("mul", (Op("mul", (x, y)), "share"))),
        Let("u1", Op("add", (1.0, Op("mul", (Op("mul", ("side", "share")), Op("mul", (x, x))))))),
        Let("u2", Op("mul", ("side", "skew"))),
        Let("u3", Op("neg", (Op("mul", ("side", x)),))),
        Let("v1", "skew"),
        Let("v2", Op("add", ("side", Op("mul", ("share", Op("mul", (y, y))))))),
        Let("v3", Op("neg", (y,))),
    ]
    words = "any rotation with this direction: the elimination's last joint turns about it"
    return (Comment(words), *lets), tuple(name for row in rows for name in row)


def _names(dh: DHChain, joint: int) -> tuple[str, ...]:
    """What the call gives of a joint: cosine and sine of its angle, or its length."""
    place = joint + 1
    return (f"c{place}", f"s{place}") if dh.lead_row(joint).revolute else (f"d{place}",)


def _value(dh: DHChain, joint: int) -> Expr:
    g = ExpressionGraph(1)
    names = _names(dh, joint)
    parts = tuple(g.atom("input", name, np.zeros(1), unknown=False) for name in names)
    return joint_expression(g, dh.lead_row(joint), parts, middle_of(dh, joint))
