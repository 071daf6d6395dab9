"""The flow from a robot file to verified outputs, one function a stage."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen import __version__
from ikgen.emit.derivation import Derivation, Reading, Unsolved
from ikgen.model.module_name import identifier

if TYPE_CHECKING:
    from ikgen.elimination import UniversalPlan
    from ikgen.emit.solver_module import SolverModule
    from ikgen.model.dh import DHChain
    from ikgen.solver.solution_graph import SolutionGraph
    from ikgen.tasks import Task

__all__ = [
    "Derivation",
    "Progress",
    "Reading",
    "Request",
    "Unsolved",
    "derive",
    "read",
]

Progress = Callable[[str, str], None]


@dataclass(frozen=True, slots=True)
class Request:
    """What the user asked for: one robot file or DH table, one chain, one task."""

    robot: Path
    base: str | None = None
    tip: str | None = None
    task: str | None = None
    free: tuple[tuple[str, float | None], ...] = ()
    locked: Mapping[str, float] = field(default_factory=dict)
    arguments: Mapping[str, str] = field(default_factory=dict)
    package_paths: tuple[Path, ...] = ()
    name: str | None = None


def _quiet(stage: str, detail: str) -> None:
    """No progress."""


def read(request: Request) -> Reading:
    """Read the file, choose the chain and convert it to modified DH form."""
    free = tuple(name for name, _ in request.free)
    if request.robot.suffix == ".toml":
        from ikgen.importers.dh.dh_table import read_dh_table

        source, dh = read_dh_table(request.robot, free=free, locked=request.locked)
        return Reading(source, None, None, dh)
    from ikgen.chains.selection import select_chain
    from ikgen.importers import load_tree
    from ikgen.kinematics.modified_dh import to_dh

    tree = load_tree(
        request.robot, arguments=request.arguments, package_paths=request.package_paths
    )
    chain = select_chain(tree, request.base, request.tip, dict(request.locked))
    return Reading(tree.source, tree, chain, to_dh(chain, free=free))


def derive(
    request: Request, progress: Progress = _quiet, passed_over: Collection[str] = ()
) -> Derivation:
    """From the file to a solver module, not yet written or verified.

    `passed_over` names tasks that are not to be chosen for the arm.
    """
    from ikgen.kinematics.classify import classify
    from ikgen.kinematics.free_joints import free_defaults

    progress("read", request.robot.name)
    reading = read(request)
    held = free_defaults(reading.dh, request.free)  # before the search: some values are refused
    geometry = classify(reading.dh)
    progress("derive", geometry.name)
    task, graph = _solve(reading.dh, request.task, progress, passed_over)
    if graph.open_joints and reading.chain is not None:
        nearby = _nearby(reading)
        other_task, other = _solve(nearby.dh, request.task, progress, passed_over)
        if not other.open_joints:
            reading, task, graph = nearby, other_task, other
            geometry = classify(reading.dh)
    closed = not graph.open_joints and graph.sound  # else solutions may be missing at regular poses
    plan = None if closed else _elimination(reading.dh, task, progress)
    if graph.open_joints and plan is None:
        from ikgen.generation.unsolved import unsolved_error

        name = request.name or identifier(reading.dh.robot)
        raise unsolved_error(Unsolved(reading, geometry, task, graph, name, request.robot.name))
    module = _module(request, reading, task, geometry.words, graph, plan, held)
    return Derivation(reading, geometry, task, graph, module, request.task is None)


NEARBY = 5e-4
"""Lengths (m) that may count as zero where the file's own geometry has no closed form: Newton steps on
the file's chain follow (offsets of 0.2 mm in a wrist that is meant to be spherical are real)."""


def _nearby(reading: Reading) -> Reading:
    """The chain in DH form with short offsets taken as zero."""
    from ikgen.kinematics.modified_dh import to_dh

    assert reading.chain is not None
    dh = to_dh(reading.chain, free=reading.dh.free, length_tolerance=NEARBY)
    return replace(reading, dh=dh)


def _solve(
    dh: DHChain, asked: str | None, progress: Progress, passed_over: Collection[str]
) -> tuple[Task, SolutionGraph]:
    """The asked task; without one the task that fits the arm best and has a closed form."""
    from ikgen.tasks import find_task, fitting_tasks

    fitting = [task for task in fitting_tasks(dh) if task.name not in passed_over]
    tasks = [find_task(asked)] if asked else fitting
    first: tuple[Task, SolutionGraph] | None = None
    for task in tasks:
        graph = _attempt(dh, task, progress)
        if not graph.open_joints:
            return task, graph
        first = first or (task, graph)
    assert first is not None
    return first


def _elimination(dh: DHChain, task: Task, progress: Progress) -> UniversalPlan | None:
    """The general 6R elimination's plan where it applies."""
    if not task.whole_pose:
        return None
    from ikgen.elimination import elimination_plan

    progress("derive", "6R elimination")
    return elimination_plan(dh)


def _attempt(dh: DHChain, task: Task, progress: Progress) -> SolutionGraph:
    from ikgen.solver.solve import solve_chain

    return solve_chain(
        dh,
        readable=task.readable,
        tool_on_right=not task.whole_pose,
        progress=lambda text: progress("derive", text),
    )


def _module(
    request: Request,
    reading: Reading,
    task: Task,
    geometry: str,
    graph: SolutionGraph,
    plan: UniversalPlan | None,
    held: tuple[float, ...],
) -> SolverModule:
    from ikgen.emit.solver_module import SolverModule
    from ikgen.lowering.elimination_program import elimination_program
    from ikgen.lowering.lower import lower

    dh = reading.dh
    return SolverModule(
        name=request.name or identifier(dh.robot),
        program=elimination_program(dh)
        if plan
        else lower(graph, model_error=2.0 * max(dh.deviation)),
        dh=dh,
        task=task.name,
        free=tuple(j for j, joint in enumerate(dh.joints) if joint.name in dh.free),
        free_defaults=held,
        source_name=request.robot.name,
        source_sha256=reading.source.sha256,
        generator_version=__version__,
        geometry=geometry,
        order=("all joints (6R elimination)",) if plan else graph.order,
        plan=plan,
    )
