"""The derivation report: how the inverse kinematics was found, as LaTeX and as HTML."""

from __future__ import annotations

from collections.abc import Mapping

from ikgen import __version__
from ikgen.emit.derivation import Derivation, Unsolved
from ikgen.report.document import Block, Heading, Paragraph
from ikgen.report.graph_picture import Drawing
from ikgen.report.html import to_html
from ikgen.report.latex import to_latex
from ikgen.report.numbering import numbered
from ikgen.report.page import SolvedPage, UnsolvedPage
from ikgen.report.sections import SOLVED, UNSOLVED
from ikgen.verify.verification_report import VerificationReport

__all__ = ["emit_report", "emit_unsolved"]


def emit_report(
    derivation: Derivation, reports: Mapping[str, VerificationReport] | None = None
) -> dict[str, str]:
    """File name -> text: `<name>_report.tex`, `<name>_report.html` and, but for an elimination,
    `<name>_graph.svg`.

    `reports` are verifications by language, for the card at the top and a table at the end.
    """
    page = SolvedPage.of(derivation, reports or {})
    blocks = [block for section in SOLVED for block in section(page)]
    module = derivation.module
    return _texts(blocks, page.reading.dh.robot, module.name, module.source_name, page.picture)


def emit_unsolved(found: Unsolved, advice: str = "") -> dict[str, str]:
    """The report's files for an arm without a closed form: what was solved, what is left, how near the
    leaves came, and what would help (`advice`)."""
    page = UnsolvedPage.of(found)
    blocks = [block for section in UNSOLVED for block in section(page)]
    if advice:
        words = f"{advice[0].upper()}{advice[1:]}."
        blocks += [Heading(("What would help",), anchor="help"), Paragraph((words,))]
    return _texts(blocks, page.reading.dh.robot, found.name, found.source_name, page.picture)


def _texts(
    blocks: list[Block], robot: str, name: str, source: str, picture: Drawing | None
) -> dict[str, str]:
    """File name -> text."""
    title = f"Inverse kinematics of {robot}"
    subtitle = f"derived by ikgen {__version__} from {source}"
    whole = numbered(blocks)
    texts = {
        f"{name}_report.tex": to_latex(title, subtitle, whole),
        f"{name}_report.html": to_html(title, subtitle, whole),
    }
    return texts if picture is None else {**texts, f"{name}_graph.svg": picture.svg}
