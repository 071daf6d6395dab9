"""Whether two emitted languages answer alike."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.runners.runner import Rows
from ikgen.verify.trials import Trial, result, spell
from ikgen.verify.verification_report import CheckResult

__all__ = ["FARTHEST_SLIDE", "TOLERANCE", "check_agreement", "disagreements"]

TOLERANCE = 1e-6
"""rad or m: beside a singular configuration the last digits of a pose move a row that far."""

FARTHEST_SLIDE = 100.0
"""Times the arm's length: rows with slides farther out are not compared. They are where rounding keeps
slides from being parallel, and whether steps of less than a metre come there hangs on where they begin."""


def disagreements(
    arm: ArmUnderTest, ours: Rows, theirs: Rows
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], float]:
    """Which poses are answered differently, which were compared (N,), and the largest difference of
    rows at the others (rad or m).

    Alike: same status, as many rows, each equal to one of the other's to `TOLERANCE`. Their order is
    promised with a seed only: which rows Newton steps find, and find first, hangs on the last digits.
    Poses with a singular row are left out: which rows stand for a continuum hangs on them too; so are rows
    with slides beyond `FARTHEST_SLIDE`.
    """
    slides = ~arm.revolute
    far = [
        (np.abs(r.q[..., slides]) > FARTHEST_SLIDE * arm.length).any(axis=2) & r.mask
        for r in (ours, theirs)
    ]
    near = [r.mask & ~out for r, out in zip((ours, theirs), far, strict=True)]
    singular = [(r.singular & r.mask).any(axis=1) for r in (ours, theirs)]
    compared = np.asarray(~(singular[0] | singular[1]))
    pairs = (ours.q[:, :, None], theirs.q[:, None])
    apart = np.max(np.abs(arm.difference(*pairs)), axis=3, initial=0.0)
    apart = np.where(np.isnan(apart), np.inf, apart)
    largest = np.zeros(len(ours))
    for some, axis in zip(near, (2, 1), strict=True):
        nearest = np.min(apart, axis=axis, initial=np.inf)
        largest = np.maximum(largest, np.max(nearest, axis=1, initial=0.0, where=some))
    other = np.array([x != y for x, y in zip(ours.status, theirs.status, strict=True)])
    other &= ~(far[0].any(axis=1) | far[1].any(axis=1))
    counts = [some.sum(axis=1) for some in near]
    wrong = compared & (other | (counts[0] != counts[1]) | (largest > TOLERANCE))
    return np.asarray(wrong), compared, float(np.max(largest[compared & ~wrong], initial=0.0))


def check_agreement(arm: ArmUnderTest, trial: Trial, label: str, other: Trial) -> CheckResult:
    """The same solver in the language `label` gives the same rows: `other`, of the same poses."""
    wrong, compared, largest = disagreements(arm, trial.rows, other.rows)
    case = ""
    if wrong.any():
        k = int(np.argmax(wrong))
        here, there = (r.q[k, : r.count[k]] for r in (trial.rows, other.rows))
        case = spell(trial.sample.label, k, pose=trial.sample.poses[k], here=here, there=there)
    name, worst = f"agreement with {label}", (("rad or m", largest),)
    return result(name, int(compared.sum()), int(wrong.sum()), worst, worst_case=case)
