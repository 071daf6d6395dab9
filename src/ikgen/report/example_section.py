"""One pose and its solutions: as numbers, and as skeletons side by side."""

from __future__ import annotations

import math

from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.lowering.held_angle import held_values
from ikgen.model.arrays import Array
from ikgen.model.chain import REVOLUTE
from ikgen.model.dh import DHChain
from ikgen.report.document import (
    Block,
    Heading,
    Matrix,
    Paragraph,
    Picture,
    Pictures,
    Rows,
    Text,
)
from ikgen.report.skeleton import Style, skeleton_camera, skeleton_svg
from ikgen.report.svg_latex import svg_latex
from ikgen.report.worked_example import WorkedExample

__all__ = ["example_section", "joint_text"]

_SMALL = Style(210, 180, named=False)
_MOST_DRAWN = 16
_ON_PAPER = 0.52
"""Points a pixel: four drawings in a line."""


def example_section(dh: DHChain, example: WorkedExample, module: str) -> list[Block]:
    """`module` is what the emitted code is called."""
    values = ", ".join(joint_text(dh, j, x) for j, x in enumerate(example.q))
    given = _held(dh, example)
    values_given = f", free=[{', '.join(given)}]" if given else ""
    call = f"{module}.solve(T{values_given})"
    return [
        Heading(("Worked example",), anchor="example"),
        Paragraph((f"The joints at {values} bring {dh.tip_link} to the pose",)),
        Matrix(m.name("T"), _entries(example.pose)),
        Paragraph((
            f"of which {call} gives {_count(example)}.{_within(example.off)}",
        )),
        _table(dh, example),
        _drawings(dh, example),
    ]  # fmt: skip


def _held(dh: DHChain, example: WorkedExample) -> list[str]:
    """The example's values of what is held, rad or m, as a program writes them."""
    values = held_values(dh, example.q, example.pose)
    given = [] if values is None else values.tolist()
    return [f"{x:.6g}" for x in given]


def joint_text(dh: DHChain, joint: int, value: float) -> str:
    """A value of a joint in degrees or m, without signs of zero and with 180 for -180 degrees."""
    if dh.joints[joint].kind != REVOLUTE:
        return f"{value + 0.0:.4f} m".replace("-0.0000", "0.0000")
    text = f"{math.degrees(value):.3f}"
    return {"-0.000": "0.000", "-180.000": "180.000"}.get(text, text) + "°"


def _within(off: float | None) -> str:
    """How far the rows' poses are off: a bound that is the same wherever the code runs."""
    if off is None:
        return ""
    bound = max(10.0 ** math.ceil(math.log10(max(off, 1e-15))), 1e-9)
    return f" The pose of each, by forward(), is T to within {bound:.0e} (m, and entries of the rotation)."


def _count(example: WorkedExample) -> str:
    k, inside = len(example.rows), int(example.inside.sum())
    words = f"{k} solution{'s' if k != 1 else ''}"
    return words if inside == k else f"{inside} of {words} (limits=False gives all)"


def _entries(T: Array) -> tuple[tuple[Math, ...], ...]:
    def one(x: float) -> Math:
        text = f"{abs(x):.5f}"
        shown = m.name(text[0]) if text in ("0.00000", "1.00000") else m.decimal(text)
        return m.minus(sign=True) + shown if x < 0 and text != "0.00000" else shown

    return tuple(tuple(one(float(x)) for x in row) for row in T)


def _table(dh: DHChain, example: WorkedExample) -> Rows:
    header: list[Text] = [("solution",), *((joint.name,) for joint in dh.joints), ("which",)]
    rows = []
    for i, (q, inside) in enumerate(zip(example.rows, example.inside, strict=True)):
        cells: list[Text] = [(str(i + 1),)]
        cells += [(joint_text(dh, j, x),) for j, x in enumerate(q)]
        name = example.names[i]
        cells.append((name if inside else f"{name}; outside the limits",))
        rows.append(tuple(cells))
    return Rows(tuple(header), tuple(rows), "All solutions of the pose", small=True)


def _drawings(dh: DHChain, example: WorkedExample) -> Pictures:
    rows = example.rows[:_MOST_DRAWN]
    camera = skeleton_camera(dh, [*rows], _SMALL) if len(rows) else None
    drawings = []
    for number, (q, name) in enumerate(zip(rows, example.names, strict=False), start=1):
        title = f"solution {number}: {name}"
        svg = skeleton_svg(dh, q, style=_SMALL, camera=camera, title=title)
        drawings.append(Picture(svg, svg_latex(svg, _ON_PAPER), f"{number}: {name}"))
    return Pictures(tuple(drawings))
