"""From a description to a solver module: task, closed form, lowered program; nothing is written yet."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from ikgen import __version__
from ikgen.derivation.closed_forms import closed_form
from ikgen.derivation.held_needs import check_held, check_task, check_tool_axis
from ikgen.derivation.progress import Progress, silent
from ikgen.derivation.read import default_name, read
from ikgen.derivation.settled_form import settled_form
from ikgen.derivation.task_forms import Demand
from ikgen.emit.derivation import Derivation, Unsolved
from ikgen.records.report_command import report_command

if TYPE_CHECKING:
    from ikgen.derivation.task_forms import ClosedForm
    from ikgen.emit.derivation import Reading
    from ikgen.emit.solver_module import SolverModule
    from ikgen.kinematics.classify import GeometryClass
    from ikgen.program.statements import Program
    from ikgen.records.request import Request

__all__ = ["derive"]


def derive(
    request: Request,
    progress: Progress = silent,
    passed_over: Collection[str] = (),
    reading: Reading | None = None,
    refused: Sequence[tuple[str, ...]] = (),
) -> Derivation:
    """From the file to a solver module, not yet written or verified.

    `passed_over` names tasks that are not to be chosen for the arm, `refused` joints that are not to be
    held together; `reading` is the request's where it was read before. Raises `UnsolvedChainError` where
    there is no closed form, or none of a task that an arm can do whose joints the request holds.
    """
    from ikgen.kinematics.classify import classify
    from ikgen.tasks import find_task

    reading = _checked(request, progress, reading)
    file_class = classify(reading.dh).name
    progress("derive", file_class)
    if request.named_task is not None:
        check_task(request, reading, find_task(request.named_task))
    check_tool_axis(request, reading.dh)
    demand = Demand(request.named_task, passed_over, progress, tuple(refused), request.tool_axis)
    found = closed_form(reading, demand)
    if request.tool_axis is not None:
        found.task.along(request.tool_axis)  # refuses what has no axis
    name = request.name or default_name(found.reading)
    geometry = classify(found.reading.dh)
    if not found.closed and found.plan is None:
        from ikgen.derivation.unsolved import unsolved_error

        raise unsolved_error(_unsolved(name, request, found, geometry), request)
    check_task(request, reading, found.task)
    again = report_command(request, found.reading, found.task)
    check_held(request, found.reading.dh, found.task, passed_over)
    found, program = settled_form(found, progress)
    module = _module(name, request, found, program, geometry)
    unasked = request.task is None
    return Derivation(
        reading=found.reading,
        geometry=geometry,
        task=found.task,
        graph=found.graph,
        module=module,
        again=again,
        chosen=unasked,
        held=found.held,
        passed_over=tuple(passed_over) if unasked else (),
        file_class=file_class,
    )


def _checked(request: Request, progress: Progress, reading: Reading | None) -> Reading:
    """What the request describes, read now where it was not before. Raises `UsageError` for couplings and
    values of held joints that no closed form can have."""
    from ikgen.kinematics.free_joints import free_defaults
    from ikgen.kinematics.whole_turns import check_couplings

    if reading is None:
        progress("read", request.robot.name)
        reading = read(request)
    check_couplings(reading.dh)
    free_defaults(reading.dh, request.free.items())
    return reading


def _unsolved(name: str, request: Request, found: ClosedForm, geometry: GeometryClass) -> Unsolved:
    return Unsolved(
        reading=found.reading,
        geometry=geometry,
        task=found.task,
        graph=found.graph,
        name=name,
        source_name=request.robot.name,
        again=report_command(request, found.reading, found.task),
    )


def _module(
    name: str, request: Request, found: ClosedForm, program: Program, geometry: GeometryClass
) -> SolverModule:
    from ikgen.emit.solver_module import SolverModule
    from ikgen.kinematics.free_joints import free_defaults

    reading, graph, plan = found.reading, found.graph, found.plan
    dh = reading.dh
    return SolverModule(
        name=name,
        program=program,
        dh=dh,
        task=found.task.name,
        free_defaults=free_defaults(dh, request.free.items()),
        source_name=request.robot.name,
        source_sha256=reading.source.sha256,
        generator_version=__version__,
        geometry=geometry.words,
        order=(f"all joints ({plan.routine.words} elimination)",) if plan else graph.order,
        plan=plan,
        maintainer=request.maintainer,
        license=request.license,
        followers=(*reading.followers, *reading.relations),
    )
