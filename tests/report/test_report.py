"""The derivation report: what it says of known robots, and that both texts are well-formed."""

from __future__ import annotations

import re
import shutil
import subprocess
import xml.dom.minidom
from functools import cache
from pathlib import Path

import pytest
from tests.support.redundant_arms import serial_urdf

from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.formulas.normal_form import Sum
from ikgen.formulas.normalizer import Normalizer
from ikgen.formulas.notation import show
from ikgen.generation.emitters import find_emitter
from ikgen.records.request import Request
from ikgen.report import emit_report
from ikgen.report.layout import layout
from ikgen.report.solution_sets import versions_of
from ikgen.verify.verification_report import CheckResult, VerificationReport

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
TABLES = {
    "puma": ROOT / "urdf_fixtures" / "puma560_paper.toml",
    "symbolic": ROOT / "urdf_fixtures" / "puma560_symbolic.toml",
    "olson": ROOT / "urdf_fixtures" / "olson13.toml",
    "quartic": ROOT / "tests" / "robots" / "tables" / "ArmRobo.toml",
    "general twists": ROOT / "tests" / "robots" / "tables" / "Raven-II.toml",
    "elimination": ROOT / "tests" / "robots" / "tables" / "Issue4.toml",
    "sums": ROOT / "tests" / "robots" / "tables" / "UR5.toml",
}
GEARED = (
    ("waist", "revolute", "0 0 1", "0 0 0.3", (-3.0, 3.0)),
    ("shoulder", "revolute", "0 1 0", "0.05 0 0.1", (-1.2, 1.2)),
    ("elbow", "revolute", "0 1 0", "0 0 0.3", (-2.6, 2.6)),
    ("pitch", "revolute", "0 -1 0", "0 0 0.25", (-2.4, 2.4)),
)


@cache
def derivation(name: str) -> Derivation:
    return derive(Request(TABLES[name]))


@cache
def texts(name: str) -> dict[str, str]:
    return emit_report(derivation(name))


def text(name: str, kind: str) -> str:
    return next(t for file, t in texts(name).items() if file.endswith(kind))


def parents(name: str) -> dict[str, set[str]]:
    return {v.text: {p.text for p in above} for v, above in derivation(name).graph.parents}


def test_puma_is_solved_in_the_papers_order() -> None:
    order = [step.candidate.unknown.text for step in derivation("puma").graph.steps]
    assert order[:2] == ["theta_1", "theta_3"]
    assert order[2] in ("theta_2", "theta_23")
    assert order[3:] == ["theta_4", "theta_5", "theta_6"]
    assert parents("puma")["theta_2"] == {"theta_1", "theta_3"}


def test_olson13_needs_a_graph() -> None:
    """IKBT: "d_1, d_2, and theta_5 all share two independently solved parent variables"."""
    above = parents("olson")
    assert above["d_1"] == above["d_2"] == above["theta_5"] == {"theta_3", "theta_4"}
    assert above["theta_3"] == above["theta_4"] == set()
    assert above["theta_6"] == {"theta_3"}
    branches = {s.candidate.unknown.text: s.branches for s in derivation("olson").graph.steps}
    assert branches["theta_3"] == branches["theta_4"] == 2
    assert {n for v, n in branches.items() if v not in ("theta_3", "theta_4")} == {1}


def test_puma_has_the_papers_branches_and_parents() -> None:
    """IKBT's Puma but for two shorter ways: |p|^2 gives theta_3 without theta_1, so that it has two
    versions and not four of which two are equal; theta_6 needs no division by sin(theta_5)."""
    branches = {s.candidate.unknown.text: s.branches for s in derivation("puma").graph.steps}
    assert {v for v, n in branches.items() if n == 2} == {"theta_1", "theta_3", "theta_4"}
    assert set(branches.values()) == {1, 2}
    above = parents("puma")
    assert above["theta_1"] == above["theta_3"] == set()
    assert above["theta_4"] == {"theta_2"} and above["theta_5"] == {"theta_4"}
    assert above["theta_6"] <= {"theta_4", "theta_5"}
    leaves = {s.candidate.unknown.text: s.candidate.leaf for s in derivation("puma").graph.steps}
    assert leaves["theta_1"] == "sine and cosine" and leaves["theta_3"] == "x2y2"
    assert leaves["theta_4"] == "tangent"


