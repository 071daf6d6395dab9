"""Whether two emitted languages answer alike."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.runners.runner import Rows, Runner
from ikgen.verify.trials import Trial, result, run_trial, spell
from ikgen.verify.verification_report import CheckResult

__all__ = ["TOLERANCE", "check_agreement", "disagreements"]

TOLERANCE = 1e-6
"""rad or m: beside a singular configuration the last digits of a pose move a row that far."""


def disagreements(
    arm: ArmUnderTest, ours: Rows, theirs: Rows
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], float]:
    """Which poses are answered differently, which were compared (N,), and the largest difference of
    rows at the others (rad or m).

    Alike: same status, as many rows, each in its place equal to `TOLERANCE`. Poses with a singular row
    are left out: which rows stand for a continuum hangs on the last digits.
    """
    singular = [(r.singular & r.mask).any(axis=1) for r in (ours, theirs)]
    compared = np.asarray(~(singular[0] | singular[1]))
    most = max(ours.q.shape[1], theirs.q.shape[1])
    a, b = (
        np.pad(r.q, ((0, 0), (0, most - r.q.shape[1]), (0, 0)), constant_values=np.nan)
        for r in (ours, theirs)
    )
    apart = np.where(np.isnan(a) & np.isnan(b), 0.0, np.abs(arm.difference(a, b)))
    largest = np.max(np.where(np.isnan(apart), np.inf, apart), axis=(1, 2), initial=0.0)
    other = np.array([x != y for x, y in zip(ours.status, theirs.status, strict=True)])
    wrong = compared & (other | (ours.count != theirs.count) | (largest > TOLERANCE))
    return np.asarray(wrong), compared, float(np.max(largest[compared & ~wrong], initial=0.0))


def check_agreement(arm: ArmUnderTest, trial: Trial, peer: Runner) -> CheckResult:
    """`peer`, the same solver in another language, gives the same rows in the same order."""
    other = run_trial(peer, arm, trial.sample, limits=trial.limits, seeded=trial.seeded)
    wrong, compared, largest = disagreements(arm, trial.rows, other.rows)
    case = ""
    if wrong.any():
        k = int(np.argmax(wrong))
        here, there = (r.q[k, : r.count[k]] for r in (trial.rows, other.rows))
        case = spell(trial.sample.label, k, pose=trial.sample.poses[k], here=here, there=there)
    name, worst = f"agreement with {peer.label}", (("rad or m", largest),)
    return result(name, int(compared.sum()), int(wrong.sum()), worst, worst_case=case)
