"""From a description to a solver module: task, closed form, lowered program; nothing is written yet."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING

from ikgen import __version__
from ikgen.emit.derivation import Derivation, Reading, Unsolved
from ikgen.generation.progress import Progress, silent
from ikgen.generation.read import default_name, read

if TYPE_CHECKING:
    from ikgen.elimination import EliminationPlan
    from ikgen.emit.solver_module import SolverModule
    from ikgen.generation.request import Request
    from ikgen.model.dh import DHChain
    from ikgen.solver.solution_graph import SolutionGraph
    from ikgen.tasks import Task

__all__ = ["derive"]

NEARBY = 5e-4
"""Lengths (m) that may count as zero where the file's own geometry has no closed form: Newton steps on
the file's chain follow (offsets of 0.2 mm in a wrist that is meant to be spherical are real)."""


def derive(
    request: Request,
    progress: Progress = silent,
    passed_over: Collection[str] = (),
    reading: Reading | None = None,
) -> Derivation:
    """From the file to a solver module, not yet written or verified.

    `passed_over` names tasks that are not to be chosen for the arm, `reading` is the request's where it was
    read before. Raises `UnsolvedChainError` where there is no closed form.
    """
    from ikgen.kinematics.classify import classify
    from ikgen.kinematics.free_joints import free_defaults

    if reading is None:
        progress("read", request.robot.name)
        reading = read(request)
    held = free_defaults(reading.dh, request.free.items())  # first: some values are refused
    progress("derive", classify(reading.dh).name)
    reading, task, graph = _solved(reading, request.task, progress, passed_over)
    geometry = classify(reading.dh)
    closed = not graph.open_joints and graph.sound  # else solutions may be missing at regular poses
    plan = None if closed else _elimination(reading.dh, task, progress)
    name = request.name or default_name(reading)
    if graph.open_joints and plan is None:
        from ikgen.generation.unsolved import unsolved_error

        found = Unsolved(reading, geometry, task, graph, name, request.robot.name)
        raise unsolved_error(found, request)
    module = _module(name, request.robot.name, reading, task, graph, plan, held)
    return Derivation(reading, geometry, task, graph, module, request.task is None)


def _solved(
    reading: Reading, asked: str | None, progress: Progress, passed_over: Collection[str]
) -> tuple[Reading, Task, SolutionGraph]:
    """The chain's best closed form, of the file's own constants where they do; that of a nearby geometry
    where its own has none."""
    from ikgen.generation.as_written import solve_as_written

    task, graph = _best_task(reading.dh, asked, progress, passed_over)
    if graph.open_joints and reading.chain is not None:
        nearby = _nearby(reading)
        other_task, other = _best_task(nearby.dh, asked, progress, passed_over)
        if not other.open_joints:
            reading, task, graph = nearby, other_task, other
    if graph.open_joints:
        return reading, task, graph
    dh, graph = solve_as_written(reading.dh, graph, lambda dh: _by_rules(dh, task, progress))
    return replace(reading, dh=dh), task, graph


def _nearby(reading: Reading) -> Reading:
    """The chain in DH form with short offsets taken as zero."""
    from ikgen.kinematics.modified_dh import to_dh

    assert reading.chain is not None
    dh = to_dh(reading.chain, free=reading.dh.free, length_tolerance=NEARBY)
    return replace(reading, dh=dh)


def _best_task(
    dh: DHChain, asked: str | None, progress: Progress, passed_over: Collection[str]
) -> tuple[Task, SolutionGraph]:
    """The asked task; without one the task that fits the arm best and has a closed form."""
    from ikgen.tasks import find_task, fitting_tasks

    fitting = [task for task in fitting_tasks(dh) if task.name not in passed_over]
    tasks = [find_task(asked)] if asked else fitting
    first: tuple[Task, SolutionGraph] | None = None
    for task in tasks:
        graph = _by_rules(dh, task, progress)
        if not graph.open_joints:
            return task, graph
        first = first or (task, graph)
    assert first is not None
    return first


def _by_rules(dh: DHChain, task: Task, progress: Progress) -> SolutionGraph:
    from ikgen.solver.solve import solve_chain

    return solve_chain(
        dh,
        readable=task.readable,
        tool_on_right=not task.whole_pose,
        progress=lambda text: progress("derive", text),
    )


def _elimination(dh: DHChain, task: Task, progress: Progress) -> EliminationPlan | None:
    """The general 6R elimination's plan where it applies."""
    if not task.whole_pose:
        return None
    from ikgen.elimination import elimination_plan

    progress("derive", "6R elimination")
    return elimination_plan(dh)


def _module(
    name: str,
    source_name: str,
    reading: Reading,
    task: Task,
    graph: SolutionGraph,
    plan: EliminationPlan | None,
    held: tuple[float, ...],
) -> SolverModule:
    from ikgen.emit.solver_module import SolverModule
    from ikgen.kinematics.classify import classify
    from ikgen.lowering.elimination_program import elimination_program
    from ikgen.lowering.lower import lower

    dh = reading.dh
    return SolverModule(
        name=name,
        program=elimination_program(dh)
        if plan
        else lower(graph, model_error=2.0 * max(dh.deviation)),
        dh=dh,
        task=task.name,
        free=tuple(j for j, joint in enumerate(dh.joints) if joint.name in dh.free),
        free_defaults=held,
        source_name=source_name,
        source_sha256=reading.source.sha256,
        generator_version=__version__,
        geometry=classify(dh).words,
        order=("all joints (6R elimination)",) if plan else graph.order,
        plan=plan,
    )
