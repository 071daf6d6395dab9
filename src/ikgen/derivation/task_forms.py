"""What the rules, or an elimination, make of a chain whose held joints are settled."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ikgen.derivation.progress import Progress
from ikgen.emit.derivation import Held, Reading

if TYPE_CHECKING:
    from ikgen.elimination import EliminationPlan
    from ikgen.equations.knowledge import Variable
    from ikgen.model.dh import DHChain
    from ikgen.solver.solution_graph import SolutionGraph
    from ikgen.tasks import Task

__all__ = [
    "ClosedForm",
    "Demand",
    "as_written",
    "best_task",
    "by_elimination",
    "by_rules",
    "chain_of_task",
    "task_form",
]


@dataclass(frozen=True, slots=True)
class Demand:
    """What a closed form is sought for: the task asked for (None: what fits), tasks that are not to be
    chosen, where to tell the progress, choices of joints to hold that the verification refused, and the
    tool's axis that a task which fits goes by (None: the one that suits)."""

    task: str | None
    passed_over: Collection[str]
    progress: Progress
    refused: tuple[tuple[str, ...], ...] = ()
    axis: str | None = None


@dataclass(frozen=True, slots=True)
class ClosedForm:
    """How a chain is solved: by `graph`, or by the elimination's `plan` where there is one; not at all
    where neither does. `held` tells the joints that were chosen to be held; `reading` has them."""

    reading: Reading
    task: Task
    graph: SolutionGraph
    plan: EliminationPlan | None = None
    held: Held | None = None

    @property
    def closed(self) -> bool:
        """Whether the rules solve every joint."""
        return not self.graph.open_joints

    @property
    def sound(self) -> bool:
        """Whether they do at all regular configurations."""
        return self.closed and self.graph.sound

    @property
    def two_branch(self) -> bool:
        """Whether no step of the rules has more than two branches."""
        return all(step.branches <= 2 for step in self.graph.steps)


def best_task(reading: Reading, demand: Demand, short: float | None = None) -> ClosedForm:
    """The asked task; without one the task that fits the arm best and has a closed form: by the rules, or
    by an elimination before the whole pose, which fewer joints than six can take here and there only.
    `short`: as for `task_form`."""
    from ikgen.tasks import find_task
    from ikgen.tasks.fitting import default_tasks

    dh = reading.dh
    if demand.task:
        tasks = [find_task(demand.task)]
    else:
        default = default_tasks(dh, demand.axis)
        tasks = [task for task in default if task.name not in demand.passed_over]
    first: ClosedForm | None = None
    for task in tasks:
        if first is not None and task.whole_pose:
            first = by_elimination(first, demand)
            if first.plan is not None:
                return first
        form = task_form(reading, task, demand.progress, short)
        if form.closed:
            return form
        first = first or form
    assert first is not None
    return first


def chain_of_task(dh: DHChain, task: Task, short: float | None = None) -> DHChain:
    """The chain as a task is solved: base and tool are as exact as the rows where equations have them,
    lengths up to `short` (m) zero."""
    from ikgen.kinematics.exact_ends import with_exact_ends

    if task.whole_pose:
        return dh
    return with_exact_ends(dh) if short is None else with_exact_ends(dh, length_tolerance=short)


def task_form(
    reading: Reading, task: Task, progress: Progress, short: float | None = None
) -> ClosedForm:
    """What the rules make of a task, closed or not; `short`: lengths (m) of the tool that count as zero,
    others than usual."""
    dh = chain_of_task(reading.dh, task, short)
    return ClosedForm(replace(reading, dh=dh), task, by_rules(dh, task, progress))


def by_rules(
    dh: DHChain,
    task: Task,
    progress: Progress,
    passed_over: Collection[Variable] = (),
    among: Collection[str] | None = None,
) -> SolutionGraph:
    """What the rules make of a chain; unknowns that are `passed_over` are not to be the first that is
    solved with branches, `among` are the labels of the only equations to look at."""
    from ikgen.solver.solve import solve_chain

    return solve_chain(
        dh,
        readable=task.readable,
        tool_on_right=not task.whole_pose,
        progress=lambda text: progress("derive", text),
        passed_over=passed_over,
        among=among,
    )


def by_elimination(form: ClosedForm, demand: Demand) -> ClosedForm:
    """The form with the plan of an elimination where one applies: of a whole pose, or of a position with
    the direction of one of the tool's axes."""
    from ikgen.elimination import elimination_plan
    from ikgen.tasks import AXES

    task = form.task
    pointing = task.position and task.orientation == "direction"
    if form.plan is not None or not (task.whole_pose or pointing):
        return form
    demand.progress("derive", "elimination")
    tool = AXES.index(task.axis) if pointing else None
    return replace(form, plan=elimination_plan(form.reading.dh, tool))


def as_written(form: ClosedForm, demand: Demand) -> ClosedForm:
    """A closed form of rows nearer to the file's; one that is not closed as it is."""
    from ikgen.derivation.as_written import solve_as_written

    if not form.closed:
        return form
    dh, graph = solve_as_written(
        form.reading.dh,
        form.graph,
        lambda dh, among: by_rules(dh, form.task, demand.progress, among=among),
        whole_pose=form.task.whole_pose,
    )
    return replace(form, reading=replace(form.reading, dh=dh), graph=graph)
