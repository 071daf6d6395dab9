"""What a Program is handed: the pose, the seed's joint values, those of held joints."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.equations.knowledge import Variable
from ikgen.equations.symbolic_transforms import Rigid, constant, inverse, multiply
from ikgen.kinematics.fixed_order import product
from ikgen.lowering.joint_values import variable_lets
from ikgen.lowering.placement import Placement
from ikgen.program.inputs import HeldValue, PoseEntry, SeedValue
from ikgen.program.statements import Comment

__all__ = ["bind_joints", "bind_pose", "seed_values"]


def bind_pose(work: Placement) -> None:
    """The pose in DH frames out of the given one: `X_base^-1 T X_tip^-1`."""
    g = work.g
    base, tip = constant(g, work.dh.X_base), constant(g, work.dh.X_tip)
    pose = work.probes.pose
    raw = product(work.dh.X_base, pose)
    if work.whole_pose:
        raw = product(raw, work.dh.X_tip)
    rows = tuple(tuple(_entry(work, i, j, raw) for j in range(3)) for i in range(3))
    p = tuple(_entry(work, i, 3, raw) for i in range(3))
    T: Rigid = multiply(g, inverse(g, base), Rigid(rows, p))
    if work.whole_pose:
        T = multiply(g, T, inverse(g, tip))
    target = work.system.pose
    work.place(Comment("the pose in DH frames"))
    for i in range(3):
        for j in range(3):
            work.definition[target.R[i][j].id] = T.R[i][j]
        work.definition[target.p[i].id] = T.p[i]


def _entry(work: Placement, i: int, j: int, raw: NDArray[np.float64]) -> Expr:
    entry = PoseEntry(i, j)
    work.inputs.append(entry)
    return work.atom(entry.name, raw[:, i, j])


def bind_joints(work: Placement) -> None:
    """Values that joints take where a pose leaves them free, and those of held joints."""
    for j in range(work.dh.dof):
        row = work.dh.lead_row(j)
        seed = SeedValue(j)
        names = (f"seed_c{j + 1}", f"seed_s{j + 1}") if row.revolute else (f"seed_d{j + 1}",)
        for name in names:
            work.atom(name)
        work.inputs.append(seed)
        work.prelude += variable_lets(row, seed.name, names)
    for j in work.held:
        v = work.knowledge.joint_variable(j)
        held = HeldValue(j)
        if v.kind == "angle":
            atoms: tuple[Expr, ...] = work.knowledge.variables.pair(v.combination)
            names = (f"c{j + 1}", f"s{j + 1}")
        else:
            atoms, names = (work.knowledge.variables.distance(j),), (f"d{j + 1}",)
        for atom, name in zip(atoms, names, strict=True):
            work.names[atom.id] = name
        work.inputs.append(held)
        work.prelude += variable_lets(work.dh.lead_row(j), held.name, names)


def seed_values(work: Placement, variable: Variable) -> tuple[Expr, ...]:
    """The seed's value of a variable: sums of joint angles are composed."""
    g = work.g
    if variable.kind == "prismatic":
        assert variable.joint is not None
        return (work.atom(f"seed_d{variable.joint + 1}"),)
    c, s = g.one, g.zero
    for j, k in enumerate(variable.combination):
        cj, sj = (work.atom(f"seed_{x}{j + 1}") for x in "cs") if k else (g.one, g.zero)
        for _ in range(abs(k)):
            sj_signed = sj if k > 0 else g.neg(sj)
            c, s = (
                g.sub(g.mul(c, cj), g.mul(s, sj_signed)),
                g.add(g.mul(s, cj), g.mul(c, sj_signed)),
            )
    return c, s
