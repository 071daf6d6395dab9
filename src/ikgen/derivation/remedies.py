"""What would help an unsolved chain: joints held free and smaller tasks, tried one after the other."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from ikgen.derivation.progress import Progress, silent
from ikgen.errors import UnsolvedChainError
from ikgen.model.counted import counted

if TYPE_CHECKING:
    from ikgen.derivation.advice import Attempt
    from ikgen.derivation.held_joints import HeldChoice
    from ikgen.derivation.task_forms import ClosedForm
    from ikgen.emit.derivation import Unsolved
    from ikgen.model.dh import DHChain
    from ikgen.records.request import Request
    from ikgen.tasks import Task

__all__ = ["advised", "helped", "remedies"]

ATTEMPTS = 20
"""No more derivations than these are tried. Their number counts, not the time they take: the hint is part
of the report, which is the same on every machine."""

_ENOUGH = 3
_MOST_HELD = 2


@contextmanager
def advised(request: Request, progress: Progress) -> Iterator[None]:
    """Give the error of an arm without a closed form a hint that was tried."""
    try:
        yield
    except UnsolvedChainError as error:
        raise helped(error, request, progress) from None


def helped(error: UnsolvedChainError, request: Request, progress: Progress) -> UnsolvedChainError:
    """The error with a hint that was tried, the command to type first; as it is where it does not say how
    far it came."""
    if error.unsolved is None:
        return error
    own = _unasked(error.unsolved, request, progress)
    tried = remedies(error.unsolved, progress)
    found = [a for a in tried if a.closed]
    lines = []
    if own is not None:
        lines.append(request.without_task.command())
        most = counted(own.max_solutions, "solution")
        lines.append(f"without a task that is asked for the arm gets '{own.task}' (at most {most})")
    elif found:
        lines.append(found[0].asked(request).command())
    if found:
        lines.append(_closed(found))
    else:
        lines += [line for line in error.hint.splitlines() if line not in lines]
        lines += [f"tried without success: {_listed(tried)}"] * bool(tried)
    better = UnsolvedChainError(
        error.message, unsolved=error.unsolved, details=error.details, hint="\n".join(lines)
    )
    better.warnings = error.warnings
    return better


def _closed(found: list[Attempt]) -> str:
    """The attempts that came to closed forms."""
    words = "; ".join(
        f"{a.options} (at most {counted(a.max_solutions, 'solution')})" for a in found
    )
    lock = any(a.free for a in found)
    more = "; --lock JOINT=VALUE instead of --free makes the joint a constant" if lock else ""
    return f"closed forms were found with: {words}{more}"


def _unasked(unsolved: Unsolved, request: Request, progress: Progress) -> Attempt | None:
    """What is made where no task is asked for, if this is another one than was, and has a closed form."""
    from ikgen.derivation.advice import attempt
    from ikgen.derivation.closed_forms import closed_form
    from ikgen.derivation.task_forms import Demand

    if request.task is None and request.tool_axis is None:
        return None
    progress("try", "the task that fits")
    form = closed_form(unsolved.reading, Demand(None, (), progress))
    made = attempt(form, progress)
    return made if made.closed and made.task != unsolved.task.name else None


def _listed(tried: list[Attempt]) -> str:
    """The attempts, those of a task together."""
    words = []
    for task in dict.fromkeys(a.task for a in tried):
        held = [" and ".join(a.held) for a in tried if a.task == task and a.held]
        words.append(f"--task {task}" + (f" with {', or '.join(held)} held" if held else ""))
    return "; ".join(words)


def remedies(unsolved: Unsolved, progress: Progress) -> list[Attempt]:
    """Derivations that were tried, up to three closed ones or the most attempts, in their order."""
    from ikgen.derivation.advice import attempt
    from ikgen.derivation.task_forms import Demand, by_elimination, task_form

    reading = unsolved.reading
    forms: list[ClosedForm] = []
    found: list[Attempt] = []
    for task, choice in itertools.islice(_choices(unsolved), _most_attempts(reading.dh)):
        closed = [a for a in found if a.closed]
        if len(closed) == _ENOUGH or any(a.task != task.name for a in closed):
            break
        held = () if choice is None else choice.held
        progress("try", " ".join([task.name, *(f"--free {name}" for name in held)]))
        dh = reading.dh if choice is None else choice.dh
        forms.append(task_form(replace(reading, dh=dh), task, silent))
        found.append(replace(attempt(forms[-1], silent), held=held))
    if not any(a.closed for a in found):
        solved = (by_elimination(form, Demand(None, (), progress)) for form in forms)
        first = next((form for form in solved if form.plan is not None), None)
        found += [] if first is None else [attempt(first, progress)]
    return found


def _most_attempts(dh: DHChain) -> int:
    """How many derivations are tried for a chain: fewer where each takes more work."""
    from ikgen.derivation.closed_forms import RULE_TRIES, rule_tries

    return max(1, ATTEMPTS * rule_tries(dh) // RULE_TRIES)


def _choices(unsolved: Unsolved) -> Iterator[tuple[Task, HeldChoice | None]]:
    """The choices of joints to hold that were not tried for the task, then smaller tasks, with as many
    joints held as move in vain (None: none), without those that are refused when asked for or fix more than
    these joints move."""
    from ikgen.derivation.closed_forms import rule_tries
    from ikgen.derivation.held_joints import held_choices
    from ikgen.derivation.held_needs import rounding_decides
    from ikgen.tasks import smaller_tasks
    from ikgen.tasks.fitting import over_constrained

    reading, task = unsolved.reading, unsolved.task
    for choice in held_choices(reading, task)[rule_tries(reading.dh) :]:
        yield task, choice
    for one in smaller_tasks(task.freedoms):
        if rounding_decides(reading.dh, one):
            continue
        choices = held_choices(reading, one)
        if over_constrained(choices[0].dh if choices else reading.dh, one):
            continue
        if not choices:
            yield one, None
        for choice in choices:
            if len(choice.held) <= _MOST_HELD:
                yield one, choice
