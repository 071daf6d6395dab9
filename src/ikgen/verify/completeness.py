"""Whether the configuration that each pose was made from is among the rows: asked of every pose.

How close a row must come follows from what an error of the pose does to it. To second order along the
direction in which the arm moves least, a displacement x of the joints moves the tip by
`sigma x + kappa x^2 / 2`: an error e of the pose moves a row by e / sigma, and beside a fold, where sigma
vanishes but kappa does not, by no more than sqrt(2 e / kappa). The error is what rounding amounts to;
a row that closes less well than that is allowed its own closure error too, and counted as loose.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.checks import CLOSURE_TOLERANCE
from ikgen.verify.runners.runner import Rows, Runner
from ikgen.verify.trials import Trial, result, spell
from ikgen.verify.verification_report import CheckResult, SigmaBand

__all__ = [
    "BAND_EDGES", "FAILS_ABOVE", "FOUND_TOLERANCE", "POSE_NOISE", "Sensitivity", "Survey", "check_answered",
    "check_completeness", "sensitivity", "survey",
]  # fmt: skip


FAILS_ABOVE = 1e-3
"""Smallest singular value from which on a miss, or a pose without any row, usually fails the verification.
Those below are counted and reported. To be lowered as solvers improve."""

BAND_EDGES = (1e-3, 1e-5, 1e-7)
"""Smallest singular values between which poses are counted together."""

FOUND_TOLERANCE = 1e-6
"""rad, or m (of a slide's value where that is over 1 m): how close a row must come at a regular pose;
rows closer to each other than this are one."""

POSE_NOISE = 1e-13
"""What rounding of a pose's entries, and of the arithmetic on them, may amount to (rad, lengths of
the arm)."""

FARTHEST = 1e-2
"""rad or m: a row farther off than this never counts, however singular the configuration."""

_ALONE = 1e-3  # another singular value below that makes another direction free too
_ALONG = 1e-5  # step (rad, lengths of the arm) of the derivative along the null direction


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """How configurations (N,) answer to errors of their poses: smallest singular value `sigma`, and
    `kappa`, the second derivative along its direction; 0 where another one is small too."""

    sigma: Array
    kappa: Array

    def moved(self, error: Array | float) -> Array:
        """How far (N,) an `error` of the pose (rad, lengths of the arm) moves a row."""
        with np.errstate(divide="ignore"):
            moved = np.minimum(error / self.sigma, np.sqrt(2.0 * error / self.kappa))
        return np.asarray(np.minimum(moved, FARTHEST))

    def within(self, error: Array | float) -> Array:
        """How close (N,) a row must come, if the pose may be off by `error`, as `moved` has it."""
        return np.asarray(FOUND_TOLERANCE + self.moved(error))


def sensitivity(arm: ArmUnderTest, q: Array) -> Sensitivity:
    """The sensitivity of the configurations q (N, dof)."""
    if not len(q) or not arm.active:
        return Sensitivity(np.ones(len(q)), np.zeros(len(q)))
    active = list(arm.active)
    J = arm.scaled_jacobian(q)[1]
    u, s, vt = np.linalg.svd(J, full_matrices=False)
    last = min(arm.rank, len(active)) - 1
    left, null = u[:, :, last], vt[:, last]
    step = np.zeros_like(q)
    step[:, active] = _ALONG * null * np.where(arm.revolute[active], 1.0, arm.length)
    turned = (arm.scaled_jacobian(q + step)[1] - J) / _ALONG
    kappa = np.abs(np.einsum("ni,nij,nj->n", left, turned, null))
    alone = s[:, last - 1] > _ALONE if last else np.ones(len(q), dtype=bool)
    # LAPACK's singular values may be -0.0, by which an error over them would be -inf
    return Sensitivity(np.abs(s[:, last]), np.where(alone, kappa, 0.0))


@dataclass(frozen=True, slots=True)
class Survey:
    """All poses of several trials together: the generating configurations' smallest singular values
    `sigma` (N,), how far `off` (N,) the nearest row is, which are `missed`, which only found
    `loose` and which `unanswered` (N,). A miss fails the verification from the singular value `fails_above`
    on. Pose k is number `index[k]` of `trials[which[k]]`."""

    trials: tuple[Trial, ...]
    which: NDArray[np.int64]
    index: NDArray[np.int64]
    sigma: Array
    off: Array
    missed: NDArray[np.bool_]
    loose: NDArray[np.bool_]
    unanswered: NDArray[np.bool_]
    fails_above: float

    def case(self, k: int) -> str:
        """Pose k in words."""
        trial, i = self.trials[self.which[k]], int(self.index[k])
        rows = trial.rows.q[i, : trial.rows.count[i]]
        sample = trial.sample
        return spell(sample.label, i, q=sample.q[i], pose=sample.poses[i], rows=rows)

    @property
    def bands(self) -> tuple[SigmaBand, ...]:
        """Counts by smallest singular value, the regular poses first."""
        edges = (np.inf, *BAND_EDGES, 0.0)
        out = []
        for high, low in itertools.pairwise(edges):
            inside = (self.sigma >= low) & (self.sigma < high)
            bad = np.flatnonzero(inside & self.missed)
            case = self.case(int(bad[0])) if len(bad) else ""
            loose, unanswered = (int((inside & of).sum()) for of in (self.loose, self.unanswered))
            out.append(SigmaBand(low, high, int(inside.sum()), len(bad), loose, unanswered, case))
        return tuple(out)


def survey(arm: ArmUnderTest, runner: Runner, trials: Sequence[Trial]) -> Survey:
    """Look for the generating configuration of every pose of `trials`.

    Where rows stand for a continuum (flagged `singular`) and none is the generating configuration, the
    pose is solved again with that as the seed, if none of `trials` did so: it must then be among the rows.
    """
    looks = [_look(arm, runner, trial, trials) for trial in trials]
    off, missed, loose = (np.concatenate(part) for part in zip(*looks, strict=True))
    return Survey(
        tuple(trials),
        np.repeat(np.arange(len(trials)), [len(t.sample) for t in trials]),
        np.concatenate([np.arange(len(t.sample)) for t in trials]),
        np.concatenate([t.sample.sigma for t in trials]),
        off,
        missed,
        loose,
        np.concatenate([t.rows.count == 0 for t in trials]),
        arm.regular_above(FAILS_ABOVE),
    )


def _look(
    arm: ArmUnderTest, runner: Runner, trial: Trial, trials: Sequence[Trial]
) -> tuple[Array, NDArray[np.bool_], NDArray[np.bool_]]:
    """Distance of the nearest row, which poses miss theirs, which have it only loosely; each (N,)."""
    q, poses = trial.sample.q, trial.sample.poses
    sensitive = sensitivity(arm, q)
    off, error = _nearest_row(arm, trial.rows, q, poses)
    missed = ~(off <= sensitive.within(POSE_NOISE + error))
    again = np.flatnonzero(missed & trial.rows.singular.any(axis=1))
    if len(again) and not trial.seeded:
        rows = _seeded_rows(arm, runner, trial, trials, again)
        off[again], error[again] = _nearest_row(arm, rows, q[again], poses[again])
        missed = ~(off <= sensitive.within(POSE_NOISE + error))
    loose = ~missed & (off > sensitive.within(POSE_NOISE))
    return off, missed, np.asarray(loose)


def _seeded_rows(
    arm: ArmUnderTest,
    runner: Runner,
    trial: Trial,
    trials: Sequence[Trial],
    some: NDArray[np.int64],
) -> Rows:
    """The answers to poses `some` (k,) of a trial with the generating configurations as seeds."""
    for other in trials:
        if other.seeded and other.sample is trial.sample and other.limits == trial.limits:
            return other.rows.at(some)
    q, poses = trial.sample.q[some], trial.sample.poses[some]
    free = arm.held_values(q, poses)
    return runner.solve_many(poses, free=free, seeds=q, limits=trial.limits)


def _nearest_row(arm: ArmUnderTest, rows: Rows, q: Array, poses: Array) -> tuple[Array, Array]:
    """How far (N,) the nearest row is from each of q (N, dof), and its closure error (N,), at most the
    tolerance that all rows must keep; infinite and 0 where there is no row."""
    if not len(q) or not rows.q.shape[1]:
        return np.full(len(q), np.inf), np.zeros(len(q))
    apart = arm.distance(q[:, None], rows.q)
    apart = np.where(np.isnan(apart), np.inf, apart)
    best = np.argmin(apart, axis=1)
    row = rows.q[np.arange(len(q)), best]
    there = np.isfinite(apart[np.arange(len(q)), best])
    position, rotation = arm.task.errors(
        arm.oracle.forward(np.where(there[:, None], row, q)), poses
    )
    error = np.maximum(position / arm.length, rotation)
    return apart[np.arange(len(q)), best], np.minimum(error, CLOSURE_TOLERANCE)


def check_completeness(found: Survey) -> CheckResult:
    """The generating configuration is among the rows, modulo whole turns."""
    regular = found.sigma >= found.fails_above
    if not regular.any():
        return result("completeness", 0, 1, detail="no sampled configuration is regular")
    off = np.where(regular, found.off, 0.0)
    k = int(np.argmax(np.where(found.missed, off, 0.0)))
    failures = int((regular & found.missed).sum())
    worst = (("off rad or m", float(off.max())),)
    detail = _below(found, found.missed, "missed")
    return result("completeness", len(off), failures, worst, detail, found.case(k))


def check_answered(found: Survey) -> CheckResult:
    """No pose that the arm stands in is answered without rows."""
    bad = found.unanswered & (found.sigma >= found.fails_above)
    case = found.case(int(np.argmax(bad)))
    detail = _below(found, found.unanswered, "without any row")
    return result(
        "poses answered", len(found.sigma), int(bad.sum()), detail=detail, worst_case=case
    )


def _below(found: Survey, counted: NDArray[np.bool_], words: str) -> str:
    """How many poses lie below each edge, and how many of them are `counted`."""
    parts = []
    for edge in BAND_EDGES:
        below = found.sigma < edge
        parts.append(f"{int((below & counted).sum())} of {int(below.sum())} below {edge:.0e}")
    return f"{words} near singularities: {', '.join(parts)}"
