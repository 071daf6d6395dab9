"""The verification of one emitted module against the oracle: all checks, in one report."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ikgen.model.arrays import Array
from ikgen.model.dh import ARM_ANGLE_IDENTIFIER
from ikgen.runtime.python.held.arm_angle import ArmAngle
from ikgen.tasks import find_task
from ikgen.verify import checks, completeness, coverage, interface_checks
from ikgen.verify.agreement import check_agreement
from ikgen.verify.answers import Answers, collect_answers
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.motion_checks import motion_checks, regular_motions
from ikgen.verify.oracle import Oracle
from ikgen.verify.runners.runner import MovingRunner, Rows, Runner
from ikgen.verify.sampling import SampleSet, generator
from ikgen.verify.shared_work import SharedWork
from ikgen.verify.task_space import TaskSpace, task_space
from ikgen.verify.trials import Trial, run_trial
from ikgen.verify.verification_report import CheckResult, SigmaBand, VerificationReport

__all__ = ["Progress", "verify"]


Progress = Callable[[str, int, int], None]
"""Called with what comes next, how many steps are done, and how many there are."""

_STARTS = 200  # of the numerical search, per pose


def _plan(
    runner: Runner,
    arm: ArmUnderTest,
    answers: Answers,
    single: Rows,
    survey: completeness.Survey,
    seed: int,
    peer: Runner | None,
    shared: SharedWork,
) -> dict[str, Callable[[], CheckResult]]:
    """The checks by name, in the order of the report; `single` are the rows of the ordered poses, free
    joints at their defaults."""
    a, random = answers, answers.limited.sample
    rng = generator(seed, "search")
    agreement: dict[str, Callable[[], CheckResult]] = {}
    if peer is not None:
        agreement[f"agreement with {peer.label}"] = lambda: check_agreement(
            arm, a.unlimited, peer.label, _unlimited(peer, arm, random, shared)
        )
    return {
        "constants": lambda: interface_checks.check_constants(arm, runner, a.unlimited.rows),
        "forward": lambda: interface_checks.check_forward(runner, random),
        "jacobian": lambda: interface_checks.check_jacobian(arm, runner, a.ordered.sample),
        "closure": lambda: checks.check_closure(arm, a.reachable),
        "completeness": lambda: completeness.check_completeness(survey),
        "poses answered": lambda: completeness.check_answered(survey),
        "exhaustive search": lambda: coverage.check_exhaustive(
            arm, a.searched, _STARTS, rng, shared
        ),
        "distinct rows": lambda: checks.check_distinct(arm, a.reachable),
        "status": lambda: coverage.check_status([(a.limited, a.unlimited), a.outside]),
        "inside limits": lambda: checks.check_inside_limits(arm, a.reachable),
        "choice by limits": lambda: coverage.check_limit_choice(arm, a.limited, a.unlimited),
        "singular poses": lambda: coverage.check_singular_answers(arm, a.seeded),
        "singular flags": lambda: checks.check_singular_flags(arm, [a.limited, *a.seeded]),
        "seed order": lambda: checks.check_seed_order(a.ordered, a.seeds),
        "free joints": lambda: checks.check_free_joints(arm, a.reachable),
        "unreachable poses": lambda: coverage.check_unreachable(arm, a.unreachable),
        "invalid poses": lambda: interface_checks.check_invalid(arm, runner, random.poses[0]),
        "bad shapes": lambda: interface_checks.check_shapes(arm, runner, random.poses[0]),
        "solve_batch": lambda: interface_checks.check_batch(arm, runner, a.ordered.sample, single),
        "determinism": lambda: interface_checks.check_determinism(*a.repeated),
        **_motion_checks(runner, arm, seed),
        **agreement,
    }


def _unlimited(peer: Runner, arm: ArmUnderTest, random: SampleSet, shared: SharedWork) -> Trial:
    """What another language has for the random poses without limits: known where it was verified before."""
    return shared.once(peer, lambda: run_trial(peer, arm, random, limits=False))


def _motion_checks(
    runner: Runner, arm: ArmUnderTest, seed: int
) -> dict[str, Callable[[], CheckResult]]:
    """The checks of code that has paths, searches and intervals."""
    if not isinstance(runner, MovingRunner) or not runner.moves:
        return {}
    return motion_checks(arm, runner, regular_motions(arm, generator(seed, "motions")))


def _guarded(name: str, check: Callable[[], CheckResult]) -> CheckResult:
    """The check's result; what the emitted code raises is a failure of the check, not of ikgen."""
    try:
        return check()
    except Exception as error:
        return CheckResult(name, False, 1, 1, detail=f"{type(error).__name__}: {error}")


def _histogram(answers: Answers) -> tuple[tuple[int, int], ...]:
    counts, poses = np.unique(answers.unlimited.rows.count, return_counts=True)
    return tuple((int(c), int(n)) for c, n in zip(counts, poses, strict=True))


