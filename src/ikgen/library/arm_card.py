"""An arm as a card of HTML: its skeleton, its DH table, how many solutions it has."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from ikgen.library.dh_text import row_texts
from ikgen.model.counted import counted
from ikgen.report.skeleton import Style, skeleton_svg
from ikgen.report.worked_example import shown_configuration

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.model.dh import DHChain
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["card"]

_HEADS = ("", "joint", "&alpha;", "a", "&theta;", "d")


def card(derivation: Derivation, report: VerificationReport | None) -> str:
    """What a notebook shows of an arm: one element that stands alone, colours the page's own."""
    dh, module = derivation.reading.dh, derivation.module
    title = f"{dh.robot}, {dh.base_link} &rarr; {dh.tip_link}"
    lines = [
        f"{derivation.geometry.words}",
        f"task: {derivation.task.words}" + _held(dh),
        f"at most {counted(module.max_solutions, 'solution')}; {_checked(report)}",
    ]
    picture = skeleton_svg(dh, shown_configuration(dh), style=Style(300.0, 260.0, named=False))
    facts = "".join(f"<div>{escape(line)}</div>" for line in lines)
    return (
        '<div class="ikgen-arm" style="display:flex;flex-wrap:wrap;gap:1.5em;align-items:center">'
        f"<div>{picture}</div><div><b>{_ends(title)}</b>{facts}{_table(dh)}</div></div>"
    )


def _ends(title: str) -> str:
    return "&rarr;".join(escape(part) for part in title.split("&rarr;"))


def _held(dh: DHChain) -> str:
    return f"; held: {', '.join(dh.free)}" if dh.free else ""


def _checked(report: VerificationReport | None) -> str:
    if report is None:
        return "not verified"
    metres, radians = report.worst_closure
    closure = f"worst closure {metres:.0e} m, {radians:.0e} rad"
    return f"verified on {report.samples} poses: {closure}, {report.missed_words}"


def _table(dh: DHChain) -> str:
    """The modified DH rows, and the values of their constants."""
    cell = 'style="padding:0 .6em;text-align:left"'
    head = "".join(f"<th {cell}>{text}</th>" for text in _HEADS)
    rows = "".join(
        "<tr>" + "".join(f"<td {cell}>{escape(text)}</td>" for text in row) + "</tr>"
        for row in row_texts(dh)
    )
    values = ", ".join(f"{name} = {value:.6g}" for name, value in dh.named_constants().items())
    return (
        f'<table style="margin:.5em 0"><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>'
        f"<small>{escape(values)}</small>"
    )
