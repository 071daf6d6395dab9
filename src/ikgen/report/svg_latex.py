"""Drawings of an arm for paper: the paths of their SVG as PDF operators, and their names set by LaTeX."""

from __future__ import annotations

import re
from xml.etree import ElementTree

from ikgen.formulas.mathtext import GREEK

__all__ = ["svg_latex"]

_SPACE = "{http://www.w3.org/2000/svg}"
_LETTERS = {shown: name for name, shown in reversed(GREEK.items())}


def svg_latex(svg: str, scale: float) -> str:
    """A `picture` of LaTeX, `scale` points of the PDF a pixel; the drawing has paths of straight lines, and
    texts with one subscript at most. Other engines than pdfTeX set the names alone.

    Operators are those of ISO 32000-1, annex A; what lets light through is mixed with white.
    """
    root = ElementTree.fromstring(svg)
    wide, high = (float(root.attrib[name]) * scale for name in ("width", "height"))
    paths = [_path(element) for element in root.iter(f"{_SPACE}path")]
    names = [_name(element, scale, high) for element in root.iter(f"{_SPACE}text")]
    inside = " ".join(["q", f"{scale:g} 0 0 {-scale:g} 0 {high:.2f} cm", *paths, "Q"])
    return "\n".join([
        "{\\setlength{\\unitlength}{1bp}%",
        f"\\begin{{picture}}({wide:.0f},{high:.0f})",
        f"\\put(0,0){{\\ifdefined\\pdfliteral\\pdfliteral{{{inside}}}\\fi}}",
        *names,
        "\\end{picture}}",
    ])  # fmt: skip


def _path(element: ElementTree.Element) -> str:
    """The operators of one path, in a graphics state of its own."""
    get = element.attrib.get
    fill, stroke = get("fill", "none"), get("stroke", "none")
    marks = [f"{get('stroke-width', '1')} w", _dashes(get("stroke-dasharray", ""))]
    if get("stroke-linecap") == "round":
        marks.append("1 J")
    if get("stroke-linejoin") == "round":
        marks.append("1 j")
    if fill != "none":
        marks.append(f"{_colour(fill, get('fill-opacity', '1'))} rg")
    if stroke != "none":
        marks.append(f"{_colour(stroke, get('stroke-opacity', '1'))} RG")
    paint = "B" if "none" not in (fill, stroke) else "f" if fill != "none" else "S"
    d = element.attrib["d"]
    steps = re.sub(r"([ML])([-\d.]+) ([-\d.]+)", lambda k: f"{k[2]} {k[3]} {k[1].lower()} ", d)
    return " ".join(["q", *filter(None, marks), steps.replace("Z", "h"), paint, "Q"])


def _dashes(text: str) -> str:
    return f"[{text}] 0 d" if text else ""


def _colour(text: str, opacity: str) -> str:
    """Red, green and blue between 0 and 1 of `#rrggbb` over white."""
    share = float(opacity)
    parts = (int(text[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return " ".join(f"{1 - share + share * part:.3f}" for part in parts)


def _name(element: ElementTree.Element, scale: float, high: float) -> str:
    """A text in the middle of its place: letters and numbers alone."""
    pieces = [element.text or "", *((part.text or "") for part in element)]
    letters, *below = [piece for piece in pieces if piece]
    shown = _LETTERS.get(letters)
    text = f"\\{shown}" if shown else f"\\mathit{{{_plain(letters)}}}"
    text += f"_{{\\mathrm{{{_plain(''.join(below))}}}}}" if below else ""
    x, y = float(element.attrib["x"]) * scale, high - float(element.attrib["y"]) * scale
    colour = _colour(element.attrib["fill"], "1").replace(" ", ",")
    inside = f"\\makebox(0,0)[b]{{\\footnotesize\\color[rgb]{{{colour}}}${text}$}}"
    return f"\\put({x:.1f},{y:.1f}){{{inside}}}"


def _plain(text: str) -> str:
    return re.sub(r"[^A-Za-z0-9,]", "", text)
