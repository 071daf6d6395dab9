"""The constant frames of the file's own chain as operands: numbers, or names where a table has none."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.symbolic_transforms import Rigid, constant, multiply
from ikgen.model.angle_function import cosine_and_sine
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.program.ops import Op, Operand
from ikgen.program.statements import Entries

__all__ = ["file_frames", "operand_of"]


def file_frames(dh: DHChain) -> tuple[Entries, ...]:
    """The frames of `dh.file_frames` (n + 1, 3, 4), with names where the table has no numbers."""
    out = [_numbers(F) for F in dh.file_frames]
    for i, row in enumerate(dh.rows):
        if any(x.symbolic for x in (row.alpha, row.a, row.d, row.theta)):
            before = dh.X_base if i == 0 else np.eye(4)
            out[i] = _symbolic(before, row)
    return tuple(out)


def operand_of(e: Expr) -> Operand:
    """An expression of constants and named atoms as an operand."""
    if e.is_const:
        return e.value
    if not e.args:
        return e.name if e.op == "param" else str(e.atom.key if e.atom else e.name)
    return Op(e.op, tuple(operand_of(a) for a in e.args))


def _numbers(F: NDArray[np.float64]) -> Entries:
    return tuple(tuple(float(x) + 0.0 for x in row) for row in F[:3])  # no negative zeros


def _symbolic(before: NDArray[np.float64], row: DHRow) -> Entries:
    """`before * Rx(alpha) Tx(a) Rz(theta) Tz(d)` in names."""
    g = ExpressionGraph(1)
    (ca, sa), (ct, st) = _pair(g, row.alpha), _pair(g, row.theta)
    a, d = _length(g, row.a), _length(g, row.d)
    zero, one = g.zero, g.one
    link = Rigid(((one, zero, zero), (zero, ca, g.neg(sa)), (zero, sa, ca)), (a, zero, zero))
    turn = Rigid(((ct, g.neg(st), zero), (st, ct, zero), (zero, zero, one)), (zero, zero, d))
    T = multiply(g, multiply(g, constant(g, before), link), turn)
    return tuple(
        tuple(operand_of(e) for e in (*entries, p)) for entries, p in zip(T.R, T.p, strict=True)
    )


def _pair(g: ExpressionGraph, angle: Angle) -> tuple[Expr, Expr]:
    c, s = math.cos(angle.value), math.sin(angle.value)
    if not angle.symbolic or angle.name is None:
        return g.const(c), g.const(s)
    cosine, sine = cosine_and_sine(angle.name)
    return g.param(cosine, c), g.param(sine, s)


def _length(g: ExpressionGraph, length: Length) -> Expr:
    if not length.symbolic or length.name is None:
        return g.const(length.value)
    node = g.param(length.name, length.sign * length.value)
    return node if length.sign > 0 else g.neg(node)
