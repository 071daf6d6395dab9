"""The flow from a robot file to verified outputs, one function a stage."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen import __version__
from ikgen.errors import UnsolvedChainError

if TYPE_CHECKING:
    from ikgen.emit.module import SolverModule
    from ikgen.kinematics.classify import GeometryClass
    from ikgen.model.chain import Chain
    from ikgen.model.dh import DHChain
    from ikgen.model.joint_tree import JointTree, Source
    from ikgen.solver.graph import SolutionGraph
    from ikgen.tasks import Task
    from ikgen.universal import UniversalPlan

__all__ = [
    "Derivation",
    "Progress",
    "Reading",
    "Request",
    "Unsolved",
    "derive",
    "identifier",
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


@dataclass(frozen=True, slots=True)
class Reading:
    """A description as read: its tree and chain (none for a DH table) and the chain in DH form."""

    source: Source
    tree: JointTree | None
    chain: Chain | None
    dh: DHChain


@dataclass(frozen=True, slots=True)
class Derivation:
    """Everything between the file and the emitted text."""

    reading: Reading
    geometry: GeometryClass
    task: Task
    graph: SolutionGraph
    module: SolverModule


@dataclass(frozen=True, slots=True)
class Unsolved:
    """How far a derivation came that found no closed form; `name` is its module's."""

    reading: Reading
    geometry: GeometryClass
    task: Task
    graph: SolutionGraph
    name: str
    source_name: str


def _quiet(stage: str, detail: str) -> None:
    """No progress."""


def read(request: Request) -> Reading:
    """Read the file, choose the chain and convert it to modified DH form."""
    free = tuple(name for name, _ in request.free)
    if request.robot.suffix == ".toml":
        from ikgen.importers.dh_table import read_dh_table

        source, dh = read_dh_table(request.robot, free=free, locked=request.locked)
        return Reading(source, None, None, dh)
    from ikgen.importers import load_tree
    from ikgen.importers.chain import select_chain
    from ikgen.kinematics.modified_dh import to_dh

    tree = load_tree(
        request.robot, arguments=request.arguments, package_paths=request.package_paths
    )
    chain = select_chain(tree, request.base, request.tip, dict(request.locked))
    return Reading(tree.source, tree, chain, to_dh(chain, free=free))


def derive(request: Request, progress: Progress = _quiet) -> Derivation:
    """From the file to a solver module, not yet written or verified."""
    from ikgen.kinematics.classify import classify
    from ikgen.kinematics.free_joints import free_defaults

    progress("read", request.robot.name)
    reading = read(request)
    free_defaults(reading.dh, request.free)  # before the search: some values are refused
    geometry = classify(reading.dh)
    progress("derive", geometry.name)
    task, graph = _solve(reading.dh, request.task, progress)
    if graph.open_joints and reading.chain is not None:
        nearby = _nearby(reading)
        other_task, other = _solve(nearby.dh, request.task, progress)
        if not other.open_joints:
            reading, task, graph = nearby, other_task, other
            geometry = classify(reading.dh)
    plan = _elimination(reading.dh, task, progress) if graph.open_joints else None
    if graph.open_joints and plan is None:
        name = request.name or identifier(reading.dh.robot)
        raise unsolved(Unsolved(reading, geometry, task, graph, name, request.robot.name))
    return Derivation(
        reading, geometry, task, graph, _module(request, reading, task, geometry.words, graph, plan)
    )


NEARBY = 5e-4
"""Lengths (m) that may count as zero where the file's own geometry has no closed form: Newton steps on
the file's chain follow (offsets of 0.2 mm in a wrist that is meant to be spherical are real)."""


def _nearby(reading: Reading) -> Reading:
    """The chain in DH form with short offsets taken as zero."""
    from ikgen.kinematics.modified_dh import to_dh

    assert reading.chain is not None
    dh = to_dh(reading.chain, free=reading.dh.free, length_tolerance=NEARBY)
    return replace(reading, dh=dh)


def _solve(dh: DHChain, asked: str | None, progress: Progress) -> tuple[Task, SolutionGraph]:
    """The asked task; without one the task that fits the arm best and has a closed form."""
    from ikgen.tasks import find_task, fitting_tasks

    tasks = (find_task(asked),) if asked else fitting_tasks(dh)
    first: tuple[Task, SolutionGraph] | None = None
    for task in tasks:
        graph = _attempt(dh, task, progress)
        if not graph.open_joints and (graph.sound or task is tasks[-1]):
            return task, graph
        first = first or (task, graph)
    assert first is not None
    return first


