"""The scalar equations of a chain that its derivation used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy

from ikgen.equations.equation import Equation
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.symbolic.expression_view import ExpressionView
from ikgen.symbolic.symbol_names import SymbolNames

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["equations", "used_equations"]


def equations(derivation: Derivation) -> tuple[sympy.Eq, ...]:
    """Every matrix equation that the derivation used, in the order of its steps: `left = right` with the
    pose's entries `r_11` ... `p_z` (last DH frame in frame 0) on the left, in rad and m."""
    graph = derivation.graph
    view = ExpressionView(SymbolNames(graph.dh))
    used = used_equations(graph)
    return tuple(sympy.Eq(view(e.left), view(e.right), evaluate=False) for e in used)


def used_equations(graph: SolutionGraph) -> tuple[Equation, ...]:
    """The matrix equations that the steps and their fallbacks come from, each once."""
    candidates = (c for step in graph.steps for c in (step.candidate, *step.fallbacks))
    return tuple(dict.fromkeys(e for c in candidates for e in c.sources))
