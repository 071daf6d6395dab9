"""Forward kinematics of a chain in an exact ring, and expressions of its pose and variables there.

The product of the links is multiplied out row by row from the DH table, apart from the code that makes
the matrix equations, so that what is proved against it is proved against the table.
"""

from __future__ import annotations

from typing import Any

from ikgen.algebra.expression import Atom, Expr
from ikgen.kinematics.rigid import exact_cos_sin
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.model.entry_names import entry_place
from ikgen.symbolic.exact_ring import ExactRing

__all__ = ["ExactKinematics", "Ratio"]

Ratio = tuple[Any, Any]
"""Numerator and denominator in the ring."""

Rows = tuple[tuple[Any, ...], ...]


class ExactKinematics:
    """`dh` in a ring of its own; with `tool_on_right` the pose is that of the tip."""

    def __init__(self, dh: DHChain, *, tool_on_right: bool = False) -> None:
        self.dh = dh
        constants = [x for row in dh.rows for x in (row.alpha, row.a, row.d) if x.name]
        lengths = dict.fromkeys(str(x.name) for x in constants if isinstance(x, Length))
        twists = dict.fromkeys(str(x.name) for x in constants if isinstance(x, Angle))
        joints = range(dh.dof)
        turning = [f"theta{j}" for j in joints if dh.lead_row(j).revolute]
        sliding = [f"slide{j}" for j in joints if not dh.lead_row(j).revolute]
        self.ring = ExactRing([*turning, *twists], [*sliding, *lengths])
        self.pose = self._pose(tool_on_right)
        self._done: dict[Expr, Ratio] = {}

    def __call__(self, node: Expr) -> Ratio:
        """An expression with forward kinematics put in for the pose.

        Raises `NotImplementedError` for one with other operations than + - * /.
        """
        found = self._done.get(node)
        if found is None:
            found = self._done[node] = self._make(node)
        return found

    # -- forward kinematics -----------------------------------------------------------------------

    def _pose(self, tool_on_right: bool) -> Rows:
        r = self.ring
        T = self._frame(len(self.dh.rows))
        if tool_on_right:
            tool = tuple(tuple(r.number(float(x)) for x in line) for line in self.dh.X_tip[:3])
            T = self._product(T, tool)
        return T

    def _frame(self, rows: int) -> Rows:
        """The frame of so many rows."""
        r = self.ring
        T: Rows = tuple(tuple(r.number(float(i == j)) for j in range(4)) for i in range(3))
        for row in self.dh.rows[:rows]:
            T = self._product(T, self._twist(row))
            T = self._product(T, self._motion(row))
        return T

    def _elbow(self) -> tuple[Any, ...]:
        """The point of the fourth axis that is nearest to the third."""
        return tuple(row[3] for row in self._product(self._frame(3), self._twist(self.dh.rows[3])))

    def _product(self, a: Rows, b: Rows) -> Rows:
        def entry(i: int, j: int) -> Any:
            total = sum((a[i][k] * b[k][j] for k in range(3)), self.ring.ring.zero)
            return self.ring.reduce(total + a[i][3] if j == 3 else total)

        return tuple(tuple(entry(i, j) for j in range(4)) for i in range(3))

    def _twist(self, row: DHRow) -> Rows:
        """`Rx(alpha) Tx(a)`"""
        c, s = self._angle(row.alpha)
        o, i = self.ring.ring.zero, self.ring.ring.one
        return (i, o, o, self._length(row.a)), (o, c, -s, o), (o, s, c, o)

    def _motion(self, row: DHRow) -> Rows:
        """`Rz(theta) Tz(d)`"""
        r = self.ring
        ratio, shift = self.dh.follows(row)
        if row.revolute:
            start = self._numbers(shift)
            c, s = r.turned(start, r.pair(f"theta{row.driver}"), round(ratio))
            d = self._length(row.d)
        else:
            c, s = self._numbers(row.theta.value)
            d = r.number(ratio) * r.free(f"slide{row.driver}") + r.number(shift)
        o, i = r.ring.zero, r.ring.one
        return (c, -s, o, o), (s, c, o, o), (o, o, i, d)

    def _angle(self, angle: Angle) -> tuple[Any, Any]:
        return self._numbers(angle.value) if angle.name is None else self.ring.pair(angle.name)

    def _numbers(self, angle: float) -> tuple[Any, Any]:
        c, s = exact_cos_sin(angle)
        return self.ring.number(c), self.ring.number(s)

    def _length(self, length: Length) -> Any:
        if length.name is None:
            return self.ring.number(length.value)
        return self.ring.free(length.name) * length.sign

    # -- expressions ------------------------------------------------------------------------------

    def _make(self, node: Expr) -> Ratio:
        one = self.ring.ring.one
        if node.is_const:
            return self.ring.number(node.value), one
        if node.op == "param":
            return self._constant(node), one
        if node.atom is not None:
            return self._atom(node.atom), one
        return self._operation(node.op, [self(a) for a in node.args])

    def _operation(self, op: str, parts: list[Ratio]) -> Ratio:
        multiply = self.ring.multiply
        if op == "neg":
            return -parts[0][0], parts[0][1]
        (a, b), (c, d) = parts
        if op == "sub":
            op, c = "add", -c
        if op == "add":
            if b == d:
                return a + c, b
            return multiply(a, d) + multiply(c, b), multiply(b, d)
        if op == "mul":
            return multiply(a, c), multiply(b, d)
        if op == "div":
            return multiply(a, d), multiply(b, c)
        raise NotImplementedError(f"the operation {op} is not one of + - * /")

    def _constant(self, node: Expr) -> Any:
        f = node.function
        if f is None:
            return self.ring.free(node.name)
        return self.ring.pair(f.angle)[f.function == "sin"]

    def _atom(self, atom: Atom) -> Any:
        r, key = self.ring, atom.key
        if isinstance(key, str):
            if key[0] == "e":
                return self._elbow()["xyz".index(key[1])]
            row, column = entry_place(key)
            return self.pose[row][column]
        if atom.kind == "prismatic":
            return r.free(f"slide{key.index(1)}")
        angle = (r.ring.one, r.ring.zero)
        for j, times in enumerate(key):
            if times:
                angle = r.turned(angle, r.pair(f"theta{j}"), times)
        return angle[atom.kind == "sin"]
