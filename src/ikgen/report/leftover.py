"""What the solver left: the equations, shortest first, and the leaf that came nearest."""

from __future__ import annotations

from ikgen.equations.knowledge import Variable
from ikgen.formulas.mathtext import relation
from ikgen.formulas.normalizer import Normalizer
from ikgen.formulas.notation import show, variable
from ikgen.report.document import Block, Formulas, Heading, Inline, Paragraph, Rows, Text
from ikgen.report.plain import plain
from ikgen.report.splits import place
from ikgen.solver.remainder import NearMiss, OpenEquation, count_open, near_misses, open_equations
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["leftover_section", "leftover_text"]

_IN_TEXT, _IN_REPORT, _NEAR = 3, 10, 4
_LONGEST = 40
"""Symbols above which an equation is no longer shown in a terminal."""


def _left(graph: SolutionGraph, normal: Normalizer) -> list[OpenEquation]:
    return open_equations(graph, lambda side: normal(side).weight)


def leftover_text(graph: SolutionGraph) -> list[str]:
    """Lines for a terminal."""
    normal = Normalizer()
    left = _left(graph, normal)
    if not left:
        return ["no equation that the task reads holds them"]
    lines = [
        f"{count_open(graph)} equations are left; the shortest with the fewest unknowns (c, s: cosines and "
        "sines; r, p: the pose):"
    ]
    for o in [o for o in left if o.size <= _LONGEST][:_IN_TEXT] or left[:1]:
        e = o.equation
        lines.append(f"  {e.label}: {plain(normal(e.left))} = {plain(normal(e.right))}")
    near = near_misses(left)[0]
    lacking = " and ".join(v.text for v in near.lacking)
    label = near.source.equation.label
    lines.append(
        f"nearest: {near.leaf} for {near.unknown.text} from {label}, " + _lack(lacking, near, left)
    )
    return lines


def _lack(lacking: str, near: NearMiss, left: list[OpenEquation]) -> str:
    """What the nearest leaf lacked, in words."""
    if not near.lacking:
        return "whose solution fails at the configurations tried"
    alike = sum(set(o.unknowns) <= {near.unknown, *near.lacking} for o in left)
    more = f" ({alike} equations hold no others)" if alike > 1 else ""
    return f"which lacks {lacking}{more}"


def leftover_section(graph: SolutionGraph) -> list[Block]:
    """The section of an unsolved arm."""
    normal = Normalizer()
    left = _left(graph, normal)
    names = [graph.joint_variable(j) for j in graph.open_joints]
    lead: list[Inline] = ["No closed form was found for ", *_listed(names), ". "]
    blocks: list[Block] = [Heading(("What is left",), anchor="left")]
    if not left:
        lead.append("No equation that the task reads holds them.")
        return [*blocks, Paragraph(tuple(lead))]
    lead.append(
        f"{count_open(graph)} equations hold unknowns still. Shortest with the fewest unknowns:"
    )
    blocks.append(Paragraph(tuple(lead)))
    for o in left[:_IN_REPORT]:
        e = o.equation
        words: Text = (f"S{place(e)[1:]}, in ", *_listed(o.unknowns), ":")
        line = show(normal(e.left)) + relation() + show(normal(e.right))
        blocks += [Paragraph(words), Formulas((line,))]
    return [*blocks, *_nearest(left)]


def _listed(variables: list[Variable] | tuple[Variable, ...]) -> list[Inline]:
    out: list[Inline] = []
    for i, v in enumerate(variables):
        joint = " and " if i == len(variables) - 1 else ", "
        out += [joint if i else "", variable(v)]
    return out


def _nearest(left: list[OpenEquation]) -> list[Block]:
    """The leaves that came nearest: for which unknown, and what they lacked."""
    rows: list[tuple[Text, ...]] = []
    seen: set[tuple[Variable, str]] = set()
    for near in near_misses(left):
        if (near.unknown, near.leaf) not in seen and len(rows) < _NEAR:
            seen.add((near.unknown, near.leaf))
            lacking: Text = tuple(_listed(near.lacking)) or ("a solution that reproduces the pose",)
            label = near.source.equation.label
            rows.append(((variable(near.unknown),), (near.leaf,), (label,), lacking))
    header: tuple[Text, ...] = (("unknown",), ("leaf",), ("equation",), ("what it lacks",))
    return [Rows(header, tuple(rows), "The leaves that came nearest")]
