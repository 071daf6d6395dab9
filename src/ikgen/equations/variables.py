"""Joint variables of a DH chain as atoms of the expression graph.

A revolute variable is the DH angle of the row that its joint turns least; a combination is an integer
combination of such angles, one entry a variable. Angles of parallel consecutive axes share a group:
their sums ("sum of angles") appear as combinations of their own when the matrices are built.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.algebra.polynomial import AngleCombination, canonical
from ikgen.equations.known_combinations import LARGEST
from ikgen.errors import UnsupportedJointError
from ikgen.kinematics.fixed_order import cosines, product, sines
from ikgen.kinematics.rigid import exact_cos_sin
from ikgen.model.angle_function import cosine_and_sine
from ikgen.model.dh import Angle, DHChain, DHRow, Length

__all__ = ["JointVariables", "runs_of"]


def runs_of(dh: DHChain) -> list[int]:
    """Index of the run of parallel axes (twist exactly zero between them) each row belongs to."""
    runs: list[int] = []
    for i, row in enumerate(dh.rows):
        parallel = i > 0 and row.alpha.exact == Fraction(0)
        runs.append(runs[-1] if parallel else (runs[-1] + 1 if runs else 0))
    return runs


@dataclass(frozen=True, slots=True)
class _RowVariable:
    driver: int
    ratio: int
    shift: float


class JointVariables:
    """Atoms for the variables of `dh`, with their values `theta` (probes, dof) at the probes."""

    def __init__(
        self,
        graph: ExpressionGraph,
        dh: DHChain,
        values: NDArray[np.float64],
        kept: Mapping[str, NDArray[np.float64]] = MappingProxyType({}),
    ) -> None:
        self.graph = graph
        self.dh = dh
        self.values = values
        self.kept = kept
        self.count = dh.dof
        self.primary = [dh.lead_row(j) for j in range(dh.dof)]
        self._rows = [self._row_variable(row) for row in dh.rows]
        self.group = self._groups()

    def over(self, graph: ExpressionGraph) -> JointVariables:
        """The same variables as atoms of a graph that has all nodes of this one's."""
        other = copy(self)
        other.graph = graph
        return other

    def _row_variable(self, row: DHRow) -> _RowVariable:
        ratio, shift = self.dh.follows(row)
        if row.revolute and not ratio.is_integer():
            raise UnsupportedJointError(
                f"joint '{row.name}' follows '{self.primary[row.driver].name}' with the ratio {ratio:g}",
                hint="closed forms need mimic ratios of whole numbers; lock one of the two joints",
            )
        return _RowVariable(row.driver, round(ratio) if row.revolute else 1, shift)

    @property
    def largest_factor(self) -> int:
        """The largest factor with which one combination may follow from others: more than the usual one
        where the rows that a joint drives turn faster, together, than twice the one that turns least."""
        turned = [0] * self.count
        for row in self._rows:
            turned[row.driver] += abs(row.ratio)
        return LARGEST if max(turned) <= LARGEST else sum(turned)

    def _groups(self) -> list[int]:
        group = list(range(self.count))
        runs = runs_of(self.dh)
        seen: dict[int, int] = {}
        for row, run in zip(self.dh.rows, runs, strict=True):
            if not row.revolute:
                continue
            if run in seen:
                old, new = group[row.driver], group[seen[run]]
                group = [new if g == old else g for g in group]
            else:
                seen[run] = row.driver
        return group

    def group_of(self, combination: AngleCombination) -> int:
        """The group of parallel axes that the combination's angles belong to."""
        for j, k in enumerate(combination):
            if k:
                return self.group[j]
        return -1

    def unit(self, joint: int) -> AngleCombination:
        """The combination of one joint's own angle."""
        return tuple(int(j == joint) for j in range(self.count))

    def pair(self, combination: AngleCombination) -> tuple[Expr, Expr]:
        """Cosine and sine atoms of a combination's angle."""
        g = self.graph
        combination, sign = canonical(combination)
        if sign == 0:
            return g.one, g.zero
        c, s = g.find_atom("cos", combination), g.find_atom("sin", combination)
        if c is None or s is None:
            angle = product(self.values, np.array(combination, dtype=float))
            c = g.atom("cos", combination, cosines(angle), unknown=True)
            s = g.atom("sin", combination, sines(angle), unknown=True)
        return c, (s if sign > 0 else g.neg(s))

    def rotated(self, combination: AngleCombination, shift: float) -> tuple[Expr, Expr]:
        """Cosine and sine of a combination's angle plus a constant."""
        g = self.graph
        c, s = self.pair(combination)
        kc, ks = (g.const(x) for x in exact_cos_sin(shift))
        return (
            g.sub(g.mul(kc, c), g.mul(ks, s)),
            g.add(g.mul(ks, c), g.mul(kc, s)),
        )

    def row_angle(self, i: int) -> tuple[AngleCombination, float]:
        """AngleCombination and constant of the rotation about z in row i (0-based)."""
        row, var = self.dh.rows[i], self._rows[i]
        if not row.revolute:
            return tuple([0] * self.count), row.theta.value
        return tuple(var.ratio * (j == var.driver) for j in range(self.count)), var.shift

    def distance(self, joint: int) -> Expr:
        """The atom of a prismatic variable."""
        combination = self.unit(joint)
        return self.graph.atom("prismatic", combination, self.values[:, joint], unknown=True)

    def row_distance(self, i: int) -> Expr:
        """The translation along z in row i: the constant d, or the prismatic variable."""
        row, var = self.dh.rows[i], self._rows[i]
        if row.revolute:
            return self.length(row.d)
        g = self.graph
        ratio, _ = self.dh.follows(row)
        return g.add(g.mul(g.const(ratio), self.distance(var.driver)), g.const(var.shift))

    def length(self, length: Length) -> Expr:
        """A constant length as a named parameter."""
        g = self.graph
        if length.name is None:
            return g.const(length.value)
        node = g.param(length.name, length.sign * length.value, self.kept.get(length.name))
        return node if length.sign > 0 else g.neg(node)

    def angle(self, angle: Angle) -> tuple[Expr, Expr]:
        """Cosine and sine of a constant angle; named parameters where the angle is not exact."""
        g = self.graph
        c, s = exact_cos_sin(angle.value)
        if angle.name is None:
            return g.const(c), g.const(s)
        cosine, sine = cosine_and_sine(angle.name)
        probe = self.kept.get(angle.name)
        if probe is None:
            return g.param(cosine, c), g.param(sine, s)
        pairs = np.array([exact_cos_sin(x) for x in probe]).T
        return g.param(cosine, c, pairs[0]), g.param(sine, s, pairs[1])
