"""Draws the pictures of the explanation beside this file: `python docs/pictures/make.py [FOLDER]`."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np

from ikgen.derivation.derive import derive
from ikgen.records.request import Request
from ikgen.report.graph_picture import draw
from ikgen.report.skeleton import Style, skeleton_camera, skeleton_svg
from ikgen.report.solution_sets import versions_of
from ikgen.report.worked_example import solver_of, worked_example
from ikgen.solver.behavior_tree import build_tree
from ikgen.solver.leaves import LEAVES
from ikgen.solver.session import Session

__all__ = ["PICTURES"]

HERE = Path(__file__).resolve().parent
PUMA = HERE.parents[1] / "urdf_fixtures/puma560_paper.toml"
UR5E = HERE.parents[1] / "urdf_fixtures/ur5e.urdf"
INK, LINE, FILL, PALE, SOFT = "#12263a", "#345", "#eef4fb", "#f6f6f2", "#5a6b7b"


def svg(width: float, height: float, title: str, parts: list[str]) -> str:
    """A drawing with an arrow head to use."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" '
        f'width="{width:g}" height="{height:g}" role="img" font-family="sans-serif">\n'
        f'<title>{title}</title>\n<defs><marker id="to" viewBox="0 0 8 8" refX="7" refY="4" '
        'markerWidth="7" markerHeight="7" orient="auto"><path d="M0 1 L7 4 L0 7 z" '
        f'fill="{LINE}"/></marker></defs>\n' + "\n".join(parts) + "\n</svg>\n"
    )


def text(x: float, y: float, words: str, size: float = 13, **style: str) -> str:
    """One line; `style` are attributes."""
    attributes = {"fill": INK, "text_anchor": "middle", **style}
    written = " ".join(f'{k.replace("_", "-")}="{v}"' for k, v in attributes.items())
    return f'<text x="{x:g}" y="{y:g}" font-size="{size:g}" {written}>{words}</text>'


def box(x: float, y: float, width: float, height: float, fill: str = FILL) -> str:
    """A rounded rectangle about its centre."""
    return (
        f'<rect x="{x - width / 2:g}" y="{y - height / 2:g}" width="{width:g}" '
        f'height="{height:g}" rx="6" fill="{fill}" stroke="{LINE}"/>'
    )


def line(a: tuple[float, float], b: tuple[float, float], extra: str = "") -> str:
    """A stroke from a to b."""
    return (
        f'<path d="M{a[0]:.1f} {a[1]:.1f} L{b[0]:.1f} {b[1]:.1f}" stroke="{LINE}" fill="none" '
        f"{extra}/>"
    )


ARROW = 'marker-end="url(#to)" stroke-width="1.2"'

STAGES = (
    ("importers", "JointTree, Chain", "links, joint axes, limits"),
    ("kinematics", "DHChain", "exact rows, named lengths, what was snapped"),
    ("equations", "EquationSet", "two-sided matrix equations, entry by entry"),
    ("solver", "SolutionGraph", "one solved unknown after the other, its parents"),
    ("lowering", "Program", "levels, guards, joint values: the same for every language"),
)


def flow() -> str:
    """The stages from the file to the verified outputs."""
    x, step, top = 330.0, 66.0, 34.0
    parts = [box(x, top, 330, 36, PALE), text(x, top + 5, "URDF · xacro · DH table")]
    for i, (package, product, words) in enumerate(STAGES, start=1):
        y = top + i * step
        parts += [line((x, y - step + (22 if i > 1 else 18)), (x, y - 22), ARROW)]
        parts.append(box(x, y, 330, 44))
        parts += [text(x, y - 3, product, 14), text(x, y + 14, words, 10.5, fill=SOFT)]
        parts.append(text(120, y + 5, package, 12, fill=SOFT, font_style="italic"))
    y = top + 6 * step
    for i, name in enumerate(("Python", "C++", "report", "other packages")):
        at = 120 + 140 * i
        parts += [line((x, y - step + 22), (at, y - 18), ARROW), box(at, y, 122, 36)]
        parts.append(text(at, y + 5, name))
    last = y + step
    parts += [line((at, y + 18), (at, last - 18), ARROW) for at in (120, 260)]
    parts += [box(260, last, 402, 36, PALE)]
    parts.append(text(260, last + 5, "verified: Pinocchio on the original file"))
    return svg(640, last + 34, "From the file to verified outputs", parts)


