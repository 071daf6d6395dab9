"""The Program of an arm that only the general 6R elimination solves: one call, sixteen branches."""

from __future__ import annotations

from ikgen.model.dh import DHChain
from ikgen.program.statements import Call, Comment, JointOutput, Level, Program

__all__ = ["MOST_SOLUTIONS", "ROUTINE", "elimination_program"]

ROUTINE = "general_6r"
MOST_SOLUTIONS = 16


def elimination_program(dh: DHChain) -> Program:
    """All joints that are not held from one call of `general_6r` (Raghavan and Roth 1990)."""
    names: list[str] = []
    held: list[str] = []
    outputs: list[JointOutput] = []
    for j, joint in enumerate(dh.joints):
        if not dh.rows[j].revolute:  # a slide is held: the elimination moves revolute joints alone
            held.append(f"d{j + 1}")
            outputs.append(JointOutput(j, False, held[-1], 0.0))
            continue
        pair = (f"c{j + 1}", f"s{j + 1}")
        (held if joint.name in dh.free else names).extend(pair)
        outputs.append(JointOutput(j, True, *pair))
    pose = tuple(f"t{i}{j}" for i in range(3) for j in range(4))
    arguments = (*pose, *held)
    comment = Comment("all joints at once: the general 6R elimination")
    level = Level(MOST_SOLUTIONS, None, Call(ROUTINE, arguments, tuple(names)), (comment,))
    root = Level(1, None, None, ())
    return Program(dh.robot, (), (), arguments, (root, level), tuple(outputs), ())
