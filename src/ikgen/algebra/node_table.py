"""The table that holds every node of an expression graph once."""

from __future__ import annotations

from copy import copy
from typing import TypeVar

import numpy as np

from ikgen.algebra.expression import BINARY, UNARY, Atom, Expr, Probe
from ikgen.model.angle_function import AngleFunction

__all__ = ["NodeTable"]

Table = TypeVar("Table", bound="NodeTable")


class NodeTable:
    """Maker of nodes, each once. `probes` is the number of probe configurations."""

    def __init__(self, probes: int) -> None:
        self.probes = probes
        self._nodes: dict[tuple[object, ...], Expr] = {}
        self._atoms: dict[Atom, Expr] = {}
        self._by_bit: list[Expr] = []
        self.zero = self.const(0.0)
        self.one = self.const(1.0)
        self.minus_one = self.const(-1.0)

    def extended(self: Table) -> Table:
        """Another table with the same nodes, which grows by itself."""
        other = copy(self)
        other._nodes = dict(self._nodes)
        other._atoms = dict(self._atoms)
        other._by_bit = list(self._by_bit)
        return other

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

    def param(self, symbol: str | AngleFunction, value: float, probe: Probe | None = None) -> Expr:
        """A named constant of the arm, such as `a_2` or the cosine of `alpha_2`, with its value attached.
        `probe` are its values at the probes where they are others: any that the structure allows, then the
        one that was meant."""
        key = ("param", symbol)
        if key in self._nodes:
            return self._nodes[key]
        at = np.full(self.probes, value) if probe is None else np.array(probe, dtype=float)
        node = Expr("param", (), at, float(np.max(np.abs(at))) if len(at) else abs(value), 0)
        if isinstance(symbol, AngleFunction):
            node.name, node.function = symbol.name, symbol
        else:
            node.name = symbol
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

    @property
    def unknown_mask(self) -> int:
        """The support mask of all atoms that may be unknown."""
        return (1 << len(self._by_bit)) - 1

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

    def apply(self, op: str, args: tuple[Expr, ...]) -> Expr:
        """The operation on the arguments as it stands, without any rewriting."""
        key = (op, *(a.id for a in args))
        found = self._nodes.get(key)
        if found is not None:
            return found
        support = 0
        for a in args:
            support |= a.support
        probe = _values(op, [a.probe for a in args])
        scale = _scale(op, [a.scale for a in args], probe)
        return self._register(key, Expr(op, args, probe, scale, support))


def _values(op: str, values: list[Probe]) -> Probe:
    """The operation at the probes."""
    with np.errstate(all="ignore"):
        if op == "select":
            return np.where(values[0] > 0.5, values[1], values[2])
        if op in BINARY:
            return BINARY[op](*values)
        return UNARY[op](values[0])


def _scale(op: str, scales: list[float], probe: Probe) -> float:
    """The largest term that made a node, for its zero test."""
    if op in ("add", "sub", "max", "min"):
        return max(scales)
    if op == "mul":
        return scales[0] * scales[1]
    if op in ("neg", "abs"):
        return scales[0]
    finite = probe[np.isfinite(probe)]
    return float(np.max(np.abs(finite))) if finite.size else 1.0