def tree() -> str:
    """The behavior tree that solves one unknown, as py_trees holds it."""
    root = build_tree(cast(Session, None), LEAVES)
    parts: list[str] = []
    rows = [0]
    drawn: set[str] = set()

    def place(node: Any, depth: int) -> float:
        x = 14 + depth * 165
        kind = type(node).__name__
        name = node.name.rsplit(": ", 1)[-1] if kind == "Or" else node.name
        children = node.children if name not in drawn else ()
        if kind == "Or":
            name = name if name not in drawn else f"{name}, as above"
            drawn.add(name)
        if not children:
            rows[0] += 1
            y = rows[0] * 25.0
        else:
            ys = [place(child, depth + 1) for child in children]
            y = (ys[0] + ys[-1]) / 2
            parts.extend(
                f'<path d="M{x + 150:g} {y:g} C{x + 158:g} {y:g} {x + 157:g} {yc:g} '
                f'{x + 165:g} {yc:g}" stroke="{LINE}" fill="none"/>'
                for yc in ys
            )
        mark = {"Sequence": "→ ", "Selector": "? ", "Or": "∨ "}.get(kind, "")
        parts.append(box(x + 75, y, 150, 21, PALE if node.children else FILL))
        parts.append(text(x + 75, y + 4, mark + name, 11))
        return y

    place(root, 0)
    height = (rows[0] + 1) * 25.0 + 16
    legend = "→ all in turn, until one fails;  ? the first that succeeds;  ∨ all, one must succeed"
    parts.append(text(14, height - 8, legend, 11, text_anchor="start", fill=SOFT))
    return svg(14 + 4 * 165 + 164, height, "The behavior tree", parts)


def puma_graph() -> str:
    """The solution graph of the paper's Puma 560, as the report draws it."""
    graph = derive(Request(PUMA)).graph
    return draw(graph, versions_of(graph), "Solution graph of the Puma 560").svg


def solutions() -> str:
    """The solutions of one pose of a UR5e, each as a skeleton, named as in its report."""
    found = derive(Request(UR5E, tip="tool0"))
    solver = solver_of(found)
    assert solver is not None
    example = worked_example(found, solver)
    dh, style = found.reading.dh, Style(190, 170, named=False)
    camera = skeleton_camera(dh, list(example.rows), style)
    parts = []
    for i, (q, name) in enumerate(zip(example.rows, example.names, strict=True)):
        x, y = i % 4 * 200.0, i // 4 * 220.0
        drawing = skeleton_svg(dh, q, style=style, camera=camera, title=name)
        parts.append(drawing.replace("<svg ", f'<svg x="{x:g}" y="{y:g}" ', 1).strip())
        for line, words in enumerate(name.rsplit(", ", 1)):
            parts.append(text(x + 95, y + 188 + 15 * line, words, 12, fill=SOFT))
    return svg(800, 440, "The eight solutions of one pose of a UR5e", parts)


Vector = np.ndarray


def project(p: Vector) -> tuple[float, float]:
    """A point (m) of the drawing's world in the picture."""
    right, up = np.array([0.92, -0.8, 0.0]), np.array([0.16, 0.2, 0.95])
    return float(120 + 150 * (right @ p)), float(330 - 150 * (up @ p))


