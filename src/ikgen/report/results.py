"""The report's end: solution graph, pose sets and verification."""

from __future__ import annotations

from collections.abc import Mapping

from ikgen.equations.knowledge import Variable
from ikgen.formulas import mathtext as m
from ikgen.formulas.notation import variable
from ikgen.report.document import (
    Block,
    Formulas,
    Heading,
    Inline,
    Paragraph,
    Picture,
    Rows,
    Text,
)
from ikgen.report.graph_picture import Drawing
from ikgen.report.solution_sets import Versions
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.verify.verification_report import VerificationReport

__all__ = ["graph_section", "poses_section", "verification_section"]

_MOST_SETS = 64


def graph_section(
    versions: Versions, drawing: Drawing, passed: tuple[Variable, ...]
) -> list[Block]:
    """The drawing, and the direct parents in words."""
    text: list[Inline] = [
        "An arrow leads from an unknown to those that are computed from it; what it leads to by way "
        "of another unknown has no arrow of its own. Boxes name the leaf that solved the unknown and lead "
        "to its step; ×2 stands below an unknown with two branches. "
    ]
    several = [
        (v, above) for v, above in versions.parents.items() if len(above) > 1 and v not in passed
    ]
    for v, above in several:
        text += [variable(v), " has the parents "]
        for i, p in enumerate(above):
            text += [" and " if i else "", variable(p)]
        text.append(". ")
    for v in passed:
        text += [variable(v), " is computed on the way and brings no branch of its own. "]
    return [
        Heading(("Solution graph",), anchor="graph"),
        Paragraph(tuple(text)),
        Picture(drawing.svg, drawing.latex, "Solution graph"),
    ]


def poses_section(graph: SolutionGraph, versions: Versions) -> list[Block]:
    """The sets of versions that make whole solutions."""
    joints = [graph.joint_variable(j) for j in range(graph.dh.dof)]
    known = [v for v in joints if v in versions.within]
    lead = (
        f"{versions.poses} solutions of the whole arm, one a choice of branches; "
        "a branch whose guard fails drops out."
    )
    blocks: list[Block] = [
        Heading(("Sets of joint solutions",), anchor="sets"),
        Paragraph((lead,)),
    ]
    if versions.poses <= _MOST_SETS:
        lines = []
        for i, chosen in enumerate(versions.sets(), start=1):
            inside = m.join([variable(v, versions.label(v, chosen)) for v in known], m.comma())
            lines.append(m.text(f"Solution {i}: ") + m.space() + m.group(inside, "[]"))
        blocks.append(Formulas(tuple(lines)))
    return blocks


def verification_section(reports: Mapping[str, VerificationReport]) -> list[Block]:
    """The checks of the emitted code."""
    blocks: list[Block] = []
    for name, report in reports.items():
        rows = tuple(tuple((cell,) for cell in row) for row in report.table())
        header: tuple[Text, ...] = (
            ("check",),
            ("result",),
            ("checked",),
            ("largest deviations",),
            ("detail",),
        )
        blocks += [
            Rows(
                header,
                rows,
                f"{name}: {report.samples} random poses, seed {report.seed}",
                small=True,
            )
        ]
    return [Heading(("Verification",), anchor="verification"), *blocks] if blocks else []
