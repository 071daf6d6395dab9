"""The document as one HTML file with MathML: no scripts, no fonts, nothing to fetch."""

from __future__ import annotations

from html import escape

from ikgen.emit.rendering import render
from ikgen.formulas.mathtext import Math
from ikgen.report.document import (
    Block,
    Formulas,
    Heading,
    Matrix,
    Paragraph,
    Picture,
    Rows,
    Text,
)

__all__ = ["to_html"]


def to_html(title: str, subtitle: str, blocks: list[Block]) -> str:
    """The text of the .html file."""
    body = "\n".join(_block(b) for b in blocks)
    return render(
        "report", "report.html.jinja", title=escape(title), subtitle=escape(subtitle), body=body
    )


def _math(formula: Math) -> str:
    """The formula in pieces, so that a long one wraps between them."""
    pieces = [f"<math><mrow>{chunk}</mrow></math>" for chunk in formula.chunks]
    return "<wbr>".join(pieces)


def _text(text: Text) -> str:
    return "".join(escape(p) if isinstance(p, str) else _math(p) for p in text)


def _block(block: Block) -> str:
    match block:
        case Heading(title, level):
            return f"<h{level + 1}>{_text(title)}</h{level + 1}>"
        case Paragraph(text, note):
            return f'<p class="note">{_text(text)}</p>' if note else f"<p>{_text(text)}</p>"
        case Formulas(lines):
            inside = "\n".join(f"<div>{_math(line)}</div>" for line in lines)
            return f'<div class="formulas">\n{inside}\n</div>'
        case Matrix(name, rows):
            cells = "".join(
                "<mtr>" + "".join(f"<mtd>{x.mathml}</mtd>" for x in row) + "</mtr>" for row in rows
            )
            return (
                f'<div class="matrix"><math display="block"><mrow>{name.mathml}<mo>=</mo>'
                f"<mo>[</mo><mtable>{cells}</mtable><mo>]</mo></mrow></math></div>"
            )
        case Rows():
            return _rows(block)
        case Picture(svg, _, caption):
            return f"<figure>{svg}<figcaption>{escape(caption)}</figcaption></figure>"


def _rows(block: Rows) -> str:
    head = "".join(f"<th>{_text(h)}</th>" for h in block.header)
    lines = "\n".join(
        "<tr>" + "".join(f"<td>{_text(cell)}</td>" for cell in row) + "</tr>" for row in block.rows
    )
    caption = f"<caption>{escape(block.caption)}</caption>" if block.caption else ""
    classes = [name for name, on in (("small", block.small), ("left", block.left)) if on]
    kind = f' class="{" ".join(classes)}"' if classes else ""
    return f"<table{kind}>{caption}<thead><tr>{head}</tr></thead>\n<tbody>{lines}</tbody></table>"