def frames() -> str:
    """Modified Denavit-Hartenberg parameters between two joint axes."""
    alpha, theta, a, d = 0.7, 1.9, 1.5, 0.95
    o1, (x1, y1, z1) = np.zeros(3), np.eye(3)
    foot = o1 + a * x1
    z2 = math.cos(alpha) * z1 - math.sin(alpha) * y1
    o2 = foot + d * z2
    x2 = math.cos(theta) * x1 + math.sin(theta) * np.cross(z2, x1)
    parts = [
        line(project(o1 - 0.5 * z1), project(o1 + 1.7 * z1), 'stroke-dasharray="7 4"'),
        line(project(foot - 0.5 * z2), project(foot + 1.9 * z2), 'stroke-dasharray="7 4"'),
        line(project(o1), project(foot), 'stroke-width="2.4"'),
        line(project(foot), project(o2), 'stroke-width="2.4"'),
        line(project(foot), project(foot + 0.95 * z1), 'stroke-dasharray="2 3" opacity="0.8"'),
        line(project(o2), project(o2 + 0.75 * x1), 'stroke-dasharray="2 3" opacity="0.8"'),
    ]
    parts += _axis(o1, x1, 0.6, "x", "i−1", (4, 20)) + _axis(o1, z1, 1.0, "z", "i−1", (-26, 4))
    parts += _axis(o2, x2, 0.75, "x", "i", (-6, -10)) + _axis(o2, z2, 0.75, "z", "i", (14, 12))
    parts += _arc(foot, z1, z2, 0.6, "α", "i−1", 0.72) + _arc(o2, x1, x2, 0.5, "θ", "i", 1.3)
    middle, along = project(o1 + 0.72 * (foot - o1)), project(foot + 0.5 * d * z2)
    parts.append(_label(middle[0] - 4, middle[1] + 22, "a", "i−1"))
    parts.append(_label(along[0] + 14, along[1] + 8, "d", "i"))
    words = (
        ("axis of joint i−1", project(o1 + 1.7 * z1)),
        ("axis of joint i", project(foot + 1.9 * z2)),
    )
    parts += [text(x, y - 8, name, 12, fill=SOFT) for name, (x, y) in words]
    return svg(640, 430, "Modified Denavit-Hartenberg parameters", parts)


def _label(x: float, y: float, letter: str, index: str) -> str:
    shown = (
        f'<tspan font-style="italic">{letter}</tspan><tspan dy="4" font-size="10">{index}</tspan>'
    )
    return text(x, y, shown, 16)


def _axis(
    origin: Vector,
    along: Vector,
    length: float,
    letter: str,
    index: str,
    shift: tuple[float, float],
) -> list[str]:
    tip = project(origin + length * along)
    label = _label(tip[0] + shift[0], tip[1] + shift[1], letter, index)
    return [line(project(origin), tip, ARROW.replace("1.2", "1.8")), label]


def _arc(
    at: Vector, a: Vector, b: Vector, radius: float, letter: str, index: str, far: float
) -> list[str]:
    """An arc from direction a to b with the angle's name."""
    angle = math.acos(float(a @ b))
    turned = [
        (math.sin(angle * (1 - t)) * a + math.sin(angle * t) * b) / math.sin(angle)
        for t in np.linspace(0, 1, 17)
    ]
    points = [project(at + radius * v) for v in turned]
    path = "M" + " L".join(f"{x:.1f} {y:.1f}" for x, y in points)
    x, y = project(at + far * radius * turned[8])
    return [f'<path d="{path}" fill="none" stroke="{LINE}" {ARROW}/>', _label(x, y, letter, index)]


PICTURES: dict[str, Callable[[], str]] = {
    "flow.svg": flow,
    "tree.svg": tree,
    "puma560_graph.svg": puma_graph,
    "dh_frames.svg": frames,
    "ur5e_solutions.svg": solutions,
}


def main() -> None:
    """Write all of them into the folder named, by default this one."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE
    for name, make in PICTURES.items():
        (folder / name).write_text(make(), encoding="utf-8")


if __name__ == "__main__":
    main()
