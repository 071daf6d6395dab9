"""The behavior tree: its nodes, and what each of them did in every round."""

from __future__ import annotations

from html import escape

from ikgen.formulas.notation import variable
from ikgen.report.document import Block, Heading, Inline, Paragraph, Picture, Rows, Text
from ikgen.report.latex import rows_latex
from ikgen.report.tree_picture import mark, tree_picture
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["behavior_section"]

_WIDE = 9
"""Rounds in one table."""

_INDENT = "\u2003"
_KINDS = {"sequence": "sequence", "selector": "selector", "or": "OR"}


def behavior_section(graph: SolutionGraph) -> list[Block]:
    """What every node of the tree did in every round: a picture, on paper a table."""
    blocks: list[Block] = [
        Heading(("Behavior tree",), anchor="tree"),
        Paragraph((
            "One round solves one unknown: equations with one or two unknowns are collected, every "
            "leaf looks at them, the ranker takes the best candidate; transforms run where no leaf "
            "found a sound one. A sequence (→) stops at its first child that fails, a selector (?) at "
            "the first that succeeds, OR (∨) ticks all and succeeds if any does. Numbers are the "
            "equations or candidates that a node gave; – stands for failure, a node that is not lit "
            "was not ticked or failed.",
        )),
    ]  # fmt: skip
    if not graph.ticks:
        return []
    kinds = {t.path: t.kind for t in graph.ticks}
    nodes = [path for path in graph.outline if any(p[: len(path)] == path for p in kinds)]
    picture = tree_picture(nodes, graph.ticks, _told(graph))
    return [*blocks, Picture(picture, "\n\n".join(map(rows_latex, _tables(graph))))]


def _tables(graph: SolutionGraph) -> list[Rows]:
    """The picture's content as tables of at most `_WIDE` rounds."""
    rounds = sorted({t.round for t in graph.ticks})
    cells = {(t.path, t.round): mark(t) for t in graph.ticks}
    kinds = {t.path: t.kind for t in graph.ticks}
    paths = [path for path in graph.outline if path in kinds]
    tables = []
    for start in range(0, len(rounds), _WIDE):
        part = rounds[start : start + _WIDE]
        header: tuple[Text, ...] = (("node",), *((f"round {r}",) for r in part))
        rows = tuple(
            ((_label(path, kinds[path]),), *((cells.get((path, r), ""),) for r in part))
            for path in paths
        )
        tables.append(Rows(header, rows, small=True, left=1))
    return tables + _solved(graph)


def _label(path: tuple[str, ...], kind: str) -> str:
    name = path[-1].rpartition(": ")[2]
    words = f"{name} ({_KINDS[kind]})" if kind in _KINDS else name
    return _INDENT * (len(path) - 1) + words


def _told(graph: SolutionGraph) -> dict[int, str]:
    """HTML per round: what it solved, and how."""
    out = {}
    for step in graph.steps:
        c = step.candidate
        labels = " and ".join(dict.fromkeys(e.label for e in c.sources))
        name = f"<math><mrow>{variable(c.unknown).mathml}</mrow></math>"
        out[step.round] = f"{name} by {escape(c.leaf)}" + (f" from {escape(labels)}" * bool(labels))
    return out


def _solved(graph: SolutionGraph) -> list[Rows]:
    """Which unknown each round solved."""
    rows = []
    for step in graph.steps:
        c = step.candidate
        labels = " and ".join(dict.fromkeys(e.label for e in c.sources))
        what: list[Inline] = [
            variable(c.unknown),
            f" by {c.leaf}" + (f" from {labels}" * bool(labels)),
        ]
        rows.append(((str(step.round),), tuple(what)))
    if not rows:
        return []
    return [Rows((("round",), ("solved",)), tuple(rows), small=True, left=2)]
