"""Joints that are held by request although the arm needs them for what nobody asked for."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING

from ikgen.errors import UnsolvedChainError

if TYPE_CHECKING:
    from ikgen.generation.request import Request
    from ikgen.model.dh import DHChain
    from ikgen.tasks import Task

__all__ = ["check_held", "needs_held"]


def needs_held(dh: DHChain, task: Task) -> bool:
    """Whether the joints that are held would move freedoms of the task that the others do not."""
    from ikgen.tasks.fitting import freedoms_moved

    if not dh.free:
        return False
    return freedoms_moved(replace(dh, free=()), task) > freedoms_moved(dh, task)


def check_held(request: Request, dh: DHChain, task: Task, passed_over: Collection[str]) -> None:
    """Raises `UnsolvedChainError` where a task that nobody asked for needs joints that the request holds:
    no task that the others can do has a closed form, and the whole pose answers hardly any."""
    from ikgen.tasks.fitting import fitting_tasks

    if request.task is not None or not request.free or not needs_held(dh, task):
        return
    moving, held = dh.dof - len(dh.free), " and ".join(f"'{name}'" for name in dh.free)
    tried = [f"'{t.name}'" for t in fitting_tasks(dh, request.tool_axis) if not t.whole_pose]
    failed = ", ".join(f"'{name}'" for name in passed_over)
    causes = [f"none has a closed form: {', '.join(tried)}"] if tried else ["there is none"]
    causes += [f"code for {failed} failed its verification"] if failed else []
    without = replace(request, free={}).command()
    asked = replace(request, task=task.name).command()
    raise UnsolvedChainError(
        f"no closed form found for a task that {moving} joints can do, with {held} held: "
        f"{'; '.join(causes)}",
        hint=f"hold none of them: {without}\nor take the poses that the arm can take with them held, and "
        f"the nearest of these by solve(pose, project=True): {asked}",
    )
