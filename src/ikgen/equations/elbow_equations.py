"""Equations of an arm whose arm angle is held: where its elbow is, from the frames of the
shoulder's joints.

The pose tells the wrist, whose distances from shoulder and elbow the links fix: with the angle of the plane
through the three given, the elbow is known (Shimizu et al., Analytical inverse kinematic computation for
7-DOF redundant manipulators with joint limits and its application to redundancy resolution, 2008).
"""

from __future__ import annotations

from collections.abc import Iterator

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.equation import Equation
from ikgen.equations.products import ChainProducts
from ikgen.equations.symbolic_transforms import Rigid, inverse, link, multiply, run, run_inverse

__all__ = ["arm_squares", "elbow_equations", "shoulder", "wrist"]

_SHOULDER, _ELBOW, _FOREARM = 1, 3, 4
"""Rows (from 0) whose links the shoulder's point, the elbow's axis and the forearm begin with."""

Vector = list[Expr]


def shoulder(system: ChainProducts) -> Vector:
    """The point in frame 0 that the first three axes go through."""
    g, v = system.graph, system.variables
    return list(multiply(g, link(v, 0), multiply(g, run(v, 0, 0), link(v, _SHOULDER))).p)


def wrist(system: ChainProducts) -> Vector:
    """The point in frame 0 that the last three axes go through."""
    g, T = system.graph, system.pose
    back = g.neg(system.variables.length(system.dh.rows[-1].d))
    return [g.add(p, g.mul(back, z)) for p, z in zip(T.p, T.column(2), strict=True)]


def arm_squares(system: ChainProducts) -> tuple[Expr, Expr]:
    """The squared distances of the elbow from the shoulder and from the wrist."""
    g, v = system.graph, system.variables
    fore = _placed(g, link(v, _FOREARM), [g.zero, g.zero, v.length(system.dh.rows[_FOREARM].d)])
    fore = _sum(g, fore, [g.zero, g.zero, v.length(system.dh.rows[_ELBOW].d)])
    upper = _upper(system)
    return g.dot(upper, upper), g.dot(fore, fore)


def _upper(system: ChainProducts) -> Vector:
    """The elbow from the shoulder, in the upper arm's frame."""
    g, v = system.graph, system.variables
    along = [g.zero, g.zero, v.length(system.dh.rows[_ELBOW - 1].d)]
    return _sum(g, list(link(v, _ELBOW).p), along)


def elbow_equations(system: ChainProducts) -> Iterator[Equation]:
    """The elbow, and where the third axis does not go through it the direction of that axis, from each of
    the shoulder's frames."""
    g, v = system.graph, system.variables
    aim = _upper_arm(system) if system.dh.rows[_ELBOW].a.name is not None else None
    point, direction = list(system.elbow), aim[0] if aim else []
    for k in range(_ELBOW):
        back, turn = inverse(g, link(v, k)), run_inverse(v, k, k)
        point = _placed(g, back, point)
        right = multiply(g, system.right(k, _ELBOW), link(v, _ELBOW))
        for i, axis in enumerate("xyz"):
            yield Equation(point[i], right.p[i], k, _ELBOW, f"e{axis}")
        point = _placed(g, turn, point)
        if aim is not None:
            direction = _turned(g, back, direction)
            along = system.right(k, _ELBOW).column(2)
            for i, axis in enumerate("xyz"):
                yield Equation(direction[i], g.mul(aim[1], along[i]), k, _ELBOW, f"u{axis}")
            direction = _turned(g, turn, direction)


def _upper_arm(system: ChainProducts) -> tuple[Vector, Expr]:
    """The third axis in frame 0 times a length squared, and that: from where the elbow e and the
    wrist w are from the shoulder. With m at right angles to both in the upper arm's frame, `z (m .
    e x w) = (w x m)_z e + (m x e)_z w + m_z (e x w)`."""
    g, v = system.graph, system.variables
    rows = system.dh.rows
    fore = [g.zero, g.zero, v.length(rows[_FOREARM].d)]
    frame = multiply(g, run(v, _ELBOW, _ELBOW), link(v, _FOREARM))
    e3 = _upper(system)
    w3 = _sum(g, _turned(g, link(v, _ELBOW), _placed(g, frame, fore)), e3)
    flat = e3[1] is g.zero and w3[1] is g.zero
    m = [g.zero, g.one, g.zero] if flat else _cross(g, e3, w3)
    start = [g.neg(x) for x in shoulder(system)]
    e, w = _sum(g, list(system.elbow), start), _sum(g, wrist(system), start)
    weights = _cross(g, w3, m)[2], _cross(g, m, e3)[2], m[2]
    parts = zip(e, w, _cross(g, e, w), strict=True)
    return [g.dot(list(weights), list(part)) for part in parts], g.dot(m, _cross(g, e3, w3))


def _sum(g: ExpressionGraph, a: Vector, b: Vector) -> Vector:
    return [g.add(x, y) for x, y in zip(a, b, strict=True)]


def _turned(g: ExpressionGraph, T: Rigid, u: Vector) -> Vector:
    return [g.dot(list(row), u) for row in T.R]


def _placed(g: ExpressionGraph, T: Rigid, p: Vector) -> Vector:
    return _sum(g, _turned(g, T, p), list(T.p))


def _cross(g: ExpressionGraph, a: Vector, b: Vector) -> Vector:
    pairs = ((1, 2), (2, 0), (0, 1))
    return [g.sub(g.mul(a[i], b[j]), g.mul(a[j], b[i])) for i, j in pairs]
