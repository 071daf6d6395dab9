"""The derivation report: how the inverse kinematics was found, as LaTeX and as HTML."""

from __future__ import annotations

from collections.abc import Mapping

from ikgen import __version__
from ikgen.emit.derivation import Derivation, Reading, Unsolved
from ikgen.formulas.normalizer import Normalizer
from ikgen.kinematics.classify import GeometryClass
from ikgen.report.behavior import behavior_section
from ikgen.report.document import Block, Heading, Paragraph
from ikgen.report.elimination_section import elimination_section
from ikgen.report.graph_picture import draw
from ikgen.report.html import to_html
from ikgen.report.latex import to_latex
from ikgen.report.leftover import leftover_section
from ikgen.report.opening import forward_section, robot_section
from ikgen.report.proof_section import proof_section
from ikgen.report.results import graph_section, poses_section, verification_section
from ikgen.report.solution_sets import versions_of
from ikgen.report.splits import splits_section
from ikgen.report.steps import Writer, abbreviations, derived_section, step_section
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.tasks import Task
from ikgen.verify.verification_report import VerificationReport

__all__ = ["emit_report", "emit_unsolved"]


def emit_report(
    derivation: Derivation, reports: Mapping[str, VerificationReport] | None = None
) -> dict[str, str]:
    """File name -> text: `<name>_report.tex`, `<name>_report.html` and `<name>_graph.svg`.

    `reports` are verifications by language, for a table at the end.
    """
    module, graph = derivation.module, derivation.graph
    page = _Page(derivation.reading, derivation.geometry, derivation.task, graph, module.name)
    eliminated = bool(graph.open_joints)
    blocks = page.opening(f"At most {module.max_solutions} solutions a pose.")
    blocks += elimination_section() if eliminated else [*page.steps(), *page.results()]
    blocks += behavior_section(graph)
    blocks += proof_section(derivation)
    blocks += verification_section(reports or {})
    return page.texts(blocks, module.source_name)


def emit_unsolved(found: Unsolved, advice: str = "") -> dict[str, str]:
    """The same files for an arm without a closed form: what was solved, what is left, how near the
    leaves came, and what would help (`advice`)."""
    graph = found.graph
    page = _Page(found.reading, found.geometry, found.task, graph, found.name)
    blocks = page.opening("No closed form was found.")
    blocks += page.steps()
    if graph.steps:
        blocks += page.drawing()
    blocks += leftover_section(graph)
    if advice:
        blocks += [Heading(("What would help",)), Paragraph((f"{advice[0].upper()}{advice[1:]}.",))]
    blocks += behavior_section(graph)
    return page.texts(blocks, found.source_name)


class _Page:
    """The parts of a report that solved and unsolved arms share."""

    def __init__(
        self, reading: Reading, geometry: GeometryClass, task: Task, graph: SolutionGraph, name: str
    ) -> None:
        self.reading, self.geometry, self.task = reading, geometry, task
        self.graph, self.name = graph, name
        self.normal, self.versions = Normalizer(), versions_of(graph)
        self.picture = draw(graph, self.versions, f"Solution graph of {name}")

    def opening(self, most: str) -> list[Block]:
        """The robot and its forward kinematics."""
        robot = robot_section(self.reading, self.geometry, self.task, most)
        return [
            *robot,
            *forward_section(self.graph, self.normal),
            Heading(("Inverse kinematics",)),
        ]

    def steps(self) -> list[Block]:
        """One section a solved unknown."""
        graph = self.graph
        names = abbreviations(graph, self.normal)
        writer = Writer(graph, graph.workspace(), self.versions, self.normal, names)
        blocks = splits_section(writer.known.equations)
        for number, step in enumerate(graph.steps, start=1):
            blocks += step_section(writer, number, step)
        return blocks + derived_section(writer)

    def drawing(self) -> list[Block]:
        """The solution graph."""
        return graph_section(self.versions, self.picture, self.graph.passed)

    def results(self) -> list[Block]:
        """The solution graph and the sets of joint solutions."""
        return [*self.drawing(), *poses_section(self.graph, self.versions)]

    def texts(self, blocks: list[Block], source: str) -> dict[str, str]:
        """File name -> text."""
        title = f"Inverse kinematics of {self.reading.dh.robot}"
        subtitle = f"derived by ikgen {__version__} from {source}"
        return {
            f"{self.name}_report.tex": to_latex(title, subtitle, blocks),
            f"{self.name}_report.html": to_html(title, subtitle, blocks),
            f"{self.name}_graph.svg": self.picture.svg,
        }
