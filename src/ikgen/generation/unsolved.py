"""The error of a chain without a closed form, with what would help."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

from ikgen.errors import UnsolvedChainError
from ikgen.kinematics.classify import same_line_as_previous
from ikgen.report.leftover import leftover_text

if TYPE_CHECKING:
    from ikgen.emit.derivation import Unsolved
    from ikgen.model.dh import DHChain
    from ikgen.tasks import Task

__all__ = ["unsolved_error"]


def unsolved_error(found: Unsolved) -> UnsolvedChainError:
    """The error of a chain without a closed form: what was solved, what is left, what would help."""
    dh, task, graph = found.reading.dh, found.task, found.graph
    solved = ", ".join(graph.order)
    left = ", ".join(dh.joints[j].name for j in graph.open_joints)
    lines = [
        f"no closed form found for the task '{task.name}': solved {solved or 'nothing'}; "
        f"left are the joints {left}",
        *leftover_text(graph),
    ]
    hint = _redundancy(dh) or _count_hint(dh, task)
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


def _redundancy(dh: DHChain) -> str:
    """What to do about two moving revolute axes on one line; "" where there are none."""
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
