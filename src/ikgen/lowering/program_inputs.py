"""What a Program is handed: the pose, the seed's joint values, those of held joints."""

from __future__ import annotations

from ikgen.algebra.expression import Expr
from ikgen.equations.knowledge import Variable
from ikgen.equations.symbolic_transforms import Rigid, constant, inverse, multiply
from ikgen.lowering.placement import Placement
from ikgen.program.statements import Comment

__all__ = ["bind_pose", "bind_seeds", "seed_values"]


def bind_pose(work: Placement) -> None:
    """The pose in DH frames out of the given one: `X_base^-1 T X_tip^-1`."""
    g = work.g
    base, tip = constant(g, work.dh.X_base), constant(g, work.dh.X_tip)
    pose = work.session.probes.pose
    raw = work.dh.X_base @ pose
    if work.whole_pose:
        raw = raw @ work.dh.X_tip
    rows = tuple(tuple(work.input(f"t{i}{j}", raw[:, i, j]) for j in range(3)) for i in range(3))
    p = tuple(work.input(f"t{i}3", raw[:, i, 3]) for i in range(3))
    T: Rigid = multiply(g, inverse(g, base), Rigid(rows, p))
    if work.whole_pose:
        T = multiply(g, T, inverse(g, tip))
    target = work.system.pose
    work.place(Comment("the pose in DH frames"))
    for i in range(3):
        for j in range(3):
            work.definition[target.R[i][j].id] = T.R[i][j]
        work.definition[target.p[i].id] = T.p[i]


def bind_seeds(work: Placement) -> None:
    """Values that joints take where a pose leaves them free, and those of held joints."""
    for j in range(work.dh.dof):
        if work.session.joint_variable(j).kind == "angle":
            work.input(f"seed_c{j + 1}")
            work.input(f"seed_s{j + 1}")
        else:
            work.input(f"seed_d{j + 1}")
    for j in work.session.held:
        v = work.session.joint_variable(j)
        if v.kind == "angle":
            c, s = work.knowledge.variables.pair(v.key)
            work.names[c.id], work.names[s.id] = f"c{j + 1}", f"s{j + 1}"
            work.inputs += [f"c{j + 1}", f"s{j + 1}"]
        else:
            d = work.knowledge.variables.distance(j)
            work.names[d.id] = f"d{j + 1}"
            work.inputs.append(f"d{j + 1}")


def seed_values(work: Placement, variable: Variable) -> tuple[Expr, ...]:
    """The seed's value of a variable: sums of joint angles are composed."""
    g = work.g
    if variable.kind == "dist":
        assert variable.joint is not None
        return (work.input(f"seed_d{variable.joint + 1}"),)
    c, s = g.one, g.zero
    for j, k in enumerate(variable.key):
        cj, sj = (work.input(f"seed_{x}{j + 1}") for x in "cs") if k else (g.one, g.zero)
        for _ in range(abs(k)):
            sj_signed = sj if k > 0 else g.neg(sj)
            c, s = (
                g.sub(g.mul(c, cj), g.mul(s, sj_signed)),
                g.add(g.mul(s, cj), g.mul(c, sj_signed)),
            )
    return c, s
