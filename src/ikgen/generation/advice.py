"""What `ikgen inspect` advises: quick derivations that tell which task or held joint would do."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ikgen.generation.progress import Progress

if TYPE_CHECKING:
    from ikgen.generation.request import Request
    from ikgen.model.dh import DHChain
    from ikgen.solver.solution_graph import SolutionGraph
    from ikgen.tasks import Task

__all__ = ["Attempt", "attempt", "attempts", "eliminations"]

_POSE_FREEDOMS = 6


@dataclass(frozen=True, slots=True)
class Attempt:
    """One derivation that was tried: which task, which joints held (`held`: beyond those that were
    asked for), and what came of it. `weak` says of each step that fails at some regular configurations
    which it is: such a closed form is verified before it is written, and may be refused then. `implied`
    says whether the task is the one that is taken where none is asked for."""

    task: str
    free: tuple[str, ...]
    closed: bool
    max_solutions: int
    order: tuple[str, ...]
    left: tuple[str, ...]
    held: tuple[str, ...] = ()
    weak: tuple[str, ...] = ()
    implied: bool = True

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


def attempts(dh: DHChain, asked: str | None, progress: Progress) -> list[Attempt]:
    """The derivations worth trying for a chain, best first; the asked task alone where one is.

    A chain with more joints than the task fixes is tried with each one held (two too many: none is
    tried), by the elimination if the rules solve none; one with fewer is tried with the tasks that fit,
    the whole pose among them, and with smaller ones.
    """
    from ikgen.tasks import TASKS, find_task, fits, fitting_tasks

    moving = dh.dof - len(dh.free)
    if asked is not None:
        tasks = [find_task(asked)]
    elif moving >= _POSE_FREEDOMS:
        tasks = [find_task("pose")]
    else:
        less = [t for t in TASKS if t.freedoms == moving - 1 and t.name != "rotation"]
        tasks = [*fitting_tasks(dh), *less]
    found: list[Attempt] = []
    for task in tasks:
        spare = max(moving - task.freedoms, 0)
        held = [j.name for j in dh.joints if j.name not in dh.free] if spare == 1 else [""]
        for name in held if spare in (0, 1) else []:
            held_dh = replace(dh, free=(*dh.free, name)) if name else dh
            if name and not task.whole_pose and not fits(held_dh, task):
                continue
            progress("derive", f"{task.name}, {'hold ' + name if name else 'no joint held'}")
            found.append(attempt(held_dh, task))
    if not any(a.closed for a in found):
        found += eliminations([a for a in found if a.task == "pose"], dh, progress)
    return sorted(found, key=lambda a: a.rank)


def eliminations(failed: list[Attempt], dh: DHChain, progress: Progress) -> list[Attempt]:
    """The first of the failed attempts, joints near the tip held before others, that the general 6R
    elimination solves; empty if it solves none."""
    from ikgen.elimination import elimination_plan
    from ikgen.lowering.elimination_program import MOST_SOLUTIONS

    names = [joint.name for joint in dh.joints]
    for one in sorted(failed, key=lambda a: [-names.index(n) for n in a.free]):
        progress("derive", " ".join(["6R elimination", *one.free]))
        if elimination_plan(replace(dh, free=one.free)) is not None:
            order = ("all joints at once (general 6R elimination)",)
            return [replace(one, closed=True, max_solutions=MOST_SOLUTIONS, order=order, left=())]
    return []


def attempt(dh: DHChain, task: Task) -> Attempt:
    """Try one derivation by the rules."""
    from ikgen.solver.solve import solve_chain

    graph = solve_chain(dh, readable=task.readable, tool_on_right=not task.whole_pose)
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
