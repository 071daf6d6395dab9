"""The document as one HTML file with MathML: no scripts, no fonts, nothing to fetch."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from ikgen.emit.rendering import render
from ikgen.formulas.mathtext import Math
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

__all__ = ["to_html"]

_SCROLLS = 'tabindex="0" role="group" aria-label="formulas"'
"""Attributes of what may be wider than a phone, so that keys can scroll it too."""


def to_html(title: str, subtitle: str, blocks: Sequence[Block]) -> str:
    """The text of the .html file; its contents are the headings that have an anchor."""
    return render(
        "report",
        "report.html.jinja",
        title=escape(title),
        subtitle=escape(subtitle),
        contents=_contents(blocks),
        body="\n".join(_block(b) for b in blocks),
    )


def _contents(blocks: Sequence[Block]) -> str:
    """The list beside the page: sections, and their steps in lists of their own."""
    out: list[str] = []
    inside = False
    for b in blocks:
        if not isinstance(b, Heading) or not b.anchor:
            continue
        if b.level == 1:
            out.append(("</ol></li>" if inside else "</li>") if out else "")
            inside = False
        elif not inside and out:
            out.append("<ol>")
            inside = True
        end = "</li>" if b.level > 1 else ""
        out.append(f'<li><a href="#{b.anchor}">{_text(b.title)}</a>{end}')
    last = ("</ol></li>" if inside else "</li>") if out else ""
    return "".join([*out, last])


def _math(formula: Math) -> str:
    """The formula in pieces, so that a long one wraps between them."""
    pieces = [f"<math><mrow>{chunk}</mrow></math>" for chunk in formula.chunks]
    return "<wbr>".join(pieces)


def _inline(part: Inline) -> str:
    if isinstance(part, str):
        return escape(part)
    if isinstance(part, Link):
        where = f' title="formula {part.number}"' if part.number else ""
        return f'<a href="#{part.anchor}"{where}>{escape(part.words)}</a>'
    return _math(part)


def _text(text: Text) -> str:
    return "".join(map(_inline, text))


def _block(block: Block) -> str:
    match block:
        case Heading(title, level, anchor):
            place = f' id="{anchor}"' if anchor else ""
            return f"<h{level + 1}{place}>{_text(title)}</h{level + 1}>"
        case Paragraph(text, note):
            return f'<p class="note">{_text(text)}</p>' if note else f"<p>{_text(text)}</p>"
        case Formulas():
            return _formulas(block)
        case Matrix(name, rows):
            cells = "".join(
                "<mtr>" + "".join(f"<mtd>{x.mathml}</mtd>" for x in row) + "</mtr>" for row in rows
            )
            return (
                f'<div class="matrix" {_SCROLLS}><math display="block"><mrow>{name.mathml}<mo>=</mo>'
                f"<mo>[</mo><mtable>{cells}</mtable><mo>]</mo></mrow></math></div>"
            )
        case Rows():
            return _rows(block)
        case _:
            return _arranged(block)


def _arranged(block: Picture | Pictures | Card | Fold) -> str:
    """Blocks that hold others."""
    match block:
        case Picture():
            return _figure(block)
        case Pictures(drawings):
            return f'<div class="pictures">{"".join(map(_figure, drawings))}</div>'
        case Card(picture, facts):
            rows = "".join(f"<dt>{escape(n)}</dt><dd>{_text(t)}</dd>" for n, t in facts)
            return f'<div class="card">{_figure(picture)}<dl>{rows}</dl></div>'
        case Fold(words, inner):
            inside = "\n".join(map(_block, inner))
            return f"<details><summary>{escape(words)}</summary>\n{inside}\n</details>"


def _figure(picture: Picture) -> str:
    caption = f"<figcaption>{escape(picture.caption)}</figcaption>" if picture.caption else ""
    return f"<figure>{picture.svg}{caption}</figure>"


def _formulas(block: Formulas) -> str:
    out = []
    for i, line in enumerate(block.lines):
        anchor = block.anchors[i] if block.anchors else ""
        place = f' id="{anchor}"' if anchor else ""
        number = f"<span>({block.numbers[i]})</span>" if block.numbers else ""
        out.append(f"<div{place}><div>{_math(line)}</div>{number}</div>")
    inside = "\n".join(out)
    return f'<div class="formulas" {_SCROLLS}>\n{inside}\n</div>'


def _rows(block: Rows) -> str:
    head = "".join(f'<th scope="col">{_text(h)}</th>' for h in block.header)
    lines = "\n".join(
        "<tr>" + "".join(f"<td>{_text(cell)}</td>" for cell in row) + "</tr>" for row in block.rows
    )
    caption = f"<caption>{escape(block.caption)}</caption>" if block.caption else ""
    classes = [name for name, on in (("small", block.small), ("left", block.left)) if on]
    kind = f' class="{" ".join(classes)}"' if classes else ""
    table = f"<table{kind}>{caption}<thead><tr>{head}</tr></thead>\n<tbody>{lines}</tbody></table>"
    label = escape(block.caption or "table")
    return f'<div class="wide" tabindex="0" role="region" aria-label="{label}">{table}</div>'
