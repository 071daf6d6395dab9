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

    Alike: same status, as many rows, each equal to one of the other's to `TOLERANCE`. Their order is
    promised with a seed only: which rows Newton steps find, and find first, hangs on the last digits.
    Poses with a singular row are left out: which rows stand for a continuum hangs on them too.
    """
    singular = [(r.singular & r.mask).any(axis=1) for r in (ours, theirs)]
    compared = np.asarray(~(singular[0] | singular[1]))
    pairs = (ours.q[:, :, None], theirs.q[:, None])
    apart = np.max(np.abs(arm.difference(*pairs)), axis=3, initial=0.0)
    apart = np.where(np.isnan(apart), np.inf, apart)
    largest = np.zeros(len(ours))
    for rows, axis in ((ours, 2), (theirs, 1)):
        nearest = np.min(apart, axis=axis, initial=np.inf)
        largest = np.maximum(largest, np.max(nearest, axis=1, initial=0.0, where=rows.mask))
    other = np.array([x != y for x, y in zip(ours.status, theirs.status, strict=True)])
    wrong = compared & (other | (ours.count != theirs.count) | (largest > TOLERANCE))
    return np.asarray(wrong), compared, float(np.max(largest[compared & ~wrong], initial=0.0))


def check_agreement(arm: ArmUnderTest, trial: Trial, peer: Runner) -> CheckResult:
    """`peer`, the same solver in another language, gives the same rows."""
    other = run_trial(peer, arm, trial.sample, limits=trial.limits, seeded=trial.seeded)
    wrong, compared, largest = disagreements(arm, trial.rows, other.rows)
    case = ""
    if wrong.any():
        k = int(np.argmax(wrong))
        here, there = (r.q[k, : r.count[k]] for r in (trial.rows, other.rows))
        case = spell(trial.sample.label, k, pose=trial.sample.poses[k], here=here, there=there)
    name, worst = f"agreement with {peer.label}", (("rad or m", largest),)
    return result(name, int(compared.sum()), int(wrong.sum()), worst, worst_case=case)
