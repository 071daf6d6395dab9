"""The error of a chain without a closed form: the cause first, the equations last."""

from __future__ import annotations

import itertools
from collections import Counter
from typing import TYPE_CHECKING

from ikgen.emit.derivation import Unsolved
from ikgen.errors import IkgenError, UnsolvedChainError, VerificationError
from ikgen.kinematics.classify import same_line_as_previous
from ikgen.model.counted import counted, some_of_them
from ikgen.report.leftover import leftover_text

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation
    from ikgen.model.dh import DHChain
    from ikgen.records.request import Request
    from ikgen.tasks import Task

__all__ = ["incomplete_error", "unsolved_error"]

_OF_MISSING_ROWS = {
    "completeness",
    "poses answered",
    "exhaustive search",
    "status",
    "choice by limits",
    "singular poses",
    "paths",
    "search",
    "self motion",
    "agreement",
}
"""Checks that a form which misses rows may fail for it; what fails another one is wrong code."""


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
    hint = f"{request.command()} {advice}"
    if request.task is not None and dh.moving > task.freedoms:
        hint = f"{request.without_task.command()}\nor {hint}"
    return UnsolvedChainError(
        f"no closed form found for the task '{task.name}': {cause}",
        unsolved=found,
        details=details,
        hint=hint,
    )


def incomplete_error(error: VerificationError, request: Request) -> IkgenError:
    """The error of a verification that found rows missing where the form was known not to hold everywhere:
    by a weak step, an elimination that misses some, or with fewer joints than the task fixes. Any other
    failure as it is."""
    derivation: Derivation | None = error.derivation
    failed = {check.name for report in error.reports.values() for check in report.failed}
    kinds = {name.partition(" with ")[0] for name in failed}  # agreement, with which language
    if derivation is None or not failed or not kinds <= _OF_MISSING_ROWS:
        return error
    causes = _known_gaps(derivation)
    if not causes:
        return error
    left = Unsolved(
        derivation.reading,
        derivation.geometry,
        derivation.task,
        derivation.graph,
        derivation.module.name,
        request.robot.name,
        derivation.again,
    )
    return UnsolvedChainError(
        f"no closed form found for the task '{derivation.task.name}' that has all solutions: {causes[0]}",
        unsolved=left,
        details=tuple(report.worst_case for report in error.reports.values()),
        hint=f"{request.command()} --free JOINT, or --task TASK",
    )


def _known_gaps(derivation: Derivation) -> list[str]:
    """Why the form may miss rows, in words; empty where nothing tells."""
    from ikgen.tasks.fitting import freedoms_fixed, over_constrained

    dh, plan = derivation.reading.dh, derivation.module.plan
    found = []
    if over_constrained(dh, derivation.task):
        fixed = freedoms_fixed(dh, derivation.task)
        found.append(f"{counted(dh.moving, 'joint move')} and the task fixes {fixed} freedoms")
    if plan is None and not derivation.graph.sound:
        weak = [step.candidate for step in derivation.graph.steps if not step.sound]
        steps = ", ".join(f"{c.unknown.text} ({c.leaf})" for c in weak)
        found.append(f"the rules leave no other way where {steps} fails")
    if plan is not None and plan.recall < 1.0:
        found.append(f"the elimination finds {plan.recall:.1%} of them")
    return found


def _counted(dh: DHChain, task: Task) -> tuple[str, str]:
    """What the numbers of joints and of freedoms tell, and what to add to the command."""
    from ikgen.elimination.refusal import coupled_refusal
    from ikgen.tasks import POSE
    from ikgen.tasks.fitting import freedoms_moved

    moving = dh.moving
    move = counted(moving, "joint move")
    if moving > task.freedoms:
        count = moving - task.freedoms
        these = some_of_them(count, "has", "have")
        cause = f"{move} and the task fixes {task.freedoms} freedoms: {these} to be held"
        return cause, " ".join(["--free JOINT"] * count)
    if moving < task.freedoms:
        cause = f"{move} and the task fixes {task.freedoms} freedoms: more than the arm can do"
        return cause, "--task TASK, with a smaller task"
    able = freedoms_moved(dh, task)
    if able < moving:
        cause = f"the joints move {able} of the {task.freedoms} freedoms that the task fixes"
        return cause, "--task TASK: `ikgen inspect` lists those that fit"
    refusal = coupled_refusal(dh) if task.name == POSE.name else None
    if refusal is not None:
        cause, name = refusal
        return cause, f"--lock {name}=VALUE, or with followers of smaller ratios"
    return (
        "the rules and the elimination leave joints open",
        "--free JOINT, or --task TASK; `ikgen report` shows what is left",
    )


def _same_line(dh: DHChain) -> tuple[str, str] | None:
    """What to do about two moving revolute axes on one line, each of a joint that moves no other axis; None
    where there are none."""
    moved = Counter(row.driver for row in dh.rows)
    for one, two in itertools.pairwise(dh.rows):
        names = [dh.joints[row.driver].name for row in (one, two)]
        if (
            one.revolute
            and two.revolute
            and same_line_as_previous(two)
            and moved[one.driver] == moved[two.driver] == 1
            and not set(names) & set(dh.free)
        ):
            cause = (
                f"the joints '{names[0]}' and '{names[1]}' turn about one line, so that every pose has "
                "infinitely many solutions: one of them has to be held"
            )
            return cause, f"--free {names[1]}"
    return None
