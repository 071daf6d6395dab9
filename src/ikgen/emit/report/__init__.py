"""The derivation report: how the inverse kinematics was found, as LaTeX and as HTML."""

from __future__ import annotations

from collections.abc import Mapping

from ikgen.emit.report.behavior import behavior_section
from ikgen.emit.report.document import Block, Heading
from ikgen.emit.report.elimination import elimination_section
from ikgen.emit.report.html import to_html
from ikgen.emit.report.latex import to_latex
from ikgen.emit.report.normal import Normalizer
from ikgen.emit.report.picture import draw
from ikgen.emit.report.poses import versions_of
from ikgen.emit.report.results import graph_section, poses_section, verification_section
from ikgen.emit.report.sections import forward_section, robot_section
from ikgen.emit.report.splits import splits_section
from ikgen.emit.report.steps import Writer, abbreviations, derived_section, step_section
from ikgen.pipeline import Derivation
from ikgen.verify.report import VerificationReport

__all__ = ["emit_report"]


def emit_report(
    derivation: Derivation, reports: Mapping[str, VerificationReport] | None = None
) -> dict[str, str]:
    """File name -> text: `<name>_report.tex`, `<name>_report.html` and `<name>_graph.svg`.

    `reports` are verifications by language, for a table at the end.
    """
    name = derivation.module.name
    graph = derivation.graph
    normal, versions = Normalizer(), versions_of(graph)
    drawing = draw(graph, versions, f"Solution graph of {name}")
    writer = Writer(graph, versions, normal, abbreviations(graph, normal))
    blocks: list[Block] = [*robot_section(derivation), *forward_section(derivation, normal)]
    blocks.append(Heading(("Inverse kinematics",)))
    if graph.open_joints:
        blocks += elimination_section()
    else:
        blocks += splits_section(graph.session.system)
        for number, step in enumerate(graph.steps, start=1):
            blocks += step_section(writer, number, step)
        blocks += derived_section(writer)
        blocks += graph_section(versions, drawing, graph.passed)
        blocks += poses_section(derivation, versions)
    blocks += behavior_section(graph)
    blocks += verification_section(reports or {})
    title = f"Inverse kinematics of {derivation.reading.dh.robot}"
    module = derivation.module
    subtitle = f"derived by ikgen {module.generator_version} from {module.source_name}"
    return {
        f"{name}_report.tex": to_latex(title, subtitle, blocks),
        f"{name}_report.html": to_html(title, subtitle, blocks),
        f"{name}_graph.svg": drawing.svg,
    }
