"""The document as LaTeX for pdflatex: only packages of a basic installation."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence

from ikgen.emit.rendering import render
from ikgen.report.document import (
    Block,
    Card,
    Fold,
    Formulas,
    Heading,
    Inline,
    Link,
    Matrix,
    Paragraph,
    Picture,
    Pictures,
    Rows,
    Text,
)

__all__ = ["rows_latex", "to_latex"]

_ESCAPES = {
    "\\": "\\textbackslash{}", "&": "\\&", "%": "\\%", "$": "\\$", "#": "\\#", "_": "\\_",
    "{": "\\{", "}": "\\}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}", "–": "--",
    "°": "\\ensuremath{^\\circ}", "±": "\\ensuremath{\\pm}",
    "·": "\\ensuremath{\\cdot}", "×": "\\ensuremath{\\times}", "−": "\\ensuremath{-}",
    "θ": "\\ensuremath{\\theta}", "α": "\\ensuremath{\\alpha}", "σ": "\\ensuremath{\\sigma}",
    "π": "\\ensuremath{\\pi}", "≤": "\\ensuremath{\\leq}", "≥": "\\ensuremath{\\geq}",
    "<": "\\textless{}", ">": "\\textgreater{}", "|": "\\textbar{}", "`": "{}`",
    "\u2003": "\\quad{}", "-": "-{}",
}  # fmt: skip
"""What the font of a basic installation (OT1) shows as another character, alone or next to its like."""

_LETTERS = "ßæÆœŒøØåÅłŁı"
_ACCENTS = "\u0300\u0301\u0302\u0303\u0304\u0306\u0307\u0308\u030a\u030b\u030c\u0327"
"""Beyond ASCII the font has these letters, and can put these accents on others."""


_CENTRED, _WRAPPED = 24, 60
"""Characters up to which a column is centred, and from which on its text wraps."""


def to_latex(title: str, subtitle: str, blocks: list[Block]) -> str:
    """The text of the .tex file."""
    body = "\n\n".join(_block(b) for b in blocks)
    return render(
        "report", "report.tex.jinja", title=_words(title), subtitle=_words(subtitle), body=body
    )


def _words(text: str) -> str:
    out = "".join(_ESCAPES.get(ch) or (ch if _in_font(ch) else "?") for ch in text)
    return re.sub("'(?=')", "'{}", out)  # two of them would join to one quotation mark


def _in_font(ch: str) -> bool:
    if ch.isascii():
        return ch.isprintable() or ch.isspace()
    parts = unicodedata.normalize("NFD", ch)
    accented = ch < "\u0180" and len(parts) == 2 and parts[0].isascii() and parts[1] in _ACCENTS
    return ch in _LETTERS or accented


def _inline(part: Inline) -> str:
    if isinstance(part, str):
        return _words(part)
    if isinstance(part, Link):
        return f"\\hyperlink{{{part.anchor}}}{{{_words(part.words)}}}"
    return f"${part.latex}$"


def _text(text: Text) -> str:
    return "".join(map(_inline, text))


def _block(block: Block) -> str:
    match block:
        case Heading(title, level, anchor):
            place = f"\\hypertarget{{{anchor}}}{{}}" if anchor else ""
            plain = _words("".join(p if isinstance(p, str) else "" for p in title)).strip(" :")
            kind = "section" if level == 1 else "subsection"
            mark = f"\\pdfbookmark[{level}]{{{plain}}}{{{anchor}}}" if anchor else ""
            return f"{mark}\\{kind}*{{{place}{_text(title)}}}"
        case Paragraph(text, note):
            if note:
                return f"{{\\small\\itshape {_text(text)}\\par}}"
            keep = "\\nopagebreak" if str(text[-1]).endswith(":") else ""
            return f"{_text(text)}\\par{keep}"
        case Formulas():
            return _formulas(block)
        case Matrix(name, rows):
            inside = " \\\\\n".join(" & ".join(x.latex for x in row) for row in rows)
            columns = "c" * len(rows[0])
            array = f"\\begin{{array}}{{{columns}}}\n{inside}\n\\end{{array}}"
            return f"\\[ {name.latex} = \\left[{array}\\right] \\]"
        case Rows():
            return rows_latex(block)
        case _:
            return _arranged(block)


def _arranged(block: Picture | Pictures | Card | Fold) -> str:
    """Blocks that hold others."""
    match block:
        case Picture():
            return _picture(block)
        case Pictures(drawings):
            return _side_by_side(drawings)
        case Card(picture, facts):
            rows = [f"\\textcolor{{soft}}{{{_words(n)}}} & {_text(t)} \\\\" for n, t in facts]
            inside = "\n".join(rows)
            width = "\\setlength{\\wide}{0.7\\linewidth}"
            columns = ">{\\raggedright}p{0.22\\linewidth}L"
            table = f"\\begin{{tabular}}{{{columns}}}\n{inside}\n\\end{{tabular}}"
            return f"{_picture(picture)}{{{width}{table}}}"
        case Fold(words, inner):
            lead = f"{{\\small\\color{{soft}} {_words(words)}\\par}}\\nopagebreak"
            return "\n\n".join([lead, *map(_block, inner)])


def _picture(picture: Picture) -> str:
    if not picture.latex:
        return ""
    below = f"\\smallskip{{\\small {_words(picture.caption)}}}" if picture.caption else ""
    return f"\\begin{{center}}\n{picture.latex}\n\n{below}\n\\end{{center}}"


def _side_by_side(drawings: Sequence[Picture]) -> str:
    """Small drawings, four in a line, what they show below each."""
    cells = [
        f"\\begin{{minipage}}[t]{{0.24\\linewidth}}\\centering\n{one.latex}\\par\n"
        f"{{\\footnotesize {_words(one.caption)}\\par}}\\end{{minipage}}"
        for one in drawings
        if one.latex
    ]
    lines = [cells[i : i + 4] for i in range(0, len(cells), 4)]
    return "\n\n".join("\\hfill\n".join(line) + "\\hfill\\null\\medskip" for line in lines)


def _formulas(block: Formulas) -> str:
    lines = []
    for i, line in enumerate(block.lines):
        number = str(block.numbers[i]) if block.numbers else ""
        anchor = block.anchors[i] if block.anchors else ""
        place = f"\\hypertarget{{{anchor}}}{{}}" if anchor else ""
        lines.append(f"{place}\\formula{{{number}}}{{{line.latex}}}")
    inside = "\n".join(lines)
    return f"\\begin{{formulas}}\n{inside}\n\\end{{formulas}}"


def rows_latex(block: Rows) -> str:
    """A table that fits the line."""
    wide = [
        max((_width(row[i]) for row in block.rows), default=0) for i in range(len(block.header))
    ]
    columns = "".join(
        "L" if w > _WRAPPED else "l" if w > _CENTRED or i < block.left else "c"
        for i, w in enumerate(wide)
    )
    count = columns.count("L")
    size = f"\\setlength{{\\wide}}{{{0.5 / count if count else 0.2:.2f}\\linewidth}}"
    head = " & ".join(f"\\textbf{{{_text(h)}}}" for h in block.header)
    lines = [" & ".join(_text(cell) for cell in row) + " \\\\" for row in block.rows]
    tall = len(lines) > 30
    name = "longtable" if tall else "tabular"
    font = "\\footnotesize" if block.small else ""
    caption = (
        f"{{\\small {_words(block.caption)}\\par}}\\nopagebreak\\smallskip\n"
        if block.caption
        else ""
    )
    inside = "\n".join([f"\\toprule {head} \\\\ \\midrule", *lines, "\\bottomrule"])
    table = f"\\begin{{{name}}}{{{columns}}}\n{inside}\n\\end{{{name}}}"
    if not tall:
        table = f"\\fitted{{{table}}}"
    begin, end = ("", "") if tall else ("\\begin{center}", "\\end{center}")
    return f"{{{size}{font}{begin}\n{caption}{table}\n{end}}}"


def _width(text: Text) -> int:
    return sum(map(_size, text))


def _size(part: Inline) -> int:
    if isinstance(part, Link):
        return len(part.words)
    return len(part) if isinstance(part, str) else 2 * len(part.tokens)
