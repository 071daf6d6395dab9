"""The solution graph as a drawing: layers from the pose down, laid out and drawn without help."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from itertools import pairwise

from ikgen.equations.knowledge import Variable
from ikgen.formulas.notation import variable
from ikgen.report.layout import layout
from ikgen.report.solution_sets import Versions
from ikgen.report.step_anchor import step_anchor
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["Drawing", "draw"]

_STEP_X, _STEP_Y, _WIDTH, _HEIGHT, _MARGIN = 124, 98, 100, 54, 14


@dataclass(frozen=True, slots=True)
class Drawing:
    """The graph in both languages; places are centres in points, y downwards."""

    svg: str
    latex: str


def draw(graph: SolutionGraph, versions: Versions, title: str) -> Drawing:
    """The drawing: a box an unknown with its number of solutions, an arrow a direct parent."""
    plan = layout(graph)
    place = {v: _point(at) for v, at in plan.place.items()}
    every = [*place.values(), *(_point(at) for route in plan.routes.values() for at in route)]
    width = max((x for x, _ in every), default=0.0) + _WIDTH / 2 + _MARGIN
    height = max((y for _, y in every), default=0.0) + _HEIGHT / 2 + _MARGIN
    leaves = {graph.joint_variable(j): _HELD for j in graph.held}
    leaves |= {s.candidate.unknown: s.candidate.leaf for s in graph.steps}
    forks = dict(versions.forks)
    arrows = [
        _Arrow(_strokes([_point(at) for at in route]), forks.get(edge[0], 1))
        for edge, route in plan.routes.items()
    ]
    routes = [arrow.strokes for arrow in arrows]
    return Drawing(
        _svg(place, arrows, versions, leaves, (width, height), title),
        _latex(place, routes, versions, (width, height)),
    )


_HELD = "held"
"""What stands in the box of a joint whose value is given."""

Point = tuple[float, float]
Stroke = tuple[Point, Point]


@dataclass(frozen=True, slots=True)
class _Arrow:
    """From an unknown with so many branches to one that is computed from it."""

    strokes: list[Stroke]
    branches: int


def _point(at: Point) -> Point:
    """The centre of a place."""
    return _MARGIN + _WIDTH / 2 + at[0] * _STEP_X, _MARGIN + _HEIGHT / 2 + at[1] * _STEP_Y


def _strokes(route: list[Point]) -> list[Stroke]:
    """From below each place to above the next; straight down through those in between."""
    return [
        ((x1, y1 + _HEIGHT / 2), (x2, y2 - _HEIGHT / 2)) for (x1, y1), (x2, y2) in pairwise(route)
    ]


def _count(versions: Versions, v: Variable) -> str:
    n = versions.count(v)
    return f"{n} solution{'s' if n > 1 else ''}"


def _svg(
    place: dict[Variable, Point],
    arrows: list[_Arrow],
    versions: Versions,
    leaves: dict[Variable, str],
    size: Point,
    title: str,
) -> str:
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size[0]:g} {size[1]:g}" '
        f'width="{size[0]:g}" height="{size[1]:g}" role="group" font-family="serif">',
        f"<title>{title}</title>",
        '<defs><marker id="arrow" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" '
        'markerHeight="7" orient="auto"><path class="head" d="M0 1 L7 4 L0 7 z" fill="#345"/></marker>'
        "</defs>",
    ]
    parts += [*map(_arrow, arrows), *_branches(arrows)]
    parts += [
        _linked(v, _box(v, at, versions, leaves.get(v, "")), leaves) for v, at in place.items()
    ]
    return "\n".join([*parts, "</svg>"]) + "\n"


def _arrow(arrow: _Arrow) -> str:
    return (
        f'<path class="line" d="{_path(arrow.strokes)}" fill="none" stroke="#345" stroke-width="1.2" '
        'marker-end="url(#arrow)"/>'
    )


def _branches(arrows: list[_Arrow]) -> list[str]:
    """How many branches an unknown leaves behind, beside where its arrows start."""
    starts = {arrow.strokes[0][0]: arrow.branches for arrow in arrows if arrow.branches > 1}
    return [
        f'<text class="soft" x="{x - 24:.1f}" y="{y + 13:.1f}" font-size="10" fill="#456" '
        f'font-family="sans-serif">×{n}</text>'
        for (x, y), n in starts.items()
    ]


def _linked(v: Variable, box: str, leaves: dict[Variable, str]) -> str:
    """The box leads to the step that solves its unknown, or to the sums of angles."""
    if leaves.get(v) == _HELD:
        return box
    return f'<a href="#{step_anchor(v) if v in leaves else "sums"}">{box}</a>'


def _path(strokes: list[Stroke]) -> str:
    """One arrow as the path of an SVG: a curve that leaves and arrives upright, stroke by stroke."""
    (x, y), _ = strokes[0]
    parts = [f"M{x:g} {y:g}"]
    for i, ((x1, y1), (x2, y2)) in enumerate(strokes):
        bend = (y2 - y1) / 2
        if i:
            parts.append(f"L{x1:g} {y1:g}")
        end = y2 - 1 if i == len(strokes) - 1 else y2
        parts.append(f"C{x1:g} {y1 + bend:g} {x2:g} {y2 - bend:g} {x2:g} {end:g}")
    return " ".join(parts)


def _latex(
    place: dict[Variable, Point],
    routes: list[list[Stroke]],
    versions: Versions,
    size: Point,
) -> str:
    """The `picture` environment of LaTeX itself; a point is a unit, y upwards."""
    high = size[1]
    unit = min(0.8, 430.0 / size[0])
    lines = [
        f"\\setlength{{\\unitlength}}{{{unit:.3f}pt}}",
        "\\renewcommand{\\qbeziermax}{2000}",
        f"\\begin{{picture}}({size[0]:.0f},{high:.0f})",
    ]
    for strokes in routes:
        below = None
        for (x1, y1), (x2, y2) in strokes:
            middle = (x1 + x2) / 2, (y1 + y2) / 2
            bend = ((x1, (y1 + middle[1]) / 2), (x2, (y2 + middle[1]) / 2))
            curves = [((x1, y1), bend[0], middle), (middle, bend[1], (x2, y2))]
            if below is not None:
                curves.insert(0, (below, (x1, (below[1] + y1) / 2), (x1, y1)))
            for three in curves:
                points = "".join(f"({x:.1f},{high - y:.1f})" for x, y in three)
                lines.append(f"\\qbezier{points}")
            below = (x2, y2)
        x2, y2 = strokes[-1][1]
        lines.append(f"\\put({x2:.1f},{high - y2:.1f}){{\\vector(0,-1){{0}}}}")
    for v, (x, y) in place.items():
        corner = f"{x - _WIDTH / 2:.1f},{high - y - _HEIGHT / 2:.1f}"
        words = f"\\shortstack{{${variable(v).latex}$\\\\[1pt]\\tiny {_count(versions, v)}}}"
        lines.append(f"\\put({corner}){{\\framebox({_WIDTH},{_HEIGHT}){{{words}}}}}")
    return "\n".join([*lines, "\\end{picture}"])


def _box(v: Variable, at: Point, versions: Versions, leaf: str) -> str:
    """One unknown: its name, the leaf that solved it, and how many solutions it has."""
    x, y = at
    index = v.text.partition("_")[2]
    if v.text.startswith("("):
        shown = v.text.replace("theta", "θ")
    else:
        letter = "θ" if v.kind == "angle" else "d"
        shown = f'{letter}<tspan dy="4" font-size="11">{index}</tspan>'
    fill, kind = ("#eef4fb", "box solved") if leaf else ("#f6f6f2", "box")
    small = 'text-anchor="middle" font-size="10" fill="#456" font-family="sans-serif"'
    return (
        f'<rect class="{kind}" x="{x - _WIDTH / 2:g}" y="{y - _HEIGHT / 2:g}" width="{_WIDTH}" '
        f'height="{_HEIGHT}" rx="7" fill="{fill}" stroke="#345"/>'
        f'<text class="ink" x="{x:g}" y="{y - 9:g}" text-anchor="middle" font-style="italic" '
        f'font-size="16" fill="#123">{shown}</text>'
        f'<text class="soft" x="{x:g}" y="{y + 8:g}" {small}>{escape(leaf or "sum")}</text>'
        f'<text class="soft" x="{x:g}" y="{y + 20:g}" {small}>{_count(versions, v)}</text>'
    )
