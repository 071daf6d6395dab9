"""What a finished derivation must tell whoever uses it, on stderr and in the JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ikgen.derivation.idle_solved import idle_warning
from ikgen.derivation.lost_freedom import lost_freedom
from ikgen.derivation.tip_on_axis import tip_on_axis
from ikgen.model.counted import counted

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation

__all__ = ["announcements"]


def announcements(derivation: Derivation) -> tuple[str, ...]:
    """What was odd in the file, that the task is not the first that fits, that it asks more than the
    arm can do, or than its name says, that the tip lies on the last axis where the task tells of it, and
    why joints of an arm with six at most are held, and that some which it needs hardly move."""
    reading = derivation.reading
    links = reading.source.has_links
    told = (
        _passed_over(derivation),
        _over_constrained(derivation) or _tilting(derivation),
        tip_on_axis(reading.dh, derivation.task, links) if derivation.chosen else "",
        lost_freedom(reading, (), derivation.held.joints) if derivation.held else "",
        idle_warning(reading.dh, derivation.task),
    )
    return (*reading.source.warnings, *filter(None, told))


def _passed_over(derivation: Derivation) -> str:
    """In words, which tasks the chosen one stands in for; "" where it is the first."""
    if not derivation.passed_over:
        return ""
    names = " and ".join(f"'{name}'" for name in derivation.passed_over)
    fits = "fits" if len(derivation.passed_over) == 1 else "fit"
    return (
        f"code for {names}, which {fits} the arm better, failed its verification: what was made is for "
        f"the task '{derivation.task.name}'"
    )


def _tilting(derivation: Derivation) -> str:
    """In words, that a heading has its tilt in it; "" where it has not."""
    from ikgen.tasks.fitting import freedoms_fixed

    dh, task = derivation.reading.dh, derivation.task
    if freedoms_fixed(dh, task) == task.freedoms:
        return ""
    return (
        f"the joints tilt the axis whose heading the task '{task.name}' reads: in a pose the heading is as "
        "long as the tilt leaves it, so the tilt counts too"
    )


def _over_constrained(derivation: Derivation) -> str:
    """In words, what a task that fixes more freedoms than the joints move means; "" where it does not."""
    from ikgen.derivation.held_needs import needs_held
    from ikgen.tasks.fitting import fitting_tasks, freedoms_fixed, over_constrained

    dh, task = derivation.reading.dh, derivation.task
    if not over_constrained(dh, task):
        return ""
    moving, fixed = dh.moving, freedoms_fixed(dh, task)
    other = next((t.name for t in fitting_tasks(dh) if not t.whole_pose), "")
    smaller = f"--task {other} asks what the arm can do everywhere; " if other else ""
    if derivation.chosen:
        smaller = "No task that so many joints fit has a verified closed form here; "
        if not other:
            smaller = "No smaller task asks for just what the joints can move; "
    elif needs_held(dh, task):
        these = " ".join(f"--free {name}" for name in dh.free)
        smaller += f"without {these} there is a task that all its joints can do; "
    return (
        f"OVER-CONSTRAINED: the task '{task.name}' fixes {fixed} freedoms and "
        f"{counted(moving, 'joint move')}: solve() answers only poses that the arm can take to rounding, "
        f"and no others. {smaller}"
        "solve(pose, project=True) answers with the nearest pose that the arm can take"
    )
