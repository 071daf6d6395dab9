"""Arithmetic on expressions: each operation rewrites what it can before it makes a node."""

from __future__ import annotations

from ikgen.algebra.expression import Expr
from ikgen.algebra.node_table import NodeTable

__all__ = ["ExpressionGraph"]


class ExpressionGraph(NodeTable):
    """Sums, products and so on of nodes, with constants folded, signs drawn out and like terms
    collected."""

    def neg(self, a: Expr) -> Expr:
        """-a"""
        if a.is_const:
            return self.const(-a.value)
        if a.op == "neg":
            return a.args[0]
        if a.op == "sub":
            return self.sub(a.args[1], a.args[0])
        if a.op == "mul" and a.args[0].is_const:
            return self.mul(self.const(-a.args[0].value), a.args[1])
        return self.apply("neg", (a,))

    def add(self, a: Expr, b: Expr) -> Expr:
        """a + b"""
        if a.is_const and b.is_const:
            return self.const(a.value + b.value)
        if a is self.zero:
            return b
        if b is self.zero:
            return a
        if a is b:
            return self.mul(self.const(2.0), a)
        if b.op == "neg":
            return self.sub(a, b.args[0])
        if a.op == "neg":
            return self.sub(b, a.args[0])
        like = self._collect(a, b, 1.0)
        if like is not None:
            return like
        return self.apply("add", (a, b) if a.id < b.id else (b, a))

    def _collect(self, a: Expr, b: Expr, sign: float) -> Expr | None:
        ka, xa = (a.args[0].value, a.args[1]) if _scaled(a) else (1.0, a)
        kb, xb = (b.args[0].value, b.args[1]) if _scaled(b) else (1.0, b)
        if xa is xb and (_scaled(a) or _scaled(b)):
            return self.mul(self.const(ka + sign * kb), xa)
        return None

    def sub(self, a: Expr, b: Expr) -> Expr:
        """a - b"""
        if a.is_const and b.is_const:
            return self.const(a.value - b.value)
        if b is self.zero:
            return a
        if a is self.zero:
            return self.neg(b)
        if a is b:
            return self.zero
        if b.op == "neg":
            return self.add(a, b.args[0])
        like = self._collect(a, b, -1.0)
        if like is not None:
            return like
        return self.apply("sub", (a, b))

    def mul(self, a: Expr, b: Expr) -> Expr:
        """a * b"""
        if a.is_const and b.is_const:
            return self.const(a.value * b.value)
        if b.is_const:
            a, b = b, a
        if a is self.zero:
            return self.zero
        if a is self.one:
            return b
        if a is self.minus_one:
            return self.neg(b)
        if a.is_const and b.op == "neg":
            return self.mul(self.const(-a.value), b.args[0])
        if a.is_const and _scaled(b):
            return self.mul(self.const(a.value * b.args[0].value), b.args[1])
        if a.op == "neg":
            return self.neg(self.mul(a.args[0], b))
        if b.op == "neg":
            return self.neg(self.mul(a, b.args[0]))
        if _scaled(a):
            return self.mul(a.args[0], self.mul(a.args[1], b))
        if _scaled(b):
            return self.mul(b.args[0], self.mul(a, b.args[1]))
        if not a.is_const and a.id > b.id:
            a, b = b, a
        return self.apply("mul", (a, b))

    def div(self, a: Expr, b: Expr) -> Expr:
        """a / b"""
        if b.is_const and b.value != 0.0:
            return self.mul(self.const(1.0 / b.value), a)
        if a is self.zero:
            return self.zero
        if a is b:
            return self.one
        if b.op == "neg":
            return self.neg(self.div(a, b.args[0]))
        if a.op == "neg":
            return self.neg(self.div(a.args[0], b))
        return self.apply("div", (a, b))

    def sqrt(self, a: Expr) -> Expr:
        """sqrt(max(a, 0))"""
        if a.is_const:
            return self.const(max(a.value, 0.0) ** 0.5)
        return self.apply("sqrt", (a,))

    def unary(self, op: str, a: Expr) -> Expr:
        """abs, not"""
        if op == "not" and a.op == "not":
            return a.args[0]
        return self.apply(op, (a,))

    def binary(self, op: str, a: Expr, b: Expr) -> Expr:
        """max, min, gt, and, or"""
        return self.apply(op, (a, b))

    def select(self, condition: Expr, then: Expr, otherwise: Expr) -> Expr:
        """`then` where condition, else `otherwise`; neither side may trap."""
        if then is otherwise:
            return then
        return self.apply("select", (condition, then, otherwise))

    def square(self, a: Expr) -> Expr:
        """a * a"""
        return self.mul(a, a)

    def dot(self, left: list[Expr], right: list[Expr]) -> Expr:
        """sum(left_i * right_i), zero terms dropped."""
        total = self.zero
        for a, b in zip(left, right, strict=True):
            total = self.add(total, self.mul(a, b))
        return total


def _scaled(a: Expr) -> bool:
    return a.op == "mul" and a.args[0].is_const
