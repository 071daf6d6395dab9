"""The form of which code is emitted: nearest to the file, and with no more solution sets than hold."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ikgen.derivation.task_forms import by_rules

if TYPE_CHECKING:
    from ikgen.derivation.progress import Progress
    from ikgen.derivation.task_forms import ClosedForm
    from ikgen.equations.knowledge import Variable
    from ikgen.program.statements import Program
    from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["settled_form"]


def settled_form(found: ClosedForm, progress: Progress) -> tuple[ClosedForm, Program]:
    """The form that is emitted, and its lowered program."""
    from ikgen.derivation.fewest_sets import with_fewest_sets
    from ikgen.lowering.elimination_program import elimination_program
    from ikgen.lowering.lower import lower
    from ikgen.tasks.fitting import heading_shortened

    dh = found.reading.dh
    if found.plan:
        plan = found.plan
        return found, elimination_program(dh, plan.routine, plan.most, plan.tool)

    def solve(passed_over: tuple[Variable, ...]) -> SolutionGraph:
        return by_rules(dh, found.task, progress, passed_over)

    shortened = heading_shortened(dh, found.task)

    def lowered(graph: SolutionGraph) -> Program:
        return lower(graph, model_error=2.0 * max(dh.deviation), shortened=shortened)

    graph, program = with_fewest_sets(found.graph, lowered, solve)
    return replace(found, graph=graph), program
