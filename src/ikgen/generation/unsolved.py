"""The error of a chain without a closed form: the cause first, the equations last."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

from ikgen.errors import UnsolvedChainError
from ikgen.kinematics.classify import same_line_as_previous
from ikgen.report.leftover import leftover_text

if TYPE_CHECKING:
    from ikgen.emit.derivation import Unsolved
    from ikgen.generation.request import Request
    from ikgen.model.dh import DHChain
    from ikgen.tasks import Task

__all__ = ["unsolved_error"]


def unsolved_error(found: Unsolved, request: Request) -> UnsolvedChainError:
    """The error of a chain without a closed form: why in one line, what to type, and in its details what
    was solved and what is left."""
    dh, task, graph = found.reading.dh, found.task, found.graph
    left = ", ".join(dh.joints[j].name for j in graph.open_joints)
    details = (
        f"solved {', '.join(graph.order) or 'nothing'}; left are the joints {left}",
        *leftover_text(graph),
    )
    cause, advice = _same_line(dh) or _counted(dh, task)
    return UnsolvedChainError(
        f"no closed form found for the task '{task.name}': {cause}",
        unsolved=found,
        details=details,
        hint=f"{request.command()} {advice}",
    )


def _counted(dh: DHChain, task: Task) -> tuple[str, str]:
    """What the numbers of joints and of freedoms tell, and what to add to the command."""
    moving = dh.dof - len(dh.free)
    move = f"{moving} joint{' moves' if moving == 1 else 's move'}"
    if moving > task.freedoms:
        count = moving - task.freedoms
        these = "one of them has" if count == 1 else f"{count} of them have"
        cause = f"{move} and the task fixes {task.freedoms} freedoms: {these} to be held"
        return cause, " ".join(["--free JOINT"] * count)
    if moving < task.freedoms:
        cause = f"{move} and the task fixes {task.freedoms} freedoms: more than the arm can do"
        return cause, "--task TASK, with a smaller task"
    return (
        "the rules and the elimination leave joints open",
        "--free JOINT, or --task TASK; `ikgen report` shows what is left",
    )


def _same_line(dh: DHChain) -> tuple[str, str] | None:
    """What to do about two moving revolute axes on one line; None where there are none."""
    for one, two in itertools.pairwise(dh.rows):
        names = [dh.joints[row.driver].name for row in (one, two)]
        if (
            one.revolute
            and two.revolute
            and same_line_as_previous(two)
            and not set(names) & set(dh.free)
        ):
            cause = (
                f"the joints '{names[0]}' and '{names[1]}' turn about one line, so that every pose has "
                "infinitely many solutions: one of them has to be held"
            )
            return cause, f"--free {names[1]}"
    return None
