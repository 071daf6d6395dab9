"""Joint values of the file from DH variables, and back: offsets, signs and ratios.

A joint's DH variable is `v = scale * q + offset`. For angles the pair of cosine and sine is turned by the
offset and mirrored instead, so that the value of the one arctangent is in (-pi, pi]; of a joint whose
whole turns are other configurations it is counted from the middle of the limits.
"""

from __future__ import annotations

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.kinematics.rigid import exact_cos_sin
from ikgen.model.dh import DHRow
from ikgen.program.ops import Op, Operand
from ikgen.program.statements import Let

__all__ = ["joint_expression", "variable_lets"]


def joint_expression(
    g: ExpressionGraph, row: DHRow, variable: tuple[Expr, ...], middle: float = 0.0
) -> Expr:
    """The joint's value `(v - offset) / scale` (rad or m) from (cosine, sine) or (length,) of v; of an
    angle's values the one next to `middle`."""
    if not row.revolute:
        moved = g.sub(variable[0], g.const(row.offset.value))
        return g.div(moved, g.const(row.scale))
    c, s = variable
    co, so = (g.const(x) for x in exact_cos_sin(row.offset.value + row.scale * middle))
    cosine = g.add(g.mul(co, c), g.mul(so, s))
    sine = g.sub(g.mul(co, s), g.mul(so, c))
    if row.scale < 0.0:
        sine = g.neg(sine)
    value = g.div(g.binary("atan2", sine, cosine), g.const(abs(row.scale)))
    return g.add(g.const(middle), value) if middle else value


def variable_lets(row: DHRow, given: str, names: tuple[str, ...]) -> tuple[Let, ...]:
    """The DH variable of the joint's value `given` as names: (cosine, sine) or (length,)."""
    value: Operand = given
    if row.scale != 1.0:
        value = Op("neg", (given,)) if row.scale == -1.0 else Op("mul", (row.scale, given))
    if row.offset.value:
        value = Op("add", (value, row.offset.value))
    if not row.revolute:
        return (Let(names[0], value),)
    before: tuple[Let, ...] = ()
    if isinstance(value, Op):
        before, value = (Let(f"{given}_dh", value),), f"{given}_dh"
    pair = zip(names, ("cos", "sin"), strict=True)
    return (*before, *(Let(name, Op(function, (value,))) for name, function in pair))
