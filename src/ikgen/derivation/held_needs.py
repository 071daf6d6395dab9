"""Joints that are held by request although the arm needs them for what nobody asked for."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING

from ikgen.errors import UnsolvedChainError
from ikgen.model.counted import counted

if TYPE_CHECKING:
    from ikgen.emit.derivation import Reading
    from ikgen.model.dh import DHChain
    from ikgen.records.request import Request
    from ikgen.tasks import Task

__all__ = ["check_held", "check_task", "check_tool_axis", "needs_held", "rounding_decides"]


def needs_held(dh: DHChain, task: Task) -> bool:
    """Whether the joints that are held would move freedoms of the task that the others do not."""
    from ikgen.tasks.fitting import freedoms_moved

    if not dh.free:
        return False
    return freedoms_moved(replace(dh, free=()), task) > freedoms_moved(dh, task)


def rounding_decides(dh: DHChain, task: Task) -> bool:
    """Whether the arm moves some freedoms of the task only barely, and the others by more joints than they
    need: joints that were held would decide the former, and no path that moves them could be followed."""
    from ikgen.tasks.fitting import freedoms_barely_moved, freedoms_fixed, freedoms_moved

    whole = replace(dh, free=())
    moved, fixed = freedoms_moved(whole, task), freedoms_fixed(whole, task)
    return moved < min(fixed, whole.dof) and bool(freedoms_barely_moved(whole, task))


def check_task(request: Request, reading: Reading, task: Task) -> None:
    """Raises `UnsolvedChainError` for a task, asked for or chosen, of which rounding decides freedoms."""
    from ikgen.tasks.fitting import fitting_tasks, freedoms_fixed, freedoms_moved

    dh = reading.dh
    if not rounding_decides(dh, task):
        return
    whole = replace(dh, free=())
    able = next((t for t in fitting_tasks(whole, request.tool_axis) if not t.whole_pose), None)
    if able is not None:
        other = replace(request, task=able.name, free={})
    else:
        other = replace(request, free={}, lock={**request.lock, **_spare(request, reading, task)})
    moved, fixed = freedoms_moved(whole, task), freedoms_fixed(whole, task)
    raise UnsolvedChainError(
        f"no closed form found for the task '{task.name}': the joints move {moved} of the {fixed} "
        "freedoms that the task fixes, and the others by no more than rounding tilts their axes",
        hint=other.command(),
    )


def _spare(request: Request, reading: Reading, task: Task) -> dict[str, float]:
    """The joints that are held, and those that would be, with the values (rad or m) they would have."""
    from ikgen.derivation.held_joints import held_choices
    from ikgen.kinematics.free_joints import free_defaults

    choices = held_choices(reading, task)
    dh = choices[0].dh if choices else reading.dh
    names = (*request.free, *(choices[0].held if choices else ()))
    values = zip(dh.held, free_defaults(dh, request.free.items()), strict=True)
    return {name: value for name, value in values if name in names}


def check_tool_axis(request: Request, dh: DHChain) -> None:
    """Raises `UsageError` for an axis without a task where the arm moves all of a pose: no other fits."""
    from ikgen.tasks import POSE
    from ikgen.tasks.fitting import freedoms_moved

    pose, axis = POSE, request.tool_axis
    if axis is not None and request.task is None and freedoms_moved(dh, pose) == pose.freedoms:
        pose.along(axis)


def check_held(request: Request, dh: DHChain, task: Task, passed_over: Collection[str]) -> None:
    """Raises `UnsolvedChainError` where a task that nobody asked for needs joints that the request holds:
    no task that the others can do has a closed form, and the whole pose answers hardly any."""
    from ikgen.tasks.fitting import fitting_tasks

    if request.task is not None or not request.free or not needs_held(dh, task):
        return
    moving, held = dh.moving, " and ".join(f"'{name}'" for name in dh.free)
    tried = [f"'{t.name}'" for t in fitting_tasks(dh, request.tool_axis) if not t.whole_pose]
    failed = ", ".join(f"'{name}'" for name in passed_over)
    causes = [f"none has a closed form: {', '.join(tried)}"] if tried else ["there is none"]
    causes += [f"code for {failed} failed its verification"] if failed else []
    without = replace(request, free={}).command()
    asked = replace(request, task=task.name).command()
    raise UnsolvedChainError(
        f"no closed form found for a task that {counted(moving, 'joint')} can do, with {held} held: "
        f"{'; '.join(causes)}",
        hint=f"hold none of them: {without}\nor take the poses that the arm can take with them held, and "
        f"the nearest of these by solve(pose, project=True): {asked}",
    )
