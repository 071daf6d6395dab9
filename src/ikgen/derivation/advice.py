"""What `ikgen inspect` advises: quick derivations that tell which task or held joint would do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ikgen.derivation.closed_forms import closed_form, forms_held
from ikgen.derivation.held_joints import HeldChoice, held_choices
from ikgen.derivation.held_needs import needs_held
from ikgen.derivation.progress import Progress
from ikgen.derivation.task_forms import ClosedForm, Demand, as_written
from ikgen.tasks import POSE

if TYPE_CHECKING:
    from ikgen.emit.derivation import Reading
    from ikgen.model.dh import DHChain
    from ikgen.records.request import Request
    from ikgen.solver.solution_graph import SolutionGraph
    from ikgen.tasks import Task

__all__ = ["Attempt", "attempt", "attempts"]

_ENOUGH = 3


@dataclass(frozen=True, slots=True)
class Attempt:
    """One derivation that was tried: which task, which joints held (`held`: beyond those that were
    asked for), and what came of it. `weak` says of each step that fails at some regular configurations
    which it is: such a closed form is verified before it is written, and may be refused then. `implied`
    says whether the task goes without saying, `default` whether this is what is made without options. `dh`
    are the rows that it solves: the file's, or those of geometry nearby that a closed form needs; `ranking`
    is what the joints to hold were ranked by, in order. `two_branch` says whether no step of the rules has
    more than two branches."""

    task: str
    free: tuple[str, ...]
    closed: bool
    max_solutions: int
    order: tuple[str, ...]
    left: tuple[str, ...]
    held: tuple[str, ...] = ()
    weak: tuple[str, ...] = ()
    implied: bool = True
    default: bool = False
    dh: DHChain | None = field(default=None, compare=False, repr=False)
    ranking: str = ""
    two_branch: bool = True

    @property
    def rank(self) -> tuple[bool, bool, int, bool, int]:
        """Closed forms first, those without a weak step, with fewer joints held, of two branches a step,
        with fewer solutions."""
        several = not self.two_branch
        return not self.closed, bool(self.weak), len(self.free), several, self.max_solutions

    @property
    def options(self) -> str:
        """The options to type; empty where none is needed."""
        words = [f"--free {name}" for name in self.free]
        if not self.implied:
            words.append(f"--task {self.task}")
        return " ".join(words)

    def asked(self, request: Request) -> Request:
        """The request that this attempt is."""
        from ikgen.tasks import find_task

        task = None if self.implied and request.task is None else self.task
        axis = request.tool_axis
        if task is not None and (":" in task or not find_task(task).axis):
            axis = None
        free = {name: request.free.get(name) for name in self.free}
        return replace(request, task=task, tool_axis=axis, free=free)


def attempts(
    reading: Reading, asked: str | None, progress: Progress, axis: str | None = None
) -> list[Attempt]:
    """The derivations worth trying for a chain, best first; the asked task alone where one is, else by the
    tool's `axis` where one is asked for.

    Each is what would be generated with its options. Where joints are to be held, the choices in the order
    in which they are taken without options. An arm with fewer joints than a pose has freedoms is tried with
    the tasks that fit, the whole pose among them, and with smaller ones.
    """
    from ikgen.tasks import find_task

    demand = Demand(asked, (), progress, axis=axis)
    choices = held_choices(reading, find_task(asked or POSE.name))
    if choices:
        return _attempts_held(reading, choices, demand)
    progress("derive", asked or "the task that fits")
    taken = attempt(closed_form(reading, demand), progress)
    if asked is not None or reading.dh.moving >= POSE.freedoms:
        return [taken]
    default = taken.closed and not needs_held(reading.dh, find_task(taken.task))
    found = [replace(taken, default=default), *_other_tasks(reading, taken.task, demand)]
    return sorted(found, key=lambda a: (not a.default, a.rank))


def _other_tasks(reading: Reading, taken: str, demand: Demand) -> list[Attempt]:
    """What becomes of the other tasks that fit an arm, and of those with one freedom less."""
    from ikgen.tasks import smaller_tasks
    from ikgen.tasks.fitting import fitting_tasks

    moving = reading.dh.moving
    less = [t for t in smaller_tasks(moving) if t.freedoms == moving - 1]
    found = []
    for task in [*fitting_tasks(reading.dh, demand.axis), *less]:
        if task.name != taken:
            for dh in _held_chains(reading, task):
                names = " ".join([task.name, *(f"hold {name}" for name in dh.free)])
                demand.progress("derive", names)
                asked = replace(demand, task=task.name)
                form = closed_form(replace(reading, dh=dh), asked)
                found.append(attempt(form, demand.progress))
    return found


def _attempts_held(
    reading: Reading, choices: Sequence[HeldChoice], demand: Demand
) -> list[Attempt]:
    """What `closed_form` takes first, then the choices in their order, until enough of them are closed."""
    tried, taken = forms_held(reading, choices, demand, sound=_ENOUGH)
    others = [pair for pair in tried if taken is None or pair[0].held != taken[0].held]
    forms = [(choice, as_written(form, demand)) for choice, form in others]
    found = [
        replace(attempt(form, demand.progress), held=choice.held, ranking=choice.ranking)
        for choice, form in (forms if taken is None else [taken, *forms])
    ]
    first = replace(found[0], default=found[0].closed and bool(found[0].held))
    return [first, *found[1:]]


def _held_chains(reading: Reading, task: Task) -> list[DHChain]:
    """The chain with as many joints held as move the task in vain; none where too many would be."""
    spare = reading.dh.moving - task.freedoms
    if spare <= 0:
        return [reading.dh]
    choices = held_choices(reading, task)
    return [choice.dh for choice in choices if len(choice.held) == spare == 1]


def attempt(form: ClosedForm, progress: Progress) -> Attempt:
    """What a derivation came to: what would be generated of it, where it is closed."""
    from ikgen.derivation.settled_form import settled_form
    from ikgen.emit.solver_module import is_rounded, most_rows

    most, order, left = 0, form.graph.order, form.graph.open_joints
    if form.closed or form.plan is not None:
        form, program = settled_form(form, progress)
        rounded = is_rounded(form.reading.dh, form.plan)
        most, order, left = most_rows(program.max_solutions, rounded), form.graph.order, ()
    graph, task, dh = form.graph, form.task, form.reading.dh
    if form.plan is not None:
        order = (f"all joints at once (general {form.plan.routine.words} elimination)",)
    return Attempt(
        task.name,
        dh.free,
        not left,
        most,
        order,
        tuple(dh.joints[j].name for j in left),
        weak=_weak_steps(graph) if form.closed and form.plan is None else (),
        implied=task.whole_pose and dh.moving >= POSE.freedoms,
        dh=dh,
        two_branch=form.plan is not None or form.two_branch,
    )


def _weak_steps(graph: SolutionGraph) -> tuple[str, ...]:
    """The steps that make a solution graph unsound, in words."""
    if graph.sound:
        return ()
    steps = [s.candidate for s in graph.steps if s.candidate.is_weak and not s.fallbacks]
    return tuple(f"{c.unknown.text} ({c.leaf})" for c in steps) or ("a step",)