def test_olson13_has_the_papers_pose_sets() -> None:
    """Four sets; theta_6 goes with theta_3, d_1, d_2 and theta_5 with both choices (IKBT)."""
    versions = versions_of(derivation("olson").graph)
    by_name = {v.text: v for v in versions.within}
    sets = [
        tuple(
            versions.number(by_name[n], chosen)
            for n in ("d_1", "d_2", "theta_3", "theta_4", "theta_5", "theta_6")
        )
        for chosen in versions.sets()
    ]
    assert len(set(sets)) == 4
    assert all(d1 == d2 == fifth for d1, d2, _, _, fifth, _ in sets)
    assert {(third, sixth) for _, _, third, _, _, sixth in sets} == {(1, 1), (2, 2)}
    assert sorted(d1 for d1, *_ in sets) == [1, 2, 3, 4]


def test_every_node_of_the_tree_is_told_in_every_round() -> None:
    html, tex = text("olson", ".html"), text("olson", ".tex")
    for node in ("→ solve one unknown", "? ways", "∨ leaves", "ranker"):
        assert f">{node}<" in html
    for node in ("solve one unknown (sequence)", "ways (selector)", "leaves (OR)", "ranker"):
        assert node in tex
    graph = derivation("olson").graph
    assert {t.round for t in graph.ticks} == set(range(1, len(graph.steps) + 1))
    assert {t.path for t in graph.ticks} <= set(graph.outline)
    root = [t for t in graph.ticks if len(t.path) == 1]
    assert all(t.outcome == "success" and t.kind == "sequence" for t in root)


def test_matrix_equations_are_named() -> None:
    tex = text("olson", ".tex")
    assert "Row 2, column 4 of the split (3,5):" in tex
    assert r"{(A_{1}\,A_{2}\,A_{3}\,C_{4})}^{-1}\,T_{d}\,A_{6}^{-1}=V_{4}\,A_{5}" in tex


def test_elimination_and_quartic_are_explained() -> None:
    assert "Raghavan and Roth (1993)" in text("elimination", ".html")
    assert "Ferrari's resolvent" in text("quartic", ".tex")


def test_pose_sets_pair_every_choice_once() -> None:
    versions = versions_of(derivation("puma").graph)
    assert versions.poses == 8
    counts = {v.text: versions.count(v) for v in versions.within}
    assert counts["theta_1"] == counts["theta_3"] == 2
    assert counts["theta_2"] == 4
    assert counts["theta_4"] == counts["theta_5"] == counts["theta_6"] == 8
    sixth = next(v for v in versions.within if v.text == "theta_6")
    assert sorted(versions.number(sixth, chosen) for chosen in versions.sets()) == list(range(1, 9))


def test_layout_has_children_below_their_parents() -> None:
    for name in ("puma", "olson", "sums", "general twists"):
        graph = derivation(name).graph
        plan = layout(graph)
        place = plan.place
        assert set(place) == {v for v, _ in graph.parents} - set(graph.passed)
        assert all(place[p][1] < place[v][1] for p, v in plan.routes)
        assert set(plan.routes) == {(p, v) for v in place for p in dict(graph.parents)[v]}


def test_arrows_go_around_the_boxes() -> None:
    for name in TABLES:
        plan = layout(derivation(name).graph)
        between = [at for route in plan.routes.values() for at in route[1:-1]]
        assert len({*between, *plan.place.values()}) == len(between) + len(plan.place)
        for route in plan.routes.values():
            assert [row for _, row in route] == list(range(int(route[0][1]), int(route[-1][1]) + 1))


def test_puma_report_reads_like_the_paper() -> None:
    tex = text("puma", ".tex")
    assert r"\theta_{1s1}=\operatorname{atan2}(-p_{x},\penalty150\,p_{y})" in tex
    assert r"p_{z}=-a_{3}\,s_{23}-d_{4}\,c_{23}-a_{2}\,s_{2}" in tex
    assert r"p_{y}\,c_{1}-p_{x}\,s_{1}=d_{3}" in tex
    assert "Solution 8" in tex
    assert "Degenerate where" in tex


def test_olson_report_has_the_papers_solutions() -> None:
    tex = text("olson", ".tex")
    assert r"p_{x}=d_{2}+l_{4}\,s_{3}\,c_{4}+l_{5}\,s_{3}\,s_{45}" in tex
    assert r"\theta_{3s1}=\operatorname{atan2}(-r_{13},\penalty150\,r_{23})" in tex
    assert r"\theta_{5}=\theta_{45}-\theta_{4}" in tex
    assert r"$d_{1}$ has the parents $\theta_{3}$ and $\theta_{4}$" in tex


def test_symbolic_lengths_stay_symbols() -> None:
    assert "symbolic" in text("symbolic", ".html")
    assert r"p_{z}=-a_{3}\,s_{23}-d_{4}\,c_{23}-a_{2}\,s_{2}" in text("symbolic", ".tex")


