"""The closed form of a chain: its task, the joints to hold, and which solver does it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ikgen.emit.derivation import Held, Reading
from ikgen.errors import UsageError
from ikgen.generation.held_joints import HeldChoice, held_choices, nearby
from ikgen.generation.progress import Progress
from ikgen.model.dh import ARM_ANGLE

if TYPE_CHECKING:
    from ikgen.elimination import EliminationPlan
    from ikgen.equations.knowledge import Variable
    from ikgen.model.dh import DHChain
    from ikgen.solver.solution_graph import SolutionGraph
    from ikgen.tasks import Task

__all__ = [
    "RULE_TRIES",
    "ClosedForm",
    "Demand",
    "as_written",
    "by_elimination",
    "by_rules",
    "closed_form",
    "forms_held",
    "preference",
    "rule_tries",
    "taken_form",
    "task_form",
]

RULE_TRIES = 8
"""No more choices of joints to hold than these are derived. Their number counts, not the time they take:
the same input gives the same choice on every machine."""

_FULL_TRIES_JOINTS = 8
"""Longer chains get fewer tries, as the work of one grows with the cube of their joints."""

_OTHERS = 3


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


def closed_form(reading: Reading, demand: Demand) -> ClosedForm:
    """The chain's best closed form; joints that move the task in vain are held, chosen by
    `held_choices`."""
    from ikgen.tasks import find_task

    if reading.dh.arm_angle:
        return _with_arm_angle(reading, demand)
    choices = held_choices(reading, find_task(demand.task or "pose"))
    choices = tuple(choice for choice in choices if choice.held not in demand.refused)
    if choices:
        return _with_joints_held(reading, choices, demand)
    found = as_written(_by_rules_somewhere(reading, demand), demand)
    return found if found.sound else by_elimination(found, demand)


def _with_arm_angle(reading: Reading, demand: Demand) -> ClosedForm:
    """What the rules make of an arm whose arm angle is held. Raises UsageError for a task that is not the
    pose. The rows stay as they were read: the arm angle is theirs."""
    if demand.task not in (None, "pose"):
        raise UsageError(
            f"--free {ARM_ANGLE}: the task '{demand.task}' does not fix the whole pose",
            hint="leave out --task, or --free",
        )
    return _best_task(reading, demand)


def _by_rules_somewhere(reading: Reading, demand: Demand) -> ClosedForm:
    """What the rules make of the file's geometry, or of one nearby where its own has no closed form."""
    found = _best_task(reading, demand)
    other = None if found.closed else nearby(reading)
    if other is None or other.rows == reading.dh.rows:
        return found
    near = _best_task(replace(reading, dh=other), demand)
    return near if near.closed else found


def _with_joints_held(
    reading: Reading, choices: Sequence[HeldChoice], demand: Demand
) -> ClosedForm:
    """The first choice that the rules solve, two-branch forms before quartics; else the first that the
    elimination solves; else one with a weak step. None: the chain as it was asked for, unsolved."""
    tried: list[tuple[HeldChoice, ClosedForm]] = []
    for choice, form in forms_held(reading, choices, demand):
        tried.append((choice, form))
        later = choices[len(tried) :]
        if not later or min(preference(*pair) for pair in tried) <= _hoped(later[0]):
            break
    tried.sort(key=lambda pair: preference(*pair))
    taken = taken_form(tried, demand)
    if taken is None:
        return replace(tried[0][1], reading=reading)
    choice, form = taken
    return _explained(form, choice, choices, demand.refused)


def taken_form(
    tried: Sequence[tuple[HeldChoice, ClosedForm]], demand: Demand
) -> tuple[HeldChoice, ClosedForm] | None:
    """Which of the forms, best first, is taken, settled; None where no joint held gives one."""
    choice, form = tried[0]
    if form.sound:
        return choice, as_written(form, demand)
    for other, open_form in tried:
        solved = by_elimination(open_form, demand)
        if solved.plan is not None:
            return other, solved
    return (choice, as_written(form, demand)) if form.closed else None


