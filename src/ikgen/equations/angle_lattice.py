"""The lattice of known angle combinations: the integer combinations of solved ones, group by group."""

from __future__ import annotations

from collections.abc import Iterable
from copy import copy

import numpy as np

from ikgen.algebra.angle_sums import angle_sum
from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.algebra.polynomial import AngleCombination
from ikgen.equations.known_combinations import LARGEST, KnownCombinations
from ikgen.equations.variables import JointVariables

__all__ = ["AngleLattice"]


class AngleLattice:
    """`solved` maps the combinations that were solved to cosine and sine, `known` every combination
    that follows from them to its (factor, solved combination) pairs."""

    def __init__(self, graph: ExpressionGraph, variables: JointVariables) -> None:
        self._graph = graph
        self._variables = variables
        self.solved: dict[AngleCombination, tuple[Expr, Expr]] = {}
        self.known = self._following(())
        self._representatives = self._contiguous_keys()
        self._represented: dict[
            AngleCombination, tuple[int, AngleCombination, AngleCombination]
        ] = {}
        self._ranks: dict[frozenset[AngleCombination], int] = {}
        self._parts: dict[AngleCombination, bool] = {}
        self._solved_rank = 0

    def over(self, graph: ExpressionGraph, variables: JointVariables) -> AngleLattice:
        """The same lattice over a graph that has all nodes of this one's."""
        other = copy(self)
        other._graph, other._variables = graph, variables
        other.solved = dict(self.solved)
        other._represented, other._ranks = dict(self._represented), dict(self._ranks)
        other._parts = dict(self._parts)
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
        self._parts.clear()
        known = [list(k) for k in self.solved]
        self._solved_rank = int(np.linalg.matrix_rank(np.array(known))) if known else 0
        self.known = self._following(self.solved)

    def _following(self, solved: Iterable[AngleCombination]) -> KnownCombinations:
        variables = self._variables
        return KnownCombinations(solved, tuple(variables.group), variables.largest_factor)

    def pair(self, combination: AngleCombination) -> tuple[Expr, Expr] | None:
        """Cosine and sine of a known combination's angle, composed from solved ones; None if unknown."""
        terms = self.known.get(combination)
        if terms is None:
            return None
        g = self._graph
        found = g.one, g.zero
        for factor, base in terms:
            c, s = self.solved[base]
            turn = c, (g.neg(s) if factor < 0 else s)
            # one after the other while there are two at most, else by doubling
            left = abs(factor)
            while left:
                if left % 2 or left == 2:
                    found = angle_sum(g, found, turn)
                    left -= 1
                else:
                    turn, left = angle_sum(g, turn, turn), left // 2
        return found

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
        times = int(np.gcd.reduce(combination))
        if times > 1 and self._variables.largest_factor > LARGEST:
            # a multiple as gears make it: of the unknown itself, however it could be written with others
            rep = tuple(k // times for k in combination)
            if rep in self._representatives and rep not in self.known:
                self._represented[combination] = (times, rep, zero)
                return times, rep, zero
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

    def leaves_parts(self, combination: AngleCombination) -> bool:
        """Whether with this one solved too a joint's angle would follow but for whole parts of a turn: no
        equation has an unknown then, and yet several values are left, as 5u and 4u + v leave of u."""
        if combination not in self._parts:
            solved = [*self.solved, combination]
            following = self._following(solved)
            rank = np.linalg.matrix_rank(np.array(solved))
            self._parts[combination] = any(
                unit not in following and np.linalg.matrix_rank(np.array([*solved, unit])) == rank
                for unit in map(self._variables.unit, range(self._variables.count))
            )
        return self._parts[combination]

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
