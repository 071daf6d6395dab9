"""Checks on what must be among the answers: nothing missing, nothing dropped, the right status."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.checks import LIMIT_TOLERANCE
from ikgen.verify.completeness import FOUND_TOLERANCE, sensitivity
from ikgen.verify.search import CONVERGED, find_solutions
from ikgen.verify.shared_work import SharedWork
from ikgen.verify.trials import Trial, nearest, result, spell
from ikgen.verify.verification_report import CheckResult

__all__ = [
    "check_exhaustive", "check_limit_choice", "check_singular_answers", "check_status",
    "check_unreachable",
]  # fmt: skip


def check_exhaustive(
    arm: ArmUnderTest,
    trial: Trial,
    starts: int,
    rng: np.random.Generator,
    shared: SharedWork | None = None,
) -> CheckResult:
    """Every regular solution that a numerical search finds is among the rows (`limits=False`), to what the
    residual that the search ends with moves it."""
    sample = trial.sample
    found = (shared or SharedWork()).once(
        "search", lambda: find_solutions(arm, sample.poses, sample.q, starts, rng)
    )
    count = failures = 0
    case = ""
    regular = arm.regular_above()
    for i, q in enumerate(found):
        solutions = _distinct(arm, q[arm.sigma(q) > regular])
        if not len(solutions):
            continue
        off = nearest(arm, solutions[None], trial.rows.q[i : i + 1])[0]
        # beside a fold the singular value where the search ends is up to twice the mean on its way on
        ended = sensitivity(arm, solutions).moved(2.0 * CONVERGED)
        missed = off > np.maximum(FOUND_TOLERANCE, ended)
        count, failures = count + len(solutions), failures + int(missed.sum())
        if missed.any() and not case:
            case = spell(sample.label, i, missed=solutions[missed], pose=sample.poses[i])
    detail = f"{len(found)} poses, {starts} starts each"
    names = [name for name, x in zip(arm.oracle.joint_names, arm.different, strict=True) if x]
    if names:
        detail += f"; values of {', '.join(names)} inside the limits"
    return result("exhaustive search", count, failures, detail=detail, worst_case=case)


def _distinct(arm: ArmUnderTest, q: Array) -> Array:
    """The rows of q (N, dof) that differ from all that were kept before."""
    known = q[:0]
    while len(q):
        known, q = np.vstack([known, q[:1]]), q[arm.distance(q, q[0]) > FOUND_TOLERANCE]
    return known


def check_singular_answers(arm: ArmUnderTest, trials: Sequence[Trial]) -> CheckResult:
    """At and near singular poses, seeded with the generating configuration, at least one row
    comes."""
    count = failures = 0
    case, off = "", [np.inf]
    for trial in trials:
        empty = trial.rows.count == 0
        count, failures = count + len(trial.rows), failures + int(empty.sum())
        gap = nearest(arm, trial.sample.q[:, None], trial.rows.q)[:, 0]
        off = [*off, *gap[~empty]]
        if empty.any() and not case:
            i = int(np.argmax(empty))
            case = spell(trial.sample.label, i, q=trial.sample.q[i], pose=trial.sample.poses[i])
    near = int(np.sum(np.array(off) < 1e-3))
    detail = f"seed itself among the rows (to 1e-3) in {near} of {count}"
    return result("singular poses", count, failures, detail=detail, worst_case=case)


def _bring_inside(arm: ArmUnderTest, q: Array, margin: float | Array) -> NDArray[np.bool_]:
    """Which rows (…, dof) some whole turns bring inside the limits by more than `margin`."""
    margin = margin * arm.unit_of(q)
    low, high = arm.lower + margin, arm.upper - margin
    period = np.where(np.isfinite(arm.period), arm.period, 0.0)
    turns = np.ceil((np.where(np.isfinite(low), low, q) - q) / arm.period)
    turned = q + period * turns
    return np.asarray(np.all((turned >= low) & (turned <= high), axis=-1))


def check_limit_choice(arm: ArmUnderTest, limited: Trial, unlimited: Trial) -> CheckResult:
    """Rows with limits are those without that whole turns bring inside; the same poses, two
    answers.

    Poses with rows on a continuum are left out: the free value there may be chosen differently.
    """
    plain = ~(np.any(limited.rows.singular, axis=1) | np.any(unlimited.rows.singular, axis=1))
    a, b = limited.rows.q[plain], unlimited.rows.q[plain]
    extra = limited.rows.mask[plain] & (nearest(arm, a, b) > FOUND_TOLERANCE)
    expected = unlimited.rows.mask[plain] & _bring_inside(arm, b, LIMIT_TOLERANCE)
    dropped = expected & (nearest(arm, b, a) > FOUND_TOLERANCE)
    count = int(limited.rows.mask[plain].sum() + expected.sum())
    case = ""
    for name, wrong, rows in (("dropped", dropped, b), ("not without limits", extra, a)):
        if wrong.any():
            k = int(np.argmax(wrong.any(axis=1)))
            case = spell(f"{limited.sample.label}, {name}", k, rows=rows[k][wrong[k]])
    return result("choice by limits", count, int(extra.sum() + dropped.sum()), worst_case=case)


def check_status(pairs: Sequence[tuple[Trial, Trial]]) -> CheckResult:
    """OK goes with rows, LIMITS with rows that only `limits=False` returns; pairs are (with,
    without).

    All poses are reachable, so no other status is right where `limits=False` returns rows.
    """
    count = failures = 0
    case = ""
    for limited, unlimited in pairs:
        for i, status in enumerate(limited.rows.status):
            other = bool(unlimited.rows.count[i])
            expected = "OK" if limited.rows.count[i] else "LIMITS" if other else "UNREACHABLE"
            fits = status == expected and unlimited.rows.status[i] == (
                "OK" if other else "UNREACHABLE"
            )
            failures += not fits
            if not fits and not case:
                case = spell(f"{limited.sample.label}, {status}", i, pose=limited.sample.poses[i])
        count += len(limited.rows)
    return result("status", count, failures, worst_case=case)


def check_unreachable(arm: ArmUnderTest, trials: Sequence[Trial]) -> CheckResult:
    """Poses out of reach get no row and say so; LIMITS is right too where a slide might go
    further."""
    allowed = {"UNREACHABLE"} if np.all(arm.revolute) else {"UNREACHABLE", "LIMITS"}
    count = failures = 0
    case = ""
    for trial in trials:
        for i, status in enumerate(trial.rows.status):
            wrong = bool(trial.rows.count[i]) or status not in allowed
            failures += wrong
            if wrong and not case:
                case = spell(f"{trial.sample.label}, {status}", i, pose=trial.sample.poses[i])
        count += len(trial.rows)
    detail = "" if count else "not applicable: this task has no pose that is surely out of reach"
    return result("unreachable poses", count, failures, detail=detail, worst_case=case)
