"""What emitted code answered to the sampled poses, and how answers are compared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.runners.runner import Rows, Runner
from ikgen.verify.sampling import SampleSet
from ikgen.verify.verification_report import CheckResult

__all__ = ["Trial", "nearest", "result", "run_trial", "run_trials", "spell"]

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
    return run_trials(runner, arm, [sample], limits=limits, seeded=seeded)[0]


def run_trials(
    runner: Runner,
    arm: ArmUnderTest,
    samples: Sequence[SampleSet],
    *,
    limits: bool,
    seeded: bool = False,
) -> tuple[Trial, ...]:
    """`run_trial` of several sets in one call: what is in several of them is solved once, and poses that
    leave doubts come in large stacks."""
    q = np.concatenate([sample.q for sample in samples])
    poses = np.concatenate([sample.poses for sample in samples])
    known: dict[bytes, int] = {}
    asked = np.concatenate([q, poses.reshape(len(q), 16)], axis=1)
    places = np.array(
        [known.setdefault(one.tobytes(), len(known)) for one in asked], dtype=np.int64
    )
    first = np.unique(places, return_index=True)[1]
    rows = runner.solve_many(
        poses[first],
        free=arm.held_values(q[first], poses[first]),
        seeds=q[first] if seeded else None,
        limits=limits,
    )
    parts = np.split(places, np.cumsum([len(sample) for sample in samples])[:-1])
    return tuple(
        Trial(sample, rows.at(part), limits, seeded)
        for sample, part in zip(samples, parts, strict=True)
    )


def nearest(arm: ArmUnderTest, a: Array, b: Array, *, same: bool = False) -> Array:
    """Distance (N, A) of each of a (N, A, dof) to the nearest of b (N, B, dof), modulo whole turns.

    Infinite where there is none (rows of NaN count as none). `same`: a is b, a row does not count
    as its own neighbour.
    """
    out = np.full(a.shape[:2], np.inf)
    filled, others = (np.flatnonzero(~np.isnan(x).any(axis=2).all(axis=0)) for x in (a, b))
    if not len(filled) or not len(others):
        return out
    a, b = a[:, filled], b[:, others]
    for start in range(0, len(a), _CHUNK):
        part = slice(start, start + _CHUNK)
        d = arm.distance(a[part][:, :, None], b[part][:, None])
        d = np.where(np.isnan(d), np.inf, d)
        if same:
            d[:, np.arange(a.shape[1]), np.arange(a.shape[1])] = np.inf
        out[part, filled] = np.min(d, axis=2)
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
