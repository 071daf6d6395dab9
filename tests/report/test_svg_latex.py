"""Drawings on paper: the same paths as in the SVG, and names that LaTeX sets."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from ikgen.derivation.read import read
from ikgen.records.request import Request
from ikgen.report.skeleton import skeleton_svg
from ikgen.report.svg_latex import svg_latex

PUMA = Path(__file__).resolve().parents[2] / "urdf_fixtures/puma560_paper.toml"


def test_every_path_and_every_name_is_drawn() -> None:
    dh = read(Request(PUMA)).dh
    svg = skeleton_svg(dh, np.full(6, 0.4))
    root = ElementTree.fromstring(svg)
    paths = [e.attrib["d"] for e in root.iter() if e.tag.endswith("}path")]
    texts = ["".join(e.itertext()) for e in root.iter() if e.tag.endswith("}text")]
    latex = svg_latex(svg, 0.5)
    (drawn,) = re.findall(r"\\pdfliteral\{([^}]*)\}", latex)
    assert drawn.count(" m ") == len(paths) > 20
    numbers = re.findall(r"[-\d.]+ [-\d.]+(?= [ml] )", drawn)
    assert numbers == [pair for d in paths for pair in re.findall(r"[-\d.]+ [-\d.]+", d)]
    assert drawn.startswith("q 0.5 0 0 -0.5 0 ") and drawn.split().count(
        "q"
    ) == drawn.split().count("Q")
    names = re.findall(r"\$(.*?)\$", latex)
    assert len(names) == len(texts) > 6
    assert "\\mathit{z}_{\\mathrm{1}}" in names and "\\mathit{a}_{\\mathrm{2}}" in names
    assert latex.count("{") == latex.count("}")


def test_names_are_letters_and_light_is_mixed_with_white() -> None:
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="10" height="20">'
        '<path d="M1 2L3 4Z" fill="#000000" fill-opacity="0.25" stroke="none"/>'
        '<text x="4" y="5" fill="#ff0000">θ<tspan>\\evil$</tspan></text></svg>'
    )
    latex = svg_latex(svg, 1.0)
    assert "0.750 0.750 0.750 rg 1 2 m 3 4 l h f Q" in " ".join(latex.split())
    assert "\\put(4.0,15.0)" in latex and "$\\theta_{\\mathrm{evil}}$" in latex
    assert "\\color[rgb]{1.000,0.000,0.000}" in latex
