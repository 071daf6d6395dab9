"""Formulas are numbered through the whole document, folds included, and links lead to the first one."""

from __future__ import annotations

from ikgen.formulas import mathtext as m
from ikgen.report.document import Fold, Formulas, Heading, Link, Paragraph
from ikgen.report.numbering import numbered

LINE = m.name("x")


def test_numbers_and_links() -> None:
    blocks = numbered([
        Paragraph(("see ", Link("py", "eq-1"), " and ", Link("none", "nowhere"))),
        Formulas((LINE, LINE), ("", "eq-1")),
        Fold("more", (Formulas((LINE,), ("eq-1",)), Paragraph((Link("the arm", "arm"),)))),
        Heading(("Arm",), anchor="arm"),
        Formulas((LINE,)),
    ])  # fmt: skip
    lead, first, fold, _, last = blocks
    assert isinstance(lead, Paragraph) and isinstance(fold, Fold)
    assert lead.text == ("see ", Link("py", "eq-1", 2), " and ", "none")
    assert isinstance(first, Formulas) and first.numbers == (1, 2) and first.anchors == ("", "eq-1")
    inner = fold.blocks[0]
    assert isinstance(inner, Formulas) and inner.numbers == (3,) and inner.anchors == ("",)
    assert fold.blocks[1] == Paragraph((Link("the arm", "arm", 0),))
    assert isinstance(last, Formulas) and last.numbers == (4,)
