"""What a leaf does, in a sentence for the reader of a report."""

from __future__ import annotations

from ikgen.report.document import Block, Paragraph
from ikgen.solver.leaves import all_leaves

__all__ = ["leaf_sentence"]


def leaf_sentence(name: str) -> list[Block]:
    """On candidates of this name; nothing where their leaf, of another package, has no sentence."""
    sentences = [leaf.finds[name] for leaf in all_leaves() if name in leaf.finds]
    return [Paragraph((sentence,)) for sentence in sentences]
