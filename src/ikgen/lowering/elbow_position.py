"""Where the elbow is, from the pose and the arm angle that is held: what its equations take as known.

With w from shoulder to wrist, h that part of it that is at right angles to the first axis z, and
psi the arm angle, the elbow is at `a w + b (cos(psi) x + sin(psi) y)` from the shoulder: a and b
follow from the three distances between shoulder, elbow and wrist, y is `w x z` and x `y x w`, both
of length 1 (`ikgen.kinematics.elbow_geometry` says what psi is)."""

from __future__ import annotations

from ikgen.equations.elbow_equations import arm_squares, shoulder, wrist
from ikgen.equations.probes import arm_size
from ikgen.lowering.placement import Placement
from ikgen.program.inputs import ArmAngle
from ikgen.program.ops import Op
from ikgen.program.statements import Comment, Let

__all__ = ["bind_elbow"]

_ON_AXIS = 1e-8
"""Distance of the wrist from the first axis, over that from the shoulder, up to which it is on it."""

_LEAST = 1e-12
"""The shortest distance between shoulder and wrist, over the arm's size, that is divided by."""


def bind_elbow(work: Placement) -> None:
    """The elbow's position in frame 0, where the arm angle is held."""
    if not work.dh.arm_angle:
        return
    g, given = work.g, ArmAngle()
    work.inputs.append(given)
    cosine, sine = work.atom("c_arm"), work.atom("s_arm")
    for name, function in (("c_arm", "cos"), ("s_arm", "sin")):
        work.prelude.append(Let(name, Op(function, (given.name,))))
    start = shoulder(work.system)
    w = [g.sub(p, s) for p, s in zip(wrist(work.system), start, strict=True)]
    level = g.add(g.square(w[0]), g.square(w[1]))
    square = g.add(level, g.square(w[2]))
    least = g.const((_LEAST * arm_size(work.dh)) ** 2)
    size, off = (g.sqrt(g.binary("max", x, least)) for x in (square, level))
    beside = g.binary("gt", level, g.mul(g.const(_ON_AXIS**2), square))
    c = g.select(beside, g.div(w[0], off), g.one)
    s = g.select(beside, g.div(w[1], off), g.zero)
    up, out = g.div(w[2], size), g.div(g.select(beside, off, g.zero), size)
    upper, fore = arm_squares(work.system)
    along = g.div(g.add(square, g.sub(upper, fore)), g.mul(g.const(2.0), size))
    radius = g.sqrt(g.sub(upper, g.square(along)))
    radius = g.mul(g.const(1.0 if work.dh.rows[0].scale > 0.0 else -1.0), radius)
    x, y = g.mul(radius, cosine), g.mul(radius, sine)
    lean, reach = g.mul(x, up), g.div(along, size)
    parts = (
        g.sub(g.mul(y, s), g.mul(lean, c)),
        g.neg(g.add(g.mul(y, c), g.mul(lean, s))),
        g.mul(x, out),
    )
    work.place(Comment("the elbow"))
    for i, atom in enumerate(work.system.elbow):
        work.definition[atom.id] = g.add(start[i], g.add(g.mul(reach, w[i]), parts[i]))
        work.names[atom.id] = f"elbow_{'xyz'[i]}"
        work.place(atom)
