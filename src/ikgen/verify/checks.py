"""Checks on the returned rows themselves: right, distinct, inside limits, flagged and ordered."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.singularities import on_continuum
from ikgen.verify.trials import Trial, nearest, result, spell
from ikgen.verify.verification_report import CheckResult

__all__ = [
    "check_closure", "check_distinct", "check_free_joints", "check_inside_limits",
    "check_seed_order", "check_singular_flags",
]  # fmt: skip


CLOSURE_TOLERANCE = 1e-9
"""m and rad: what "right" means. Of an arm over 1 m long, or of a row with a longer slide, in units of
that length."""

DISTINCT_TOLERANCE = 1e-6  # rad or m: rows closer than this are one solution
LIMIT_TOLERANCE = 1e-6  # rad or m: at a bound, a double root is known to about 1e-8 only
FLAGGED_REGULAR = 1e-2  # smallest singular value above which a singular flag is wrong


def check_closure(arm: ArmUnderTest, trials: Sequence[Trial]) -> CheckResult:
    """Every returned row reproduces its pose by the oracle; it fails when there is no row at
    all."""
    count = failures = 0
    worst_p = worst_r = worst = 0.0
    case = "no pose was answered with a row"
    for trial in trials:
        index, q, _ = trial.rows.flat()
        if not len(q):
            continue
        poses = trial.sample.poses[index]
        position, rotation = arm.task.errors(arm.oracle.forward(q), poses)
        position, rotation = (np.where(np.isnan(e), np.inf, e) for e in (position, rotation))
        error = np.maximum(position / arm.size_of(np.nan_to_num(q)), rotation)
        count += len(q)
        failures += int(np.sum(error > CLOSURE_TOLERANCE))
        worst_p, worst_r = max(worst_p, position.max()), max(worst_r, rotation.max())
        if error.max() > worst:
            k = int(np.argmax(error))
            worst = float(error[k])
            case = spell(trial.sample.label, index[k], row=q[k], pose=poses[k])
    numbers = (("position m", float(worst_p)), ("rotation rad", float(worst_r)))
    return result("closure", count, failures if count else 1, numbers, worst_case=case)


def check_distinct(arm: ArmUnderTest, trials: Sequence[Trial]) -> CheckResult:
    """No two rows of one answer are equal modulo whole turns."""
    count = failures = 0
    case = ""
    for trial in trials:
        q = trial.rows.q
        double = (nearest(arm, q, q, same=True) < DISTINCT_TOLERANCE) & trial.rows.mask
        count += int(trial.rows.count.sum())
        failures += int(double.sum())
        if double.any() and not case:
            i = int(np.argmax(double.any(axis=1)))
            case = spell(trial.sample.label, i, rows=q[i, : trial.rows.count[i]])
    return result("distinct rows", count, failures, worst_case=case)


def check_inside_limits(arm: ArmUnderTest, trials: Sequence[Trial]) -> CheckResult:
    """With `limits=True` every row lies inside the limits."""
    count = failures = 0
    worst, case = 0.0, ""
    for trial in (t for t in trials if t.limits):
        index, q, _ = trial.rows.flat()
        excess = np.maximum(arm.lower - q, q - arm.upper) / arm.unit_of(q)
        beyond = np.max(excess, axis=1, initial=0.0)
        wrong = ~(beyond <= LIMIT_TOLERANCE)
        count, failures = count + len(q), failures + int(wrong.sum())
        if len(q) and np.max(beyond) > worst:
            k = int(np.argmax(beyond))
            worst = float(beyond[k])
            case = spell(trial.sample.label, index[k], row=q[k], lower=arm.lower, upper=arm.upper)
    return result("inside limits", count, failures, (("beyond rad or m", worst),), worst_case=case)


def check_singular_flags(arm: ArmUnderTest, trials: Sequence[Trial]) -> CheckResult:
    """Rows on a continuum of solutions are flagged, clearly regular rows are not."""
    rows = [trial.rows.flat() for trial in trials]
    which = np.repeat(np.arange(len(trials)), [len(index) for index, _, _ in rows])
    poses = np.concatenate([t.sample.poses[i] for t, (i, _, _) in zip(trials, rows, strict=True)])
    index, q, flags = (np.concatenate(part) for part in zip(*rows, strict=True))
    finite = np.all(np.isfinite(q), axis=1)
    which, index, poses = which[finite], index[finite], poses[finite]
    q, flags = q[finite], flags[finite]
    wrong = np.zeros(len(q), dtype=bool)
    wrong[~flags] = on_continuum(arm, q[~flags], poses[~flags])
    missing = int(wrong.sum())
    wrong[flags] = arm.sigma(q[flags]) > FLAGGED_REGULAR
    case = ""
    if wrong.any():
        k = int(np.argmax(wrong))
        label, sigma = trials[which[k]].sample.label, arm.sigma(q[k : k + 1])[0]
        case = spell(label, index[k], row=q[k], sigma=sigma)
    detail = f"{missing} rows of a continuum not flagged" if wrong.any() else ""
    return result("singular flags", len(q), int(wrong.sum()), detail=detail, worst_case=case)


def check_seed_order(trial: Trial, seeds: Array) -> CheckResult:
    """Rows come in order of their distance to the seed: one norm (2, largest or 1) fits all
    answers.

    `trial` was solved with `seeds` (N, dof).
    """
    several = trial.rows.count > 1
    offset = trial.rows.q - seeds[:, None]
    wrong = {}
    for norm in (2, np.inf, 1):
        distance = np.linalg.norm(offset, ord=norm, axis=2)
        falls = np.diff(distance, axis=1) < -1e-9  # comparisons with NaN are false
        wrong[norm] = falls.any(axis=1) & several
    best = min(wrong.values(), key=lambda w: int(w.sum()))
    case = ""
    if best.any():
        i = int(np.argmax(best))
        rows = trial.rows.q[i, : trial.rows.count[i]]
        case = spell(trial.sample.label, i, seed=seeds[i], rows=rows)
    return result("seed order", int(several.sum()), int(best.sum()), worst_case=case)


def check_free_joints(arm: ArmUnderTest, trials: Sequence[Trial]) -> CheckResult:
    """Free joints have the values that were handed over, in every row."""
    count = failures = 0
    worst, case = 0.0, ""
    for trial in trials if arm.held else ():
        index, q, _ = trial.rows.flat()
        off = arm.held_off(q, trial.sample.q[index], trial.sample.poses[index])
        count, failures = count + len(q), failures + int(np.sum(~(off <= CLOSURE_TOLERANCE)))
        if len(q) and np.max(off) > worst:
            k = int(np.argmax(off))
            worst = float(off[k])
            case = spell(trial.sample.label, index[k], row=q[k], wanted=trial.sample.q[index[k]])
    numbers = (("off rad or m", worst),) if arm.held else ()
    detail = "" if arm.held else "no joint is held free"
    return result("free joints", count, failures, numbers, detail, case)
