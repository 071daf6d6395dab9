"""Expressions as a hash-consed graph whose nodes carry their values at probe configurations.

Every node knows its value at a fixed set of configurations (random ones and regular special ones), so
"does this vanish identically?" and "is this constant?" are answered by looking (the zero test by
probing of the method's notes; Schwartz-Zippel for the polynomial part). Equal subexpressions are one
node, so sharing in the emitted code costs nothing to find.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["BINARY", "UNARY", "Atom", "Expr", "ExpressionGraph"]

Probe = NDArray[np.float64]
ZERO_TOLERANCE = 1e-10
"""A node is zero where its probe values stay below this, relative to the largest term that made it."""


@dataclass(frozen=True, slots=True)
class Atom:
    """What an input node stands for: `kind` is one of pose, cos, sin, dist, sigma, seed_cos, seed_sin,
    seed_dist, root; `key` says which one (an angle key, a joint index, a pose entry's name)."""

    kind: str
    key: tuple[int, ...] | str


class Expr:
    """A node: operation, arguments, probe values. Compare by identity; made by `ExpressionGraph` only."""

    __slots__ = (
        "args", "atom", "id", "is_fixed", "name", "op", "probe", "scale", "support", "value",
    )  # fmt: skip

    def __init__(
        self, op: str, args: tuple[Expr, ...], probe: Probe, scale: float, support: int
    ) -> None:
        self.op = op
        self.args = args
        self.probe = probe
        self.scale = scale
        self.support = support
        self.value = 0.0
        self.name = ""
        self.atom: Atom | None = None
        self.id = -1
        self.is_fixed: bool = op != "atom" and all(a.is_fixed for a in args)
        """Whether the node depends on parameters and numbers only."""

    @property
    def is_const(self) -> bool:
        """Whether the node is a literal number."""
        return self.op == "const"

    @property
    def vanishes(self) -> bool:
        """Whether the node is zero at every probe configuration."""
        return bool(np.max(np.abs(self.probe)) <= ZERO_TOLERANCE * self.scale)

    def __repr__(self) -> str:
        return f"<{self.op} {self.name or self.value or [a.id for a in self.args]}>"


BINARY: dict[str, Callable[..., Probe]] = {
    "add": np.add,
    "sub": np.subtract,
    "mul": np.multiply,
    "div": np.divide,
    "max": np.maximum,
    "min": np.minimum,
    "gt": lambda a, b: (a > b).astype(float),
    "and": np.multiply,
    "or": np.maximum,
}
UNARY: dict[str, Callable[..., Probe]] = {
    "neg": np.negative,
    "abs": np.abs,
    "sqrt": lambda a: np.sqrt(np.maximum(a, 0.0)),
    "not": lambda a: 1.0 - a,
}


class ExpressionGraph:
    """Maker of nodes. `probes` is the number of probe configurations."""

    def __init__(self, probes: int) -> None:
        self.probes = probes
        self._nodes: dict[tuple[object, ...], Expr] = {}
        self._atoms: dict[Atom, Expr] = {}
        self._by_bit: list[Expr] = []
        self.zero = self.const(0.0)
        self.one = self.const(1.0)
        self.minus_one = self.const(-1.0)

    def _register(self, key: tuple[object, ...], node: Expr) -> Expr:
        node.id = len(self._nodes)
        self._nodes[key] = node
        return node

    def const(self, value: float) -> Expr:
        """The literal `value`."""
        value = float(value) + 0.0
        key = ("const", value)
        if key in self._nodes:
            return self._nodes[key]
        node = Expr("const", (), np.full(self.probes, value), abs(value), 0)
        node.value = value
        return self._register(key, node)

    def param(self, name: str, value: float) -> Expr:
        """A named constant of the arm, such as `a_2`, with its value attached."""
        key = ("param", name)
        if key in self._nodes:
            return self._nodes[key]
        node = Expr("param", (), np.full(self.probes, value), abs(value), 0)
        node.name = name
        node.value = value
        return self._register(key, node)

    def atom(self, kind: str, key: tuple[int, ...] | str, probe: Probe, *, unknown: bool) -> Expr:
        """An input. Atoms that may be unknown get a bit of their own in `support`."""
        atom = Atom(kind, key)
        if atom in self._atoms:
            return self._atoms[atom]
        bit = 1 << len(self._by_bit) if unknown else 0
        probe = np.array(probe, dtype=float)
        node = Expr("atom", (), probe, float(np.max(np.abs(probe))) if len(probe) else 1.0, bit)
        node.atom = atom
        node.name = f"{kind}:{key}"
        self._atoms[atom] = node
        if unknown:
            self._by_bit.append(node)
        return self._register(("atom", atom), node)

    def atoms_in(self, mask: int) -> list[Expr]:
        """The atoms whose bits are set in a support mask."""
        out: list[Expr] = []
        while mask:
            low = mask & -mask
            out.append(self._by_bit[low.bit_length() - 1])
            mask ^= low
        return out

    def find_atom(self, kind: str, key: tuple[int, ...] | str) -> Expr | None:
        """The atom's node if it exists."""
        return self._atoms.get(Atom(kind, key))

    def _apply(self, op: str, args: tuple[Expr, ...]) -> Expr:
        key = (op, *(a.id for a in args))
        found = self._nodes.get(key)
        if found is not None:
            return found
        values = [a.probe for a in args]
        support = 0
        for a in args:
            support |= a.support
        with np.errstate(all="ignore"):
            if op == "select":
                probe = np.where(values[0] > 0.5, values[1], values[2])
            elif op in BINARY:
                probe = BINARY[op](*values)
            else:
                probe = UNARY[op](values[0])
        scales = [a.scale for a in args]
        if op in ("add", "sub", "max", "min"):
            scale = max(scales)
        elif op == "mul":
            scale = scales[0] * scales[1]
        elif op in ("neg", "abs"):
            scale = scales[0]
        else:
            finite = probe[np.isfinite(probe)]
            scale = float(np.max(np.abs(finite))) if finite.size else 1.0
        node = Expr(op, args, probe, scale, support)
        return self._register(key, node)

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
        return self._apply("neg", (a,))

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
        return self._apply("add", (a, b) if a.id < b.id else (b, a))

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
        return self._apply("sub", (a, b))

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
        return self._apply("mul", (a, b))

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
        return self._apply("div", (a, b))

    def sqrt(self, a: Expr) -> Expr:
        """sqrt(max(a, 0))"""
        if a.is_const:
            return self.const(max(a.value, 0.0) ** 0.5)
        return self._apply("sqrt", (a,))

    def unary(self, op: str, a: Expr) -> Expr:
        """abs, not"""
        if op == "not" and a.op == "not":
            return a.args[0]
        return self._apply(op, (a,))

    def binary(self, op: str, a: Expr, b: Expr) -> Expr:
        """max, min, gt, and, or"""
        return self._apply(op, (a, b))

    def select(self, condition: Expr, then: Expr, otherwise: Expr) -> Expr:
        """`then` where condition, else `otherwise`; neither side may trap."""
        if then is otherwise:
            return then
        return self._apply("select", (condition, then, otherwise))

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
