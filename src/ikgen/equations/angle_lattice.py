"""The lattice of known angle keys: the integer combinations of solved ones, group by group."""

from __future__ import annotations

import itertools
from copy import copy

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.algebra.polynomial import Key
from ikgen.equations.variables import JointVariables

__all__ = ["AngleLattice"]


class AngleLattice:
    """`solved` maps the keys that were solved to cosine and sine, `known` every key that follows from
    them to its (factor, solved key) pairs."""

    def __init__(self, graph: ExpressionGraph, variables: JointVariables) -> None:
        self._graph = graph
        self._variables = variables
        self.solved: dict[Key, tuple[Expr, Expr]] = {}
        self.known: dict[Key, tuple[tuple[int, Key], ...]] = {}
        self._representatives = self._contiguous_keys()
        self._represented: dict[Key, tuple[int, Key, Key]] = {}

    def over(self, graph: ExpressionGraph, variables: JointVariables) -> AngleLattice:
        """The same lattice over a graph that has all nodes of this one's."""
        other = copy(self)
        other._graph, other._variables = graph, variables
        other.solved, other.known = dict(self.solved), dict(self.known)
        other._represented = dict(self._represented)
        return other

    def add(self, key: Key) -> None:
        """Take a key as solved; `rebuild` then finds what follows."""
        self.solved[key] = self._variables.pair(key)

    def _contiguous_keys(self) -> list[Key]:
        n = self._variables.count
        units = [self._variables.unit(j) for j in range(n)]
        keys: list[Key] = list(units)
        for length in range(2, n + 1):
            for start in range(n - length + 1):
                members = range(start, start + length)
                if len({self._variables.group[j] for j in members}) == 1:
                    keys.append(tuple(int(start <= j < start + length) for j in range(n)))
        return keys

    def rebuild(self) -> None:
        """Find all keys that follow from the solved ones."""
        self._represented.clear()
        zero = tuple([0] * self._variables.count)
        found: dict[Key, tuple[tuple[int, Key], ...]] = {zero: ()}
        by_group: dict[int, list[Key]] = {}
        for key in self.solved:
            by_group.setdefault(self._variables.group_of(key), []).append(key)
        for keys in by_group.values():
            choices = sorted(
                itertools.product((0, 1, -1, 2, -2), repeat=len(keys)),
                key=lambda c: (sum(map(abs, c)), c),
            )
            for coefs in choices:
                total = tuple(
                    sum(c * k[j] for c, k in zip(coefs, keys, strict=True))
                    for j in range(self._variables.count)
                )
                terms = tuple((c, k) for c, k in zip(coefs, keys, strict=True) if c)
                found.setdefault(total, terms)
        self.known = found

    def pair(self, key: Key) -> tuple[Expr, Expr] | None:
        """Cosine and sine of a known key's angle, composed from solved ones; None if unknown."""
        terms = self.known.get(key)
        if terms is None:
            return None
        g = self._graph
        c, s = g.one, g.zero
        for factor, base in terms:
            bc, bs = self.solved[base]
            if factor < 0:
                bs = g.neg(bs)
            for _ in range(abs(factor)):
                c, s = (
                    g.sub(g.mul(c, bc), g.mul(s, bs)),
                    g.add(g.mul(s, bc), g.mul(c, bs)),
                )
        return c, s

    def represent(self, key: Key) -> tuple[int, Key, Key]:
        """`key = factor * representative + shift` with a known shift."""
        if key in self._represented:
            found = self._represented[key]
            assert found is not None
            return found
        group = self._variables.group_of(key)
        zero = tuple([0] * self._variables.count)
        result = (1, key, zero)
        for factor in (1, -1, 2, -2):
            for rep in self._representatives:
                if self._variables.group_of(rep) != group:
                    continue
                shift = tuple(k - factor * r for k, r in zip(key, rep, strict=True))
                if shift in self.known and rep not in self.known:
                    self._represented[key] = (factor, rep, shift)
                    return factor, rep, shift
        self._represented[key] = result
        return result

    def rank(self, keys: list[Key]) -> int:
        """Number of independent unknowns among the angles of keys."""
        if not keys:
            return 0
        known = [list(k) for k in self.solved]
        base = np.linalg.matrix_rank(np.array(known)) if known else 0
        both = np.linalg.matrix_rank(np.array(known + [list(k) for k in keys]))
        return int(both - base)
