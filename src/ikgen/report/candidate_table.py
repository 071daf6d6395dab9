"""The candidates for an unknown: the one chosen, and why each of the others lost."""

from __future__ import annotations

from ikgen.report.document import Block, Fold, Inline, Link, Rows, Text
from ikgen.report.splits import equation_anchor
from ikgen.solver.candidate import Candidate
from ikgen.solver.choice import Step
from ikgen.solver.ranker import why_not

__all__ = ["candidates_table"]

_HEADER: tuple[Text, ...] = (
    ("leaf",),
    ("equations",),
    ("branches",),
    ("least divisor",),
    ("cost",),
    ("judgement",),
)


def candidates_table(step: Step) -> list[Block]:
    """A table, where there was a choice."""
    others = [c for c in step.rejected if c.judgement is not None and c not in step.fallbacks]
    if not others or step.candidate.judgement is None:
        return []
    rows = [_row(step.candidate, "chosen")]
    rows += [_row(c, why_not(c, step.candidate)) for c in others]
    words = f"{len(rows)} candidates, and why this one was taken"
    return [Fold(words, (Rows(_HEADER, tuple(rows), "Candidates", small=True),))]


def _row(c: Candidate, verdict: str) -> tuple[Text, ...]:
    assert c.judgement is not None
    labels: list[Inline] = []
    for label, e in {e.label: e for e in c.sources}.items():
        labels += [", "] * bool(labels) + [Link(label, equation_anchor(e))]
    margin, cost = f"{c.judgement.margin:.1e}", f"{c.judgement.cost:g}"
    return (c.leaf,), tuple(labels), (str(c.branches),), (margin,), (cost,), (verdict,)