def forms_held(
    reading: Reading, choices: Sequence[HeldChoice], demand: Demand
) -> Iterator[tuple[HeldChoice, ClosedForm]]:
    """What the rules make of each choice in turn, of no more than `rule_tries`."""
    for choice in choices[: rule_tries(reading.dh)]:
        demand.progress("derive", f"holding {choice.words}")
        yield choice, _by_rules_somewhere(replace(reading, dh=choice.dh), demand)


def rule_tries(dh: DHChain) -> int:
    """How many choices of joints to hold are derived for a chain, from 1 to `RULE_TRIES`."""
    return max(1, min(RULE_TRIES, RULE_TRIES * _FULL_TRIES_JOINTS**3 // dh.dof**3))


def preference(choice: HeldChoice, form: ClosedForm) -> tuple[bool, bool, bool]:
    """What comes first of forms in the order of their choices: sound ones, then those with a weak step; of
    either those with two branches a step where the class lets expect them."""
    from ikgen.kinematics.form_class import is_two_branch

    as_expected = is_two_branch(choice.form) and form.two_branch
    return not form.sound, not form.closed, not as_expected


def _hoped(choice: HeldChoice) -> tuple[bool, bool, bool]:
    """The best preference that a form of a choice can have."""
    from ikgen.kinematics.form_class import is_two_branch

    return False, False, not is_two_branch(choice.form)


def _explained(
    form: ClosedForm,
    taken: HeldChoice,
    choices: Sequence[HeldChoice],
    refused: tuple[tuple[str, ...], ...],
) -> ClosedForm:
    """The form with the joints that it holds, why, and the runners-up."""
    from ikgen.lowering.elimination_program import elimination_name

    if form.plan is not None:
        why = f"the general {elimination_name(form.reading.dh)} elimination"
    elif form.sound:
        why = f"closed form by rules ({taken.class_words})"
    else:
        why = "closed form by rules, with a weak step,"
    others = [choice for choice in choices if choice.held != taken.held][:_OTHERS]
    behind = tuple(choice.behind(taken) for choice in others)
    held = Held(taken.held, why, tuple(choice.held for choice in others), refused, behind)
    return replace(form, held=held)


def as_written(form: ClosedForm, demand: Demand) -> ClosedForm:
    """The same of rows nearer to the file's, if it is closed."""
    from ikgen.generation.as_written import solve_as_written

    if not form.closed:
        return form
    dh, graph = solve_as_written(
        form.reading.dh,
        form.graph,
        lambda dh, among: by_rules(dh, form.task, demand.progress, among=among),
        whole_pose=form.task.whole_pose,
    )
    return replace(form, reading=replace(form.reading, dh=dh), graph=graph)


def _best_task(reading: Reading, demand: Demand) -> ClosedForm:
    """The asked task; without one the task that fits the arm best and has a closed form: by the rules, or
    by an elimination before the whole pose, which fewer joints than six can take here and there only."""
    from ikgen.tasks import find_task
    from ikgen.tasks.fitting import fitting_tasks

    dh = reading.dh
    if demand.task:
        tasks = [find_task(demand.task)]
    else:
        fitting = fitting_tasks(dh, demand.axis)
        tasks = [task for task in fitting if task.name not in demand.passed_over]
    first: ClosedForm | None = None
    for task in tasks:
        if first is not None and task.whole_pose:
            first = by_elimination(first, demand)
            if first.plan is not None:
                return first
        form = task_form(reading, task, demand.progress)
        if form.closed:
            return form
        first = first or form
    assert first is not None
    return first


def task_form(reading: Reading, task: Task, progress: Progress) -> ClosedForm:
    """What the rules make of a task, closed or not."""
    from ikgen.kinematics.exact_ends import with_exact_ends

    dh = reading.dh if task.whole_pose else with_exact_ends(reading.dh)
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
