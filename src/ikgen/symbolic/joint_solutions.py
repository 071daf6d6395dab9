"""The joint variables of a derivation in closed form, as SymPy expressions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import sympy

from ikgen.equations.angle_lattice import AngleLattice
from ikgen.equations.knowledge import Variable
from ikgen.forms.form import Form
from ikgen.solver.choice import Step
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.symbolic.expression_view import ExpressionView
from ikgen.symbolic.form_branches import alternatives
from ikgen.symbolic.symbol_names import SymbolNames

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["Branch", "graph_solutions", "solutions"]


@dataclass(frozen=True, slots=True)
class Branch:
    """One alternative of a variable: its value (rad or m) in terms of the pose's entries, the arm's
    lengths and variables solved before, and the conditions under which it is one. `index` counts the
    alternatives of the form that it comes from; `fallback`: the form is used where the first one's
    divisor vanishes."""

    variable: sympy.Symbol
    expression: sympy.Expr
    conditions: tuple[sympy.Basic, ...] = ()
    index: int = 0
    fallback: bool = False


def solutions(derivation: Derivation) -> Mapping[str, tuple[Branch, ...]]:
    """Per variable its branches, in the order solved: `theta_1`, `d_3`, sums of parallel joints' angles
    such as `theta_23`, and joints that follow from them. All are DH variables: a joint of the file is
    `(theta - offset) / scale`. Held joints are given, and have no entry; neither has anything where the
    elimination solves the arm.

    A choice of one branch a variable is a solution where its conditions hold and forward kinematics
    gives the pose back.
    """
    return graph_solutions(derivation.graph)


def graph_solutions(graph: SolutionGraph) -> Mapping[str, tuple[Branch, ...]]:
    """`solutions` of a solution graph."""
    return MappingProxyType(
        {branches[0].variable.name: branches for branches in _Reader(graph).read()}
    )


class _Reader:
    """Follows the steps; knows what was solved before each of them."""

    def __init__(self, graph: SolutionGraph) -> None:
        self.graph = graph
        self.names = SymbolNames(graph.dh)
        self.known = graph.workspace()
        self.lattice = AngleLattice(self.known.graph, self.known.variables)
        self.view = ExpressionView(self.names, self._angle)
        self.given: set[Variable] = set()

    def read(self) -> Iterator[tuple[Branch, ...]]:
        """Branches of every variable."""
        for joint in self.graph.held:
            self._learn(self.known.joint_variable(joint))
        yield from self._sums()
        for step in self.graph.steps:
            yield tuple(self._branches(step))
            self._learn(step.candidate.unknown)
            yield from self._sums()

    def _learn(self, variable: Variable) -> None:
        self.given.add(variable)
        if variable.kind == "angle":
            self.lattice.add(variable.combination)
            self.lattice.rebuild()

    def _sums(self) -> Iterator[tuple[Branch, ...]]:
        """Joints that now follow from sums of angles."""
        for joint in range(self.graph.dh.dof):
            variable = self.known.joint_variable(joint)
            if variable.kind == "angle" and variable not in self.given:
                if variable.combination not in self.lattice.known:
                    continue
                self.given.add(variable)
                angle = self._angle(variable.combination)
                yield (Branch(self.names.variable(variable), angle),)

    def _angle(self, combination: tuple[int, ...]) -> sympy.Expr:
        """A known angle as the sum of solved ones."""
        terms = self.lattice.known[combination]
        return sympy.Add(*(k * self.names.variable(Variable("angle", base)) for k, base in terms))

    def _branches(self, step: Step) -> Iterator[Branch]:
        where: tuple[sympy.Basic, ...] = ()
        for position, candidate in enumerate((step.candidate, *step.fallbacks)):
            form = candidate.form
            made = alternatives(form, self._coefficients(form))
            symbol = self.names.variable(candidate.unknown)
            for index, value in enumerate(made.values):
                conditions = (*where, *made.conditions)
                yield Branch(symbol, value, conditions, index, position > 0)
            if made.divisor is not None:
                where = (*where, sympy.Eq(made.divisor, 0))

    def _coefficients(self, form: Form) -> tuple[sympy.Expr, ...]:
        return tuple(sympy.S.Zero if e.vanishes else self.view(e) for e in form.coefficients)
