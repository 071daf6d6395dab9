"""A hand-written Program of two joints, for golden texts."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from tests.support.module_facts import module_around

from ikgen.emit.solver_module import SolverModule
from ikgen.kinematics.forward import row_constant
from ikgen.lowering.frames import file_frames
from ikgen.model.chain import ActuatedJoint
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.model.joint_tree import Limits
from ikgen.program.inputs import PoseEntry
from ikgen.program.ops import Op
from ikgen.program.statements import Comment, Constant, JointOutput, Let, Level, Program, Require


def pan_lift() -> SolverModule:
    """A pan joint about z and a lift along it; the tip sits at radius `a_2` from the axis."""
    zero, none = Angle(0.0, Fraction(0)), Length(0.0, None)
    rows = (
        DHRow("pan", "revolute", zero, none, none, zero, 0, 1.0, zero),
        DHRow("lift", "prismatic", zero, Length(0.3, "a_2"), none, zero, 1, 1.0, none),
    )
    joints = (
        ActuatedJoint("pan", "revolute", Limits(-3.0, 3.0)),
        ActuatedJoint("lift", "prismatic", Limits(0.0, 0.5)),
    )
    identity = np.eye(4)
    frames = (*(row_constant(row) for row in rows), identity)
    dh = DHChain("pan_lift", "base", "tip", joints, rows, identity, identity, frames)
    root = Op("sqrt", (Op("sub", (1.0, Op("mul", ("c1", "c1")))),))
    program = Program(
        name="pan_lift",
        parameters=(Constant("a_2", 0.3),),
        constants=(),
        inputs=(PoseEntry(0, 3), PoseEntry(1, 3), PoseEntry(2, 3)),
        prelude=(),
        levels=(
            Level(1, None, None, (Comment("the radius"), Let("c1", Op("div", ("t03", "a_2"))))),
            Level(
                2,
                "sigma_1",
                None,
                (
                    Let("s1", Op("mul", ("sigma_1", root))),
                    Let("error", Op("sub", (Op("mul", ("a_2", "s1")), "t13"))),
                    Require(Op("gt", (1e-9, Op("abs", ("error",))))),
                ),
                ("c1", "s1"),
            ),
        ),
        outputs=(JointOutput(0, Op("atan2", ("s1", "c1"))), JointOutput(1, "t23")),
        singular=(),
        frames=file_frames(dh),
    )  # fmt: skip
    return module_around(program, dh, name="pan_lift", task="position", geometry="pan and lift")
