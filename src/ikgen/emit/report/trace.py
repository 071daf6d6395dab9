"""The report's end: pose sets, the behaviour tree's rounds, and verification."""

from __future__ import annotations

from collections.abc import Mapping

from ikgen.emit.report import mathtext as m
from ikgen.emit.report.document import (
    Block,
    Formulas,
    Heading,
    Inline,
    Paragraph,
    Picture,
    Rows,
    Text,
)
from ikgen.emit.report.notation import variable
from ikgen.emit.report.picture import Drawing
from ikgen.emit.report.poses import Versions
from ikgen.pipeline import Derivation
from ikgen.solver.graph import SolutionGraph
from ikgen.verify.report import VerificationReport

__all__ = ["graph_section", "poses_section", "trace_section", "verification_section"]

_MOST_SETS = 64
_WIDE = 9


def graph_section(versions: Versions, drawing: Drawing) -> list[Block]:
    """The drawing, and the direct parents in words."""
    text: list[Inline] = [
        "An arrow leads from an unknown to those that are computed from it directly. "
    ]
    several = [(v, above) for v, above in versions.parents.items() if len(above) > 1]
    for v, above in several:
        text += [variable(v), " has the parents "]
        for i, p in enumerate(above):
            text += [" and " if i else "", variable(p)]
        text.append(". ")
    return [
        Heading(("Solution graph",)),
        Paragraph(tuple(text)),
        Picture(drawing.svg, drawing.latex, "Solution graph"),
    ]


def poses_section(derivation: Derivation, versions: Versions) -> list[Block]:
    """The sets of versions that make whole solutions."""
    session = derivation.graph.session
    joints = [session.joint_variable(j) for j in range(session.system.dh.dof)]
    known = [v for v in joints if v in versions.within]
    lead = (
        f"{versions.poses} sets of versions, one a choice of branches; "
        "a branch whose guard fails drops out."
    )
    blocks: list[Block] = [Heading(("Sets of joint solutions",)), Paragraph((lead,))]
    if versions.poses <= _MOST_SETS:
        lines = []
        for i, chosen in enumerate(versions.sets(), start=1):
            inside = m.join([variable(v, versions.label(v, chosen)) for v in known], m.comma())
            lines.append(m.text(f"Pose {i}: ") + m.space() + m.group(inside, "[]"))
        blocks.append(Formulas(tuple(lines)))
    return blocks


def trace_section(graph: SolutionGraph) -> list[Block]:
    """What every node of the tree did in every round."""
    rounds = sorted({t.round for t in graph.ticks})
    nodes = list(dict.fromkeys(t.node for t in graph.ticks))
    cells: dict[tuple[str, int], list[str]] = {}
    solved: dict[int, str] = {}
    for t in graph.ticks:
        first = t.detail.split(" ", 1)[0]
        mark = (
            first
            if t.outcome == "success" and first.isdigit()
            else ("yes" if t.outcome == "success" else "–")
        )
        cells.setdefault((t.node, t.round), []).append(mark)
        if t.outcome == "success" and " by " in t.detail:
            solved[t.round] = t.detail
    blocks: list[Block] = [
        Heading(("Behaviour tree",)),
        Paragraph((
            "One round solves one unknown: equations with one or two unknowns are collected, every "
            "leaf looks at them, the ranker takes the best candidate; transforms run where no leaf "
            "found a sound one. Cells: how many equations or candidates a node gave; – for "
            "failure; two marks where it ran twice in the round.",
        )),
    ]  # fmt: skip
    for start in range(0, len(rounds), _WIDE):
        part = rounds[start : start + _WIDE]
        header: tuple[Text, ...] = (("node",), *((f"round {r}",) for r in part))
        rows = tuple(
            ((node,), *((" ".join(cells.get((node, r), [])),) for r in part)) for node in nodes
        )
        blocks.append(Rows(header, rows, small=True))
    outcome: tuple[tuple[Text, ...], ...] = tuple(
        ((str(r),), (solved[r],)) for r in rounds if r in solved
    )
    if not outcome:
        return blocks
    return [*blocks, Rows((("round",), ("solved",)), outcome, small=True)]


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
    return [Heading(("Verification",)), *blocks] if blocks else []
