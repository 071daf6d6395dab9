"""The lattice of known angle combinations: the integer combinations of solved ones, group by group."""

from __future__ import annotations

from copy import copy

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.algebra.polynomial import AngleCombination
from ikgen.equations.known_combinations import KnownCombinations
from ikgen.equations.variables import JointVariables

__all__ = ["AngleLattice"]


class AngleLattice:
    """`solved` maps the combinations that were solved to cosine and sine, `known` every combination
    that follows from them to its (factor, solved combination) pairs."""

    def __init__(self, graph: ExpressionGraph, variables: JointVariables) -> None:
        self._graph = graph
        self._variables = variables
        self.solved: dict[AngleCombination, tuple[Expr, Expr]] = {}
        self.known = KnownCombinations((), tuple(variables.group))
        self._representatives = self._contiguous_keys()
        self._represented: dict[
            AngleCombination, tuple[int, AngleCombination, AngleCombination]
        ] = {}
        self._ranks: dict[frozenset[AngleCombination], int] = {}
        self._solved_rank = 0

    def over(self, graph: ExpressionGraph, variables: JointVariables) -> AngleLattice:
        """The same lattice over a graph that has all nodes of this one's."""
        other = copy(self)
        other._graph, other._variables = graph, variables
        other.solved = dict(self.solved)
        other._represented, other._ranks = dict(self._represented), dict(self._ranks)
        return other

    def add(self, combination: AngleCombination) -> None:
        """Take a combination as solved; `rebuild` then finds what follows."""
        self.solved[combination] = self._variables.pair(combination)

    def _contiguous_keys(self) -> list[AngleCombination]:
        n = self._variables.count
        units = [self._variables.unit(j) for j in range(n)]
        combinations: list[AngleCombination] = list(units)
        for length in range(2, n + 1):
            for start in range(n - length + 1):
                members = range(start, start + length)
                if len({self._variables.group[j] for j in members}) == 1:
                    combinations.append(tuple(int(start <= j < start + length) for j in range(n)))
        return combinations

    def rebuild(self) -> None:
        """Find all combinations that follow from the solved ones."""
        self._represented.clear()
        self._ranks.clear()
        known = [list(k) for k in self.solved]
        self._solved_rank = int(np.linalg.matrix_rank(np.array(known))) if known else 0
        self.known = KnownCombinations(self.solved, tuple(self._variables.group))

    def pair(self, combination: AngleCombination) -> tuple[Expr, Expr] | None:
        """Cosine and sine of a known combination's angle, composed from solved ones; None if unknown."""
        terms = self.known.get(combination)
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

    def represent(
        self, combination: AngleCombination
    ) -> tuple[int, AngleCombination, AngleCombination]:
        """`combination = factor * representative + shift` with a known shift."""
        if combination in self._represented:
            found = self._represented[combination]
            assert found is not None
            return found
        group = self._variables.group_of(combination)
        zero = tuple([0] * self._variables.count)
        result = (1, combination, zero)
        for factor in (1, -1, 2, -2):
            for rep in self._representatives:
                if self._variables.group_of(rep) != group:
                    continue
                shift = tuple(k - factor * r for k, r in zip(combination, rep, strict=True))
                if shift in self.known and rep not in self.known:
                    self._represented[combination] = (factor, rep, shift)
                    return factor, rep, shift
        self._represented[combination] = result
        return result

    def rank(self, combinations: list[AngleCombination]) -> int:
        """Number of independent unknowns among the angles of combinations."""
        if not combinations:
            return 0
        key = frozenset(combinations)
        if key not in self._ranks:
            known = [list(k) for k in self.solved]
            both = np.linalg.matrix_rank(np.array(known + [list(k) for k in combinations]))
            self._ranks[key] = int(both) - self._solved_rank
        return self._ranks[key]
