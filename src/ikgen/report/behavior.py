"""The behaviour tree: its nodes, and what each of them did in every round."""

from __future__ import annotations

from ikgen.formulas.notation import variable
from ikgen.report.document import Block, Heading, Inline, Paragraph, Rows, Text
from ikgen.solver.session import Tick
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["behavior_section"]

_WIDE = 9
"""Rounds in one table."""

_INDENT = "\u2003"
_KINDS = {"sequence": "sequence", "selector": "selector", "or": "OR"}


def behavior_section(graph: SolutionGraph) -> list[Block]:
    """What every node of the tree did in every round."""
    blocks: list[Block] = [
        Heading(("Behaviour tree",)),
        Paragraph((
            "One round solves one unknown: equations with one or two unknowns are collected, every "
            "leaf looks at them, the ranker takes the best candidate; transforms run where no leaf "
            "found a sound one. A sequence stops at its first child that fails, a selector at the "
            "first that succeeds, OR ticks all and succeeds if any does. Numbers are the equations "
            "or candidates that a node gave; – stands for failure, an empty cell for a node that was "
            "not ticked.",
        )),
    ]  # fmt: skip
    rounds = sorted({t.round for t in graph.ticks})
    cells = {(t.path, t.round): _mark(t) for t in graph.ticks}
    kinds = {t.path: t.kind for t in graph.ticks}
    paths = [path for path in graph.outline if path in kinds]
    for start in range(0, len(rounds), _WIDE):
        part = rounds[start : start + _WIDE]
        header: tuple[Text, ...] = (("node",), *((f"round {r}",) for r in part))
        rows = tuple(
            ((_label(path, kinds[path]),), *((cells.get((path, r), ""),) for r in part))
            for path in paths
        )
        blocks.append(Rows(header, rows, small=True, left=1))
    return [*blocks, *_solved(graph)]


def _mark(t: Tick) -> str:
    """The number that a node gave, or whether it succeeded."""
    first = t.detail.split(" ", 1)[0]
    if t.outcome != "success":
        return "–"
    return first if first.isdigit() else "yes"


def _label(path: tuple[str, ...], kind: str) -> str:
    name = path[-1].rpartition(": ")[2]
    words = f"{name} ({_KINDS[kind]})" if kind in _KINDS else name
    return _INDENT * (len(path) - 1) + words


def _solved(graph: SolutionGraph) -> list[Block]:
    """Which unknown each round solved."""
    done = [t.round for t in graph.ticks if t.outcome == "success" and " by " in t.detail]
    rows = []
    for number, step in zip(done, graph.steps, strict=False):
        c = step.candidate
        labels = " and ".join(dict.fromkeys(e.label for e in c.sources))
        what: list[Inline] = [
            variable(c.unknown),
            f" by {c.leaf}" + (f" from {labels}" * bool(labels)),
        ]
        rows.append(((str(number),), tuple(what)))
    if not rows:
        return []
    return [Rows((("round",), ("solved",)), tuple(rows), small=True, left=2)]
