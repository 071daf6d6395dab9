"""How a derivation went, for -v: every tick of the behavior tree and the ranker's choices."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ikgen.cli.tables import table

if TYPE_CHECKING:
    from ikgen.solver.candidate import Candidate
    from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["derivation_trace"]


def derivation_trace(graph: SolutionGraph) -> str:
    """The rounds of the behavior tree, and each step with its fallbacks and what was rejected."""
    parts = ["behavior tree:"]
    for number in sorted({t.round for t in graph.ticks}):
        parts += [f"round {number}", table(_round(graph, number))]
    parts += ["choices:"] if graph.steps else []
    for step in graph.steps:
        chosen = step.candidate
        parts.append(f"  {chosen.unknown.text}: {chosen.leaf}, {chosen.form.name}{_judged(chosen)}")
        parts += [f"    fallback: {c.leaf}, {c.form.name}{_judged(c)}" for c in step.fallbacks]
        parts += [f"    rejected: {c.leaf}, {c.form.name}{_judged(c)}" for c in step.rejected]
    return "\n".join(parts)


def _round(graph: SolutionGraph, number: int) -> list[tuple[str, ...]]:
    """The nodes that were ticked in one round, indented as in the tree."""
    ticks = {t.path: t for t in graph.ticks if t.round == number}
    rows: list[tuple[str, ...]] = []
    for path in graph.outline:
        if path in ticks:
            t = ticks[path]
            name = "  " * (len(path) - 1) + t.node.rpartition(": ")[2]
            spent = f"{1e3 * t.seconds:.1f} ms" if t.kind == "leaf" else f"({t.kind})"
            rows.append((name, t.outcome, spent, t.detail))
    return rows


def _judged(candidate: Candidate) -> str:
    judgement = candidate.judgement
    if judgement is None:
        return ""
    weak = ", weak" if judgement.weak else ""
    return f" (margin {judgement.margin:.1e}, cost {judgement.cost:g}{weak})"
