"""What is proved of the derivation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ikgen.errors import MissingToolError
from ikgen.formulas import mathtext as m
from ikgen.report.document import Block, Heading, Inline, Paragraph, Rows, Text

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.symbolic.proof import Proof

__all__ = ["proof_section"]

_EXACT = (
    "Forward kinematics, multiplied out from the table, was put in for the pose. What is left of each "
    "equation is zero exactly, over the rational numbers and modulo ",
    " for every angle, for all values of the lengths. A form is proved once: every branch solves its "
    "equation, and every solution is a branch, where:",
)


def proof_section(derivation: Derivation) -> list[Block]:
    """The proof in words, and the conditions under which each form holds."""
    heading = Heading(("Proof",), anchor="proof")
    try:
        from ikgen.symbolic.proof import prove
    except MissingToolError as error:
        return [heading, Paragraph((f"Not proved: {error.message} ({error.hint}).",))]
    proof = prove(derivation)
    blocks: list[Block] = [heading, Paragraph((f"{_capital(proof.words)}.",))]
    if proof.forms:
        blocks += [Paragraph(_explained()), _forms(proof)]
    blocks += [Paragraph((f"{remark}.",), note=True) for remark in proof.remarks]
    metres, radians = proof.deviation
    if proof.forms and max(metres, radians) > 0.0:
        off = f"it is {metres:.1e} m and {radians:.1e} rad off the file's."
        blocks.append(Paragraph((f"All this is about the exact geometry: {off}",), note=True))
    return blocks


def _capital(words: str) -> str:
    return words[0].upper() + words[1:]


def _explained() -> Text:
    """What was done."""
    one = m.power(m.text("cos"), 2) + m.plus() + m.power(m.text("sin"), 2)
    return _EXACT[0], one + m.relation() + m.name("1"), _EXACT[1]


def _forms(proof: Proof) -> Rows:
    from ikgen.symbolic.condition_notation import condition_notation

    rows = []
    for form in proof.forms:
        conditions: list[Inline] = []
        for condition in form.conditions:
            conditions += [", "] if conditions else []
            conditions.append(condition_notation(condition))
        state = "proved" if form.proved else "not proved"
        rows.append(((form.form,), (state,), tuple(conditions) or ("always",)))
    return Rows((("form",), ("all solutions",), ("where",)), tuple(rows), left=1)
