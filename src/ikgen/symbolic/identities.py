"""Proof that equations are identities of the forward kinematics, in exact arithmetic."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ikgen.algebra.expression import Expr
from ikgen.solver.candidate import Candidate
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.symbolic.exact_kinematics import ExactKinematics
from ikgen.symbolic.matrix_equations import used_equations

__all__ = ["Identity", "prove_identities"]

_ROUNDED = 1e-12
"""What rounded constants leave of an identity, in units of about the arm's size."""


@dataclass(frozen=True, slots=True)
class Identity:
    """An equation and what came of its proof: `proved`, or the `reason` why not; `wrong` where it is no
    identity whatever the constants. `label` says where it comes from."""

    label: str
    proved: bool
    reason: str = ""
    wrong: bool = False


def prove_identities(graph: SolutionGraph) -> tuple[tuple[Identity, ...], tuple[Identity, ...]]:
    """Proofs of every matrix equation that the derivation used, and of every equation in the unknown
    alone that a form solves: with its coefficients it vanishes for every pose that the arm has."""
    work = graph.workspace()
    exact = ExactKinematics(graph.dh, tool_on_right=work.equations.tool_on_right)
    g = work.graph
    matrix = tuple(
        _identity(exact, e.label, [g.sub(e.left, e.right)]) for e in used_equations(graph)
    )
    patterns = []
    for c in _candidates(graph):
        v = c.unknown
        if v.kind == "angle":
            unknown: tuple[Expr, ...] = work.variables.pair(v.combination)
        else:
            assert v.joint is not None
            unknown = (work.variables.distance(v.joint),)
        label = f"{v.text}: {c.leaf}"
        patterns.append(_identity(exact, label, c.form.pattern(g, unknown)))
    return matrix, tuple(patterns)


def _candidates(graph: SolutionGraph) -> Iterable[Candidate]:
    return (c for step in graph.steps for c in (step.candidate, *step.fallbacks))


def _identity(exact: ExactKinematics, label: str, roots: Iterable[Expr]) -> Identity:
    """Whether all of the expressions vanish."""
    roots = tuple(roots)
    if not roots:
        return Identity(label, False, "the form does not say which equation it solves")
    try:
        left = [exact(e)[0] for e in roots]
    except NotImplementedError as error:
        return Identity(label, False, str(error))
    if not any(left):
        return Identity(label, True)
    rest = max(exact.ring.size(p) for p in left)
    if exact.ring.inexact and rest < _ROUNDED:
        example = min(exact.ring.inexact, key=repr)
        why = f"constants such as {example!r} are known to 16 digits only; it holds to {rest:.0e}"
        return Identity(label, False, why)
    return Identity(label, False, f"its sides differ, by {rest:.2g} somewhere", wrong=True)
