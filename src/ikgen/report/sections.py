"""The sections of a report in their order, one row each: functions from the page to its blocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ikgen.report.behavior import behavior_section
from ikgen.report.card_section import card_section
from ikgen.report.document import Block, Heading
from ikgen.report.elimination_section import elimination_section
from ikgen.report.example_section import example_section
from ikgen.report.held_section import held_section
from ikgen.report.leftover import leftover_section
from ikgen.report.opening import forward_section, robot_section
from ikgen.report.page import Page, SolvedPage, UnsolvedPage
from ikgen.report.proof_section import proof_section
from ikgen.report.results import graph_section, poses_section, verification_section
from ikgen.report.roots_picture import loop_order, roots_blocks
from ikgen.report.splits import splits_section
from ikgen.report.steps import Writer, abbreviations, derived_section, step_section
from ikgen.verify.verification_report import VerificationReport

__all__ = ["SOLVED", "UNSOLVED"]


def _card(page: SolvedPage) -> list[Block]:
    most = f"at most {page.derivation.module.max_solutions} a pose"
    return _arm(page, most, page.reports)


def _unsolved_card(page: UnsolvedPage) -> list[Block]:
    return _arm(page, "no closed form was found", {})


def _arm(page: Page, most: str, reports: Mapping[str, VerificationReport]) -> list[Block]:
    arm = (page.reading, page.geometry, page.task, page.shown)
    return card_section(*arm, most, reports, page.again)


def _held(page: SolvedPage) -> list[Block]:
    if page.example is None or page.solver is None:
        return []
    return held_section(page.derivation, page.example, page.solver)


def _example(page: SolvedPage) -> list[Block]:
    if page.example is None:
        return []
    return example_section(page.reading.dh, page.example, f"{page.derivation.module.name}_ik")


def _robot(page: Page) -> list[Block]:
    return robot_section(page.reading, page.task)


def _forward(page: Page) -> list[Block]:
    return forward_section(page.graph, page.normal)


def _inverse(page: Page) -> list[Block]:
    """How the equations are made, then one step a solved unknown."""
    graph = page.graph
    names = abbreviations(graph, page.normal)
    writer = Writer(graph, graph.workspace(), page.versions, page.normal, names)
    blocks: list[Block] = [Heading(("Inverse kinematics",), anchor="inverse")]
    blocks += splits_section(writer.known.equations)
    for number, step in enumerate(graph.steps, start=1):
        blocks += step_section(writer, number, step)
    return blocks + derived_section(writer)


def _solution(page: SolvedPage) -> list[Block]:
    if not page.eliminated:
        return _inverse(page)
    blocks: list[Block] = [Heading(("Inverse kinematics",), anchor="inverse")]
    plan = page.derivation.module.plan
    if plan is not None:
        slides, order = plan.turning.count(False), loop_order(page.reading.dh, plan)
        blocks += elimination_section(
            slides,
            order,
            parallel=plan.parallel is not None,
            coupled=plan.degree,
            both=plan.both,
            share=plan.share,
        )
        if page.example is not None:
            blocks += roots_blocks(page.reading.dh, plan, page.example)
    return blocks


def _graph(page: Page) -> list[Block]:
    """Nothing where no unknown was solved alone."""
    if page.picture is None:
        return []
    return graph_section(page.versions, page.picture, page.graph.passed)


def _sets(page: SolvedPage) -> list[Block]:
    return [] if page.eliminated else poses_section(page.graph, page.versions)


def _left(page: UnsolvedPage) -> list[Block]:
    return leftover_section(page.graph)


def _tree(page: Page) -> list[Block]:
    return behavior_section(page.graph)


def _proof(page: SolvedPage) -> list[Block]:
    return proof_section(page.derivation)


def _verification(page: SolvedPage) -> list[Block]:
    return verification_section(page.reports)


SOLVED: tuple[Callable[[SolvedPage], list[Block]], ...] = (
    _card, _held, _example, _robot, _forward, _solution, _graph, _sets, _tree, _proof,
    _verification,
)  # fmt: skip
"""Sections on a solved arm; one that does not apply is empty."""

UNSOLVED: tuple[Callable[[UnsolvedPage], list[Block]], ...] = (
    _unsolved_card, _robot, _forward, _inverse, _graph, _left, _tree,
)  # fmt: skip
"""Sections on an arm without a closed form."""
