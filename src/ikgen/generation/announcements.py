"""What a finished derivation must tell whoever uses it, on stderr and in the JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["announcements"]


def announcements(derivation: Derivation) -> tuple[str, ...]:
    """What was odd in the file, and that the task asks more than the arm can do."""
    narrow = _over_constrained(derivation)
    return (*derivation.reading.source.warnings, *([narrow] if narrow else []))


def _over_constrained(derivation: Derivation) -> str:
    """In words, what a task that fixes more freedoms than the joints move means; "" where it does not."""
    from ikgen.tasks.fitting import fitting_tasks, over_constrained

    dh, task = derivation.reading.dh, derivation.task
    if not over_constrained(dh, task):
        return ""
    moving = dh.dof - len(dh.free)
    other = next((t.name for t in fitting_tasks(dh) if not t.whole_pose), "")
    smaller = f"--task {other} asks what the arm can do everywhere; " if other else ""
    if derivation.chosen:
        smaller = "no smaller task has a verified closed form here; "
    return (
        f"OVER-CONSTRAINED: the task '{task.name}' fixes {task.freedoms} freedoms and {moving} joints "
        f"move: solve() answers only poses that the arm can take to rounding, and no others. {smaller}"
        "solve(pose, project=True) answers with the nearest pose that the arm can take"
    )