@pytest.mark.parametrize("name", TABLES)
def test_html_is_self_contained_and_balanced(name: str) -> None:
    html = text(name, ".html")
    assert not re.search(r"<script|<link|src=|@import|url\((?!#)", html)
    assert [u for u in re.findall(r"https?://[^\"\s]+", html) if "w3.org" not in u] == []
    body = html[html.index("<body>") : html.index("</html>")].replace("<wbr>", "")
    xml.dom.minidom.parseString(body)


@pytest.mark.parametrize("name", [name for name in TABLES if name != "elimination"])
def test_graph_is_an_svg_of_its_own(name: str) -> None:
    root = xml.dom.minidom.parseString(text(name, ".svg")).documentElement
    assert root is not None and root.tagName == "svg"


@pytest.mark.parametrize("name", TABLES)
def test_latex_compiles(name: str, tmp_path: Path) -> None:
    pdflatex = shutil.which("pdflatex")
    if pdflatex is None:
        pytest.skip("no pdflatex here")
    (tmp_path / "report.tex").write_text(text(name, ".tex"), encoding="utf-8")
    command = [pdflatex, "-interaction=nonstopmode", "-halt-on-error", "report.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    log = done.stdout.decode("latin-1")
    assert done.returncode == 0, log[-2000:]
    wide = [float(w) for w in re.findall(r"Overfull \\hbox \(([\d.]+)pt", log)]
    assert max(wide, default=0.0) < 2.0


def test_same_input_gives_the_same_text() -> None:
    assert emit_report(derive(Request(TABLES["puma"]))) == texts("puma")


def test_verification_is_told_where_there_is_one() -> None:
    checks = (CheckResult("closure", True, 1000, worst=(("position m", 1e-15),)),)
    report = VerificationReport("python", "base", "tip", "pose", 1000, 0, checks)
    made = emit_report(derivation("puma"), {"python": report})
    tex = next(t for file, t in made.items() if file.endswith(".tex"))
    assert "Verification" in tex and "closure" in tex


def test_report_is_an_emitter() -> None:
    files = find_emitter("report").emit(derivation("olson"))
    assert sorted(files) == ["olson13_graph.svg", "olson13_report.html", "olson13_report.tex"]


def test_an_elimination_has_no_graph_of_unknowns() -> None:
    files = find_emitter("report").emit(derivation("elimination"))
    assert sorted(Path(file).suffix for file in files) == [".html", ".tex"]


def made(build: str) -> Sum:
    """A sum out of an expression in a, b, x."""
    import numpy as np

    g = ExpressionGraph(2)
    names = {
        "a": g.param("a_1", 2.0),
        "b": g.param("b_1", 3.0),
        "x": g.atom("pose", "px", np.array([0.3, 0.4]), unknown=False),
        "g": g,
    }
    return Normalizer()(eval(build, {}, names))  # test-local text only


@pytest.mark.parametrize(
    ("build", "latex"),
    [
        ("g.sub(g.neg(a), g.neg(x))", "p_{x}-a_{1}"),
        ("g.mul(g.sub(a, b), g.sub(b, a))", "-{(a_{1}-b_{1})}^{2}"),
        ("g.mul(x, g.mul(a, x))", r"a_{1}\,p_{x}^{2}"),
        ("g.add(g.add(a, x), g.sub(a, x))", r"2\,a_{1}"),
        ("g.mul(g.const(0.75 ** 0.5), x)", r"\tfrac{\sqrt{3}}{2}\,p_{x}"),
        ("g.div(a, g.add(b, x))", r"\frac{a_{1}}{b_{1}+p_{x}}"),
        ("g.sub(a, a)", "0"),
    ],
)
def test_notation(build: str, latex: str) -> None:
    assert show(made(build)).latex == latex


def test_the_table_of_a_geared_arm_counts_variables_by_joints(tmp_path: Path) -> None:
    """As its equations do: a row that follows has its multiple of the joint's variable, and its
    constant."""
    path = tmp_path / "arm.urdf"
    joint = '<joint name="elbow" type="revolute">'
    mimic = f'{joint}<mimic joint="shoulder" multiplier="0.8" offset="0.3"/>'
    path.write_text(serial_urdf("arm", GEARED).replace(joint, mimic))
    (tex,) = (t for file, t in emit_report(derive(Request(path))).items() if file.endswith(".tex"))
    table = tex[tex.index("Craig") :][:3000]
    assert r"5\,\theta_{2}+\tfrac{\pi }{2}$" in table and r"4\,\theta_{2}-0.3$" in table, table
    assert r"\theta_{2}=-0.2\,q_{2}" in tex, tex[tex.index("joint values q") :][:300]
