"""What each leaf does, in a sentence for the reader of a report."""

from __future__ import annotations

from ikgen.report.document import Block, Paragraph

__all__ = ["leaf_sentence"]

_SENTENCES = {
    "algebraic": "The unknown stands alone in a linear equation: it is the quotient of what is known.",
    "simultaneous": "Two equations that are linear in cosine and sine of the unknown are solved together, "
    "and give one angle.",
    "tangent": "The quotient of two equations leaves the tangent of the unknown; the sign of what was "
    "divided out is not known, so that two angles half a turn apart are left.",
    "sine and cosine": "One equation a cos + b sin = c describes a line that cuts the unit circle in two "
    "points: two angles.",
    "quadratic": "The unknown solves a polynomial of degree two: two roots.",
    "quartic": "Two equations of degree two in cosine and sine meet in up to four points of the unit "
    "circle: up to four angles.",
    "x2y2": "The sum of two or three squared equations drops one unknown; what is left has the form "
    "a cos + b sin = c and two angles.",
}


def leaf_sentence(leaf: str) -> list[Block]:
    """Nothing for a leaf of another package."""
    return [Paragraph((_SENTENCES[leaf],))] if leaf in _SENTENCES else []
