"""What emitted code answered to the sampled poses, and how answers are compared."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.runners.runner import Rows, Runner
from ikgen.verify.sampling import SampleSet
from ikgen.verify.verification_report import CheckResult

__all__ = ["Trial", "nearest", "result", "run_trial", "spell"]

Array = NDArray[np.float64]

_CHUNK = 256  # poses compared at a time: bounds the memory for arms with many solutions


@dataclass(frozen=True, slots=True)
class Trial:
    """One sample set as answered, with or without limits, seeded with the generating configuration
    or not."""

    sample: SampleSet
    rows: Rows
    limits: bool
    seeded: bool


def run_trial(
    runner: Runner, arm: ArmUnderTest, sample: SampleSet, *, limits: bool, seeded: bool = False
) -> Trial:
    """Solve all poses of the set, free joints held where the generating configuration has them."""
    free = arm.held_values(sample.q, sample.poses)
    seeds = sample.q if seeded else None
    rows = runner.solve_many(sample.poses, free=free, seeds=seeds, limits=limits)
    return Trial(sample, rows, limits, seeded)


def nearest(arm: ArmUnderTest, a: Array, b: Array, *, same: bool = False) -> Array:
    """Distance (N, A) of each of a (N, A, dof) to the nearest of b (N, B, dof), modulo whole turns.

    Infinite where there is none (rows of NaN count as none). `same`: a is b, a row does not count
    as its own neighbour.
    """
    out = np.full(a.shape[:2], np.inf)
    if not b.shape[1] or not a.shape[1]:
        return out
    for start in range(0, len(a), _CHUNK):
        part = slice(start, start + _CHUNK)
        d = arm.distance(a[part][:, :, None], b[part][:, None])
        d = np.where(np.isnan(d), np.inf, d)
        if same:
            d[:, np.arange(a.shape[1]), np.arange(a.shape[1])] = np.inf
        out[part] = np.min(d, axis=2)
    return out


def spell(label: str, index: int, **arrays: Array) -> str:
    """One case in words, with all digits: set, index and the named arrays."""
    parts = [f"{name} = {np.asarray(values).tolist()}" for name, values in arrays.items()]
    return f"{label} #{index}: {', '.join(parts)}"


def result(
    name: str,
    count: int,
    failures: int,
    worst: tuple[tuple[str, float], ...] = (),
    detail: str = "",
    worst_case: str = "",
) -> CheckResult:
    """A result that passes when nothing failed."""
    case = worst_case if failures else ""
    return CheckResult(name, failures == 0, int(count), int(failures), worst, detail, case)