@dataclass(frozen=True, slots=True)
class _Findings:
    """What the checks found."""

    results: tuple[CheckResult, ...]
    histogram: tuple[tuple[int, int], ...] = ()
    bands: tuple[SigmaBand, ...] = ()
    by_default: tuple[int, int] = (0, 0)


def _by_default(runner: Runner, arm: ArmUnderTest, answers: Answers) -> Rows:
    """The rows of the ordered poses, free joints at their defaults: those of `limited` are at the values
    of the configurations."""
    sample = answers.ordered.sample
    if arm.held:
        return runner.solve_many(sample.poses)
    return answers.limited.rows.at(np.arange(len(sample)))


def _run_checks(
    runner: Runner,
    arm: ArmUnderTest,
    samples: int,
    seed: int,
    peer: Runner | None,
    progress: Progress | None,
    shared: SharedWork | None = None,
) -> _Findings:
    """All results; one failed result if solving raises."""
    shared = shared or SharedWork()
    if progress:
        progress("solving", 0, 1)
    try:
        answers = collect_answers(runner, arm, samples, seed, shared)
        survey = completeness.survey(arm, runner, answers.standing)
        single = _by_default(runner, arm, answers)
        shared.once(runner, lambda: answers.unlimited)
    except Exception as error:
        what = f"solve raises {type(error).__name__}: {error}"
        return _Findings((CheckResult("runs", False, 1, 1, detail=what),))
    plan = _plan(runner, arm, answers, single, survey, seed, peer, shared)
    results = []
    for done, (name, check) in enumerate(plan.items(), start=1):
        if progress:
            progress(name, done, len(plan) + 1)
        results.append(_guarded(name, check))
    answered = (int((single.count > 0).sum()), len(single.count)) if arm.held else (0, 0)
    return _Findings(tuple(results), _histogram(answers), survey.bands, answered)


def verify(
    runner: Runner,
    oracle: Oracle,
    *,
    task: str | None = None,
    samples: int = 1000,
    seed: int = 0,
    locked: Mapping[str, float] | None = None,
    free_joints: Sequence[str] | None = None,
    angle: ArmAngle | None = None,
    limits: tuple[Array, Array] | None = None,
    peer: Runner | None = None,
    progress: Progress | None = None,
    shared: SharedWork | None = None,
) -> VerificationReport:
    """Check the emitted code behind `runner` against `oracle`.

    `samples` random poses (and smaller special sets in proportion) drawn from `seed`. `task`,
    `free_joints` and `limits` (lower, upper; rad or m) are what the arm was generated for: by
    default what the module itself says; `angle` is the arm angle where the last of them is that.
    `peer` is the same solver in another language, which must answer alike. `locked` (already in the
    oracle) is recorded. `shared` is that of the verifications of the same arm in other languages, with the
    same samples. Raises `UnknownNameError` for an unknown task; whatever the emitted code does
    wrong is in the report.
    """
    start = time.perf_counter()
    name = runner.constants.task if task is None else task
    space = task_space(find_task(name))
    found = _Findings(_mismatch(runner, oracle, angle))
    if not found.results:
        arm = _arm(runner, oracle, space, free_joints, angle, limits)
        found = _run_checks(runner, arm, samples, seed, peer, progress, shared)
    links, held = (oracle.base_link, oracle.tip_link), tuple((locked or {}).items())
    seconds = time.perf_counter() - start
    return VerificationReport(
        runner.label, *links, name, samples, seed, found.results, found.histogram, oracle.notes, held,
        seconds, found.bands, found.by_default,
    )  # fmt: skip


def _arm(
    runner: Runner,
    oracle: Oracle,
    task: TaskSpace,
    free_joints: Sequence[str] | None,
    angle: ArmAngle | None,
    limits: tuple[Array, Array] | None,
) -> ArmUnderTest:
    """The arm as asked for, and where nothing was, as the module itself says."""
    constants = runner.constants
    held = constants.free_joints if free_joints is None else tuple(free_joints)
    bounds = (constants.lower, constants.upper) if limits is None else limits
    return arm_under_test(oracle, task, bounds, held, angle)


def _mismatch(runner: Runner, oracle: Oracle, angle: ArmAngle | None) -> tuple[CheckResult, ...]:
    """A failed check of the constants where the module is of another chain, so nothing can be
    run."""
    ours, theirs = runner.constants.joint_names, oracle.joint_names
    bounds = runner.constants.lower.shape == runner.constants.upper.shape == (len(ours),)
    held = () if angle is None else (ARM_ANGLE_IDENTIFIER,)
    known = set(runner.constants.free_joints) <= {*ours, *held}
    if len(ours) == len(theirs) and bounds and known:
        return ()
    detail = f"joints {', '.join(ours)} instead of {', '.join(theirs)}"
    if len(ours) == len(theirs):
        detail = "limits of a wrong shape, or free joints that are no joints"
    return (CheckResult("constants", False, 1, 1, detail=detail),)
