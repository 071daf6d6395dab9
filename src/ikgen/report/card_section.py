"""The top of a report: the arm drawn, and what there is to know at a glance."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ikgen.emit.derivation import Reading
from ikgen.importers.named_robots import is_named
from ikgen.kinematics.classify import GeometryClass
from ikgen.model.arrays import Array
from ikgen.model.chain import REVOLUTE, ActuatedJoint
from ikgen.model.counted import counted
from ikgen.report.document import Block, Card, Heading, Picture, Text
from ikgen.report.skeleton import Style, skeleton_svg
from ikgen.report.svg_latex import svg_latex
from ikgen.tasks import Task
from ikgen.verify.verification_report import VerificationReport

__all__ = ["card_section"]

_ON_PAPER = 0.55
"""Points a pixel."""


def card_section(
    reading: Reading,
    geometry: GeometryClass,
    task: Task,
    q: Array,
    most: str,
    reports: Mapping[str, VerificationReport],
    command: str,
) -> list[Block]:
    """`most` says how many solutions there are, `command` makes the report again; the arm is drawn at `q`
    (dof,), rad and m."""
    dh = reading.dh
    drawing = skeleton_svg(dh, q, style=Style(480, 400), title=f"{dh.robot} as a skeleton")
    family, _, why = geometry.words.partition(": ")
    facts: list[tuple[str, Text]] = [
        ("family", (family,)),
        ("because", (why,)),
        ("chain", (f"{dh.base_link} to {dh.tip_link}, {counted(dh.dof, 'joint')}",)),
        ("task", (f"{task.name}: {task.words}",)),
        ("solutions", (most,)),
    ]
    facts += [("held", (", ".join(dh.free),))] if dh.free else []
    facts += [(f"verified, {name}", (_verdict(report),)) for name, report in reports.items()]
    again = "make it again" + ("" if is_named(reading.source.path) else ", where the file lies")
    facts += [("limits", (_limits(dh.joints),)), (again, (command,))]
    caption = "Joint axes dashed, lengths as in the formulas; x axes red, z axes blue"
    kept = tuple((name, text) for name, text in facts if text != ("",))
    return [
        Heading(("The arm",), anchor="arm"),
        Card(Picture(drawing, svg_latex(drawing, _ON_PAPER), "" if dh.symbols else caption), kept),
    ]


def _verdict(report: VerificationReport) -> str:
    """The worst error and what was missed."""
    metres, radians = report.worst_closure
    wrong = len(report.failed)
    words = f"{report.samples} random poses, {report.missed_words}"
    if not math.isnan(metres):
        words += f"; worst error {metres:.0e} m, {radians:.0e} rad"
    return words + (f"; {wrong} checks FAILED" if wrong else "")


def _limits(joints: tuple[ActuatedJoint, ...]) -> str:
    """One range a joint, in degrees or mm."""
    out = []
    for joint in joints:
        turns = joint.kind == REVOLUTE
        scale, unit = (180 / math.pi, "°") if turns else (1e3, " mm")
        low, high = joint.limits.lower * scale, joint.limits.upper * scale
        if math.isinf(low) and math.isinf(high):
            out.append("none")
        elif abs(low + high) < 0.05:
            out.append(f"±{high:.4g}{unit}")
        else:
            out.append(f"{low:.4g} to {high:.4g}{unit}")
    return "none" if set(out) == {"none"} else "; ".join(out)
