"""The closed form of a chain: its task, the joints to hold, and which solver does it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby, zip_longest
from typing import TYPE_CHECKING

from ikgen.derivation.held_joints import (
    DIVIDING,
    NEARBY,
    HeldChoice,
    held_choices,
    nearby,
)
from ikgen.derivation.task_forms import (
    ClosedForm,
    Demand,
    as_written,
    best_task,
    by_elimination,
    chain_of_task,
)
from ikgen.emit.derivation import Held, Reading
from ikgen.errors import UsageError
from ikgen.model.dh import ARM_ANGLE_OPTION
from ikgen.tasks import POSE, POSITION, find_task

if TYPE_CHECKING:
    from ikgen.model.dh import DHChain

__all__ = [
    "COARSE",
    "RULE_TRIES",
    "closed_form",
    "forms_held",
    "rule_tries",
]

HeldForm = tuple[HeldChoice, ClosedForm]
"""Joints to hold, and what the rules make of the others."""

RULE_TRIES = 8
"""No more choices of joints to hold than these are derived. Their number counts, not the time they take:
the same input gives the same choice on every machine."""

_FULL_TRIES_JOINTS = 8
"""Longer chains get fewer tries, as the work of one grows with the cube of their joints."""

COARSE = 5e-4
"""Deviation (rad, or m over the arm's length) from which on an elimination of the file's own geometry comes
before rules of one nearby: of several offsets that each are short, say."""

_OTHERS = 3


def closed_form(reading: Reading, demand: Demand) -> ClosedForm:
    """The chain's best closed form; joints that move the task in vain are held, chosen by
    `held_choices`."""
    if reading.dh.arm_angle:
        return _with_arm_angle(reading, demand)
    choices = held_choices(reading, find_task(demand.task or POSE.name))
    choices = tuple(choice for choice in choices if choice.held not in demand.refused)
    if choices:
        return _with_joints_held(reading, choices, demand)
    found = _nearest_form(_by_rules_somewhere(reading, demand), reading.dh, demand)
    return _position_instead(reading, found, demand) or found


def _position_instead(reading: Reading, found: ClosedForm, demand: Demand) -> ClosedForm | None:
    """The position alone, with joints held, where nobody asked for a task and the arm can do none that
    takes all its joints: it can be anywhere, and take hardly any whole pose. None where that is no way
    out."""
    from ikgen.tasks.fitting import freedoms_moved, over_constrained

    task, dh = POSITION, reading.dh
    free_to_choose = demand.task is None and demand.axis is None and not dh.free
    if (
        not free_to_choose
        or task.name in demand.passed_over
        or not over_constrained(dh, found.task)
    ):
        return None
    if not task.freedoms == freedoms_moved(dh, task) < dh.dof:
        return None
    form = closed_form(reading, replace(demand, task=task.name))
    return form if form.closed else None


def _nearest_form(form: ClosedForm, read: DHChain, demand: Demand) -> ClosedForm:
    """The form of rows nearer to the file's; with an elimination's plan where one applies and it is not
    sound, or coarse."""
    written = as_written(form, demand)
    coarse = not written.sound or _is_coarse(written, read)
    return by_elimination(written, demand) if coarse else written


def _is_coarse(form: ClosedForm, read: DHChain) -> bool:
    """Whether the solved geometry is off the file's by so much that rows start far from its solutions: a
    quartic's roots, which lie in pairs, in the wrong one; where offsets that were `read` count as zero,
    many poses are looked at closely. What a calibration moves is no such offset."""
    from ikgen.kinematics.axis_relations import reach

    dh = form.reading.dh
    length, angle = dh.deviation
    simpler = not form.two_branch or _zeros(dh) > _zeros(read)
    return form.closed and simpler and max(length / reach(dh), angle) > COARSE


def _zeros(dh: DHChain) -> int:
    """How many lengths of the rows are zero."""
    return sum(length.value == 0.0 for row in dh.rows for length in (row.a, row.d))


def _with_arm_angle(reading: Reading, demand: Demand) -> ClosedForm:
    """What the rules make of an arm whose arm angle is held. Raises UsageError for a task that is not the
    pose. The rows stay as they were read: the arm angle is theirs."""
    if demand.task not in (None, POSE.name):
        raise UsageError(
            f"--free {ARM_ANGLE_OPTION}: the task '{demand.task}' does not fix the whole pose",
            hint="leave out --task, or --free",
        )
    return best_task(reading, demand)


def _by_rules_somewhere(reading: Reading, demand: Demand) -> ClosedForm:
    """What the rules make of the file's geometry; of one nearby where its own has no closed form, or a
    quartic of lengths so short that it divides by little."""
    from ikgen.kinematics.axis_relations import reach

    found = best_task(reading, demand)
    if found.closed and found.two_branch:
        return found
    short = min(DIVIDING * reach(reading.dh), NEARBY) if found.closed else NEARBY
    other = nearby(reading, short)
    if other is None or _is_solved(other, found, short):
        return found
    near = best_task(replace(reading, dh=other), demand, short)
    if found.closed:
        return near if near.closed and near.two_branch and near.task == found.task else found
    return near if near.closed else found


def _is_solved(other: DHChain, found: ClosedForm, short: float) -> bool:
    """Whether the geometry nearby is that which was solved."""
    ends = chain_of_task(other, found.task, short)
    return other.rows == found.reading.dh.rows and bool(
        (ends.X_tip == found.reading.dh.X_tip).all()
    )


def _with_joints_held(
    reading: Reading, choices: Sequence[HeldChoice], demand: Demand
) -> ClosedForm:
    """The first choice that the rules solve, two-branch forms before quartics; else the first that the
    elimination solves; else one with a weak step. None: the chain as it was asked for, unsolved."""
    tried, taken = forms_held(reading, choices, demand)
    if taken is None:
        return replace(min(tried, key=_preferred)[1], reading=reading)
    choice, form = taken
    return _explained(form, choice, choices, demand.refused)


def forms_held(
    reading: Reading, choices: Sequence[HeldChoice], demand: Demand, *, sound: int = 1
) -> tuple[list[HeldForm], HeldForm | None]:
    """What the rules make of the choices, in their order, and which is taken, settled: None where no joint
    held gives a closed form. They are tried till none that is left can be taken, and till so many are
    `sound`: how many are asked for does not change what is taken."""
    tried: list[HeldForm] = []
    tries = choices[: rule_tries(reading.dh)]
    for choice, later in zip_longest(tries, tries[1:]):
        demand.progress("derive", f"holding {choice.words}")
        tried.append((choice, _by_rules_somewhere(replace(reading, dh=choice.dh), demand)))
        best = min(tried, key=_preferred)
        settled = later is not None and best[1].sound and _preferred(best) <= _hoped(later)
        if settled and sum(form.sound for _, form in tried) >= sound:
            break
    return tried, _taken_form(sorted(tried, key=_preferred), demand)


def _taken_form(tried: Sequence[HeldForm], demand: Demand) -> HeldForm | None:
    """Which of the forms, best first, is taken, settled; None where no joint held gives one. Those that
    solve for a joint which hardly moves come after all others."""
    for _, alike in groupby(tried, key=lambda pair: len(pair[0].idle)):
        taken = _taken_of(list(alike), demand)
        if taken is not None:
            return taken
    return None


def _taken_of(tried: Sequence[HeldForm], demand: Demand) -> HeldForm | None:
    """The choice to take of those that hold as many joints which hardly move. Of eliminations the first
    that is as quick at special values of the held joints as elsewhere."""
    choice, form = tried[0]
    if form.sound:
        return choice, _nearest_form(form, choice.dh, demand)
    solved: HeldForm | None = None
    for other, open_form in tried:
        found = by_elimination(open_form, demand)
        if found.plan is None:
            continue
        if found.plan.steady:
            return other, found
        solved = solved or (other, found)
    return solved or ((choice, as_written(form, demand)) if form.closed else None)


def rule_tries(dh: DHChain) -> int:
    """How many choices of joints to hold are derived for a chain, from 1 to `RULE_TRIES`."""
    return max(1, min(RULE_TRIES, RULE_TRIES * _FULL_TRIES_JOINTS**3 // dh.dof**3))


def _preferred(held: HeldForm) -> tuple[int, bool, bool, bool, bool]:
    """What comes first of forms in the order of their choices: those that hold most joints which hardly
    move; of these sound ones, then those with a weak step; of either those that are not feeble, and of
    these those with two branches a step where the class lets expect them."""
    from ikgen.kinematics.form_class import is_two_branch

    choice, form = held
    as_expected = is_two_branch(choice.form) and form.two_branch
    return -len(choice.idle), not form.sound, not form.closed, choice.feeble, not as_expected


def _hoped(choice: HeldChoice) -> tuple[int, bool, bool, bool, bool]:
    """The best preference that a form of a choice can have."""
    from ikgen.kinematics.form_class import is_two_branch

    return -len(choice.idle), False, False, choice.feeble, not is_two_branch(choice.form)


def _explained(
    form: ClosedForm,
    taken: HeldChoice,
    choices: Sequence[HeldChoice],
    refused: tuple[tuple[str, ...], ...],
) -> ClosedForm:
    """The form with the joints that it holds, why, and the runners-up."""
    if form.plan is not None:
        why = f"the general {form.plan.routine.words} elimination"
    elif form.sound:
        why = f"closed form by rules ({taken.class_words})"
    else:
        why = "closed form by rules, with a weak step,"
    others = [choice for choice in choices if choice.held != taken.held][:_OTHERS]
    behind = tuple(choice.behind(taken) for choice in others)
    names = tuple(choice.held for choice in others)
    shared = _shared(form.reading, taken)
    held = Held(taken.held, why, names, refused, behind, shared, taken.idle)
    return replace(form, held=held)


def _shared(reading: Reading, taken: HeldChoice) -> tuple[str, ...]:
    """The joints that move with this choice and carry other arms of the robot too, base to tip."""
    from ikgen.chains.arms import candidate_chains

    if reading.tree is None or reading.chain is None:
        return ()
    names = [joint.name for joint in reading.dh.joints]
    others = [arm.joints for arm in candidate_chains(reading.tree) if names[-1] not in arm.joints]
    carried = {name for joints in others for name in joints}
    return tuple(name for name in names if name in carried and name not in taken.held)
