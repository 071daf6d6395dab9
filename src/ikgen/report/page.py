"""What the sections of a report are made from: the derivation, and what several of them need of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ikgen.emit.derivation import Derivation, Reading, Unsolved
from ikgen.formulas.normalizer import Normalizer
from ikgen.kinematics.classify import GeometryClass
from ikgen.model.arrays import Array
from ikgen.report.graph_picture import Drawing, draw
from ikgen.report.solution_sets import Versions, versions_of
from ikgen.report.worked_example import (
    WorkedExample,
    shown_configuration,
    solver_of,
    worked_example,
)
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.tasks import Task
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.verification_report import VerificationReport

__all__ = ["Page", "SolvedPage", "UnsolvedPage"]


@dataclass(frozen=True, slots=True)
class Page:
    """What reports of solved and unsolved arms share; `shown` (dof,), rad and m, is the configuration
    that the arm is drawn at; `picture` is that of the graph, None where no unknown was solved alone;
    `again` is the command that makes the report."""

    reading: Reading
    geometry: GeometryClass
    task: Task
    graph: SolutionGraph
    normal: Normalizer
    versions: Versions
    picture: Drawing | None
    shown: Array
    again: str


@dataclass(frozen=True, slots=True)
class UnsolvedPage(Page):
    """An arm without a closed form."""

    @classmethod
    def of(cls, found: Unsolved) -> UnsolvedPage:
        """The page of what a derivation left."""
        versions = versions_of(found.graph)
        title = f"Solution graph of {found.name}"
        picture = draw(found.graph, versions, title) if found.graph.steps else None
        reading, shown = found.reading, shown_configuration(found.reading.dh)
        parts = (Normalizer(), versions, picture, shown, found.again)
        return cls(reading, found.geometry, found.task, found.graph, *parts)


@dataclass(frozen=True, slots=True)
class SolvedPage(Page):
    """A solved arm: `example` and `solver` are there where its lengths have numbers."""

    derivation: Derivation
    reports: Mapping[str, VerificationReport]
    solver: PythonModule | None
    example: WorkedExample | None

    @property
    def eliminated(self) -> bool:
        """Whether no unknown of it can be solved alone."""
        return bool(self.graph.open_joints)

    @classmethod
    def of(cls, found: Derivation, reports: Mapping[str, VerificationReport]) -> SolvedPage:
        """The page of a derivation with the verifications by language."""
        versions = versions_of(found.graph)
        title = f"Solution graph of {found.module.name}"
        picture = None if found.graph.open_joints else draw(found.graph, versions, title)
        solver = solver_of(found)
        example = worked_example(found, solver) if solver is not None else None
        shown = shown_configuration(found.reading.dh) if example is None else example.q
        parts = (Normalizer(), versions, picture, shown, found.again)
        own = (found, reports, solver, example)
        return cls(found.reading, found.geometry, found.task, found.graph, *parts, *own)