def _elimination(dh: DHChain, task: Task, progress: Progress) -> UniversalPlan | None:
    """The general 6R elimination's plan where it applies: six moving revolute joints, whole pose."""
    import numpy as np

    moving = dh.dof - len(dh.free)
    turning = all(row.revolute or dh.joints[row.driver].name in dh.free for row in dh.rows)
    plain = len(dh.rows) == dh.dof and turning
    if not (task.whole_pose and moving == 6 and plain):
        return None
    from ikgen.universal import choose_plan, held_frames

    progress("derive", "6R elimination")
    values = (0.4, -1.1, 2.2) if dh.free else (0.0,)
    plan = choose_plan(np.array([held_frames(dh, value) for value in values]))
    return plan if plan.usable else None


def _attempt(dh: DHChain, task: Task, progress: Progress) -> SolutionGraph:
    from ikgen.solver.run import solve_chain

    return solve_chain(
        dh,
        readable=task.readable,
        tool_on_right=not task.whole_pose,
        progress=lambda text: progress("derive", text),
    )


def unsolved(found: Unsolved) -> UnsolvedChainError:
    """The error of a chain without a closed form: what was solved, what is left, what would help."""
    from ikgen.emit.report.leftover import leftover_text

    dh, task, graph = found.reading.dh, found.task, found.graph
    solved = ", ".join(f"{s.candidate.unknown.text} ({s.candidate.leaf})" for s in graph.steps)
    left = ", ".join(dh.joints[j].name for j in graph.open_joints)
    lines = [
        f"no closed form found for the task '{task.name}': solved {solved or 'nothing'}; "
        f"left are the joints {left}",
        *leftover_text(graph),
    ]
    hint = redundancy(dh) or _count_hint(dh, task)
    return UnsolvedChainError("\n".join(lines), unsolved=found, hint=hint)


def _count_hint(dh: DHChain, task: Task) -> str:
    """What the numbers of joints and of freedoms tell."""
    moving = dh.dof - len(dh.free)
    if moving > task.freedoms:
        return (
            f"{moving} joints move but the task '{task.name}' fixes {task.freedoms}: hold "
            f"{moving - task.freedoms} of them free (--free JOINT) or lock them "
            "(--lock JOINT=VALUE)"
        )
    if moving < task.freedoms:
        return f"{moving} joints move: try a smaller task (--task)"
    return (
        "hold a joint free (--free JOINT), lock one (--lock JOINT=VALUE), or ask for less (--task)"
    )


def redundancy(dh: DHChain) -> str:
    """What to do about two moving revolute axes on one line; "" where there are none."""
    from ikgen.kinematics.classify import same_line_as_previous

    for one, two in itertools.pairwise(dh.rows):
        names = [dh.joints[row.driver].name for row in (one, two)]
        if (
            one.revolute
            and two.revolute
            and same_line_as_previous(two)
            and not set(names) & set(dh.free)
        ):
            return (
                f"the joints '{names[0]}' and '{names[1]}' turn about one line: every pose has infinitely "
                f"many solutions; hold one of them free (--free {names[1]}) or lock it"
            )
    return ""


def _module(
    request: Request,
    reading: Reading,
    task: Task,
    geometry: str,
    graph: SolutionGraph,
    plan: UniversalPlan | None,
) -> SolverModule:
    from ikgen.emit.module import SolverModule
    from ikgen.ir.elimination import elimination_program
    from ikgen.ir.lower import lower
    from ikgen.kinematics.free_joints import free_defaults

    dh = reading.dh
    return SolverModule(
        name=request.name or identifier(dh.robot),
        program=elimination_program(dh) if plan else lower(graph, slack=2.0 * max(dh.deviation)),
        dh=dh,
        task=task.name,
        free=tuple(j for j, joint in enumerate(dh.joints) if joint.name in dh.free),
        free_defaults=free_defaults(dh, request.free),
        source_name=request.robot.name,
        source_sha256=reading.source.sha256,
        generator_version=__version__,
        geometry=geometry,
        order=("all joints (6R elimination)",) if plan else _order(graph),
        plan=plan,
    )


def _order(graph: SolutionGraph) -> tuple[str, ...]:
    return tuple(f"{s.candidate.unknown.text} ({s.candidate.leaf})" for s in graph.steps)


def identifier(name: str) -> str:
    """A robot's name as a module name: lower case, letters, digits and underscores."""
    text = "".join(ch if ch.isascii() and ch.isalnum() else "_" for ch in name).strip("_").lower()
    return text if text and not text[0].isdigit() else f"robot_{text}".rstrip("_")
