"""What `ikgen inspect` advises: quick derivations that tell which task or held joint would do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ikgen.generation.closed_forms import ClosedForm, Demand, forms_held, preference
from ikgen.generation.held_joints import HeldChoice, held_choices
from ikgen.generation.progress import Progress

if TYPE_CHECKING:
    from ikgen.emit.derivation import Reading
    from ikgen.generation.request import Request
    from ikgen.model.dh import DHChain
    from ikgen.solver.solution_graph import SolutionGraph
    from ikgen.tasks import Task

__all__ = ["Attempt", "attempt", "attempts", "eliminations"]

_POSE_FREEDOMS = 6
_ENOUGH = 3


@dataclass(frozen=True, slots=True)
class Attempt:
    """One derivation that was tried: which task, which joints held (`held`: beyond those that were
    asked for), and what came of it. `weak` says of each step that fails at some regular configurations
    which it is: such a closed form is verified before it is written, and may be refused then. `implied`
    says whether the task goes without saying, `default` whether this is what is made without options."""

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

    @property
    def rank(self) -> tuple[bool, bool, int, bool, int]:
        """Closed forms first, those without a weak step, with fewer joints held, without a quartic, with
        fewer solutions."""
        quartic = any("quartic" in step for step in self.order)
        return not self.closed, bool(self.weak), len(self.free), quartic, self.max_solutions

    @property
    def options(self) -> str:
        """The options to type; empty where none is needed."""
        words = [f"--free {name}" for name in self.free]
        if not self.implied:
            words.append(f"--task {self.task}")
        return " ".join(words)

    def asked(self, request: Request) -> Request:
        """The request that this attempt is."""
        task = None if self.implied and request.task is None else self.task
        free = {name: request.free.get(name) for name in self.free}
        return replace(request, task=task, free=free)


def attempts(reading: Reading, asked: str | None, progress: Progress) -> list[Attempt]:
    """The derivations worth trying for a chain, best first; the asked task alone where one is.

    Where joints are to be held, the choices in the order in which they are taken without options. An arm
    with fewer joints than a pose has freedoms is tried with the tasks that fit, the whole pose among
    them, and with smaller ones.
    """
    from ikgen.tasks import TASKS, find_task
    from ikgen.tasks.fitting import fitting_tasks

    demand = Demand(asked, (), progress)
    choices = held_choices(reading, find_task(asked or "pose"))
    if choices:
        return _attempts_held(reading, choices, demand)
    dh = reading.dh
    moving = dh.dof - len(dh.free)
    if asked is not None or moving >= _POSE_FREEDOMS:
        tasks = [find_task(asked or "pose")]
    else:
        less = [t for t in TASKS if t.freedoms == moving - 1 and t.name != "rotation"]
        tasks = [*fitting_tasks(dh), *less]
    found: list[Attempt] = []
    for task in tasks:
        for held_dh in _held_chains(reading, task):
            progress("derive", " ".join([task.name, *(f"hold {name}" for name in held_dh.free)]))
            found.append(attempt(held_dh, task))
    if not any(a.closed for a in found):
        found += eliminations([a for a in found if a.task == "pose"], dh, progress)
    if asked is None and moving < _POSE_FREEDOMS:
        found = _with_default(found, [task.name for task in fitting_tasks(dh)])
    return sorted(found, key=lambda a: a.rank)


def _with_default(found: Sequence[Attempt], fitting: Sequence[str]) -> list[Attempt]:
    """The attempts, the first closed one of the tasks that fit marked as what is taken without options."""
    fits = [a for a in found if a.closed and a.task in fitting]
    first = min(fits, key=lambda a: fitting.index(a.task), default=None)
    return [replace(a, default=a is first) for a in found]


def _attempts_held(
    reading: Reading, choices: Sequence[HeldChoice], demand: Demand
) -> list[Attempt]:
    """Attempts in the order in which `closed_form` prefers them, until enough of them are closed."""
    tried: list[tuple[HeldChoice, ClosedForm]] = []
    for choice, form in forms_held(reading, choices, demand):
        tried.append((choice, form))
        if sum(form.sound for _, form in tried) == _ENOUGH:
            break
    tried.sort(key=lambda pair: preference(*pair))
    found = [
        replace(_attempt_of(form.graph, form.task), held=choice.held) for choice, form in tried
    ]
    if not tried[0][1].sound:
        failed = [a for a in found if a.task == "pose"]
        found = [*eliminations(failed, reading.dh, demand.progress), *found]
    return [replace(a, default=k == 0 and bool(a.held)) for k, a in enumerate(found)]


def _held_chains(reading: Reading, task: Task) -> list[DHChain]:
    """The chain with as many joints held as move the task in vain; none where too many would be."""
    spare = reading.dh.dof - len(reading.dh.free) - task.freedoms
    if spare <= 0:
        return [reading.dh]
    choices = held_choices(reading, task)
    return [choice.dh for choice in choices if len(choice.held) == spare == 1]


def eliminations(failed: list[Attempt], dh: DHChain, progress: Progress) -> list[Attempt]:
    """The first of the failed attempts that an elimination solves; empty if none does."""
    from ikgen.elimination import elimination_plan
    from ikgen.lowering.elimination_program import elimination_name

    for one in failed:
        progress("derive", " ".join(["elimination", *one.free]))
        held = replace(dh, free=one.free)
        plan = elimination_plan(held)
        if plan is not None:
            order = (f"all joints at once (general {elimination_name(held)} elimination)",)
            solved = replace(one, closed=True, max_solutions=plan.most, order=order)
            return [replace(solved, left=(), weak=())]
    return []


def attempt(dh: DHChain, task: Task) -> Attempt:
    """Try one derivation by the rules."""
    from ikgen.solver.solve import solve_chain

    graph = solve_chain(dh, readable=task.readable, tool_on_right=not task.whole_pose)
    return _attempt_of(graph, task)


def _attempt_of(graph: SolutionGraph, task: Task) -> Attempt:
    """What a derivation by the rules came to."""
    dh = graph.dh
    closed = not graph.open_joints
    most = 0
    if closed:
        from ikgen.lowering.lower import lower

        most = lower(graph, model_error=0.0).max_solutions
    return Attempt(
        task.name,
        dh.free,
        closed,
        most,
        graph.order,
        tuple(dh.joints[j].name for j in graph.open_joints),
        weak=_weak_steps(graph) if closed else (),
        implied=task.whole_pose and dh.dof - len(dh.free) >= _POSE_FREEDOMS,
    )


def _weak_steps(graph: SolutionGraph) -> tuple[str, ...]:
    """The steps that make a solution graph unsound, in words."""
    if graph.sound:
        return ()
    steps = [s.candidate for s in graph.steps if s.candidate.is_weak and not s.fallbacks]
    return tuple(f"{c.unknown.text} ({c.leaf})" for c in steps) or ("a step",)
