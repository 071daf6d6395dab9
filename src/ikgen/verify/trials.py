"""What emitted code answered to the sampled poses, and how answers are compared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.runners.runner import Rows, Runner, Stack, solve_stacks
from ikgen.verify.sampling import SampleSet
from ikgen.verify.verification_report import CheckResult

__all__ = ["Question", "Trial", "ask_all", "nearest", "result", "run_trial", "spell"]


_CHUNK = 256  # poses compared at a time: bounds the memory for arms with many solutions


@dataclass(frozen=True, slots=True)
class Trial:
    """One sample set as answered, with or without limits, seeded with the generating configuration
    or not."""

    sample: SampleSet
    rows: Rows
    limits: bool
    seeded: bool


@dataclass(frozen=True, slots=True)
class Question:
    """Sets to be solved together, with or without limits: poses with free joints held where the generating
    configuration has them, `seeded` with it, or with `seeds` (N, dof) for all of them."""

    samples: Sequence[SampleSet]
    limits: bool
    seeded: bool = False
    seeds: Array | None = None

    def stack(self, arm: ArmUnderTest) -> tuple[Stack, NDArray[np.int64]]:
        """What is in several sets once, and where in it each pose of all sets is."""
        q = np.concatenate([sample.q for sample in self.samples])
        poses = np.concatenate([sample.poses for sample in self.samples])
        seeds = q if self.seeds is None else self.seeds
        known: dict[bytes, int] = {}
        asked = np.concatenate([q, seeds, poses.reshape(len(q), 16)], axis=1)
        places = np.array(
            [known.setdefault(one.tobytes(), len(known)) for one in asked], dtype=np.int64
        )
        first = np.unique(places, return_index=True)[1]
        free, seeded = arm.held_values(q[first], poses[first]), self.seeded
        return Stack(poses[first], free, seeds[first] if seeded else None, self.limits), places

    def trials(self, rows: Rows, places: NDArray[np.int64]) -> tuple[Trial, ...]:
        """One a set."""
        parts = np.split(places, np.cumsum([len(sample) for sample in self.samples])[:-1])
        return tuple(
            Trial(sample, rows.at(part), self.limits, self.seeded)
            for sample, part in zip(self.samples, parts, strict=True)
        )


def ask_all(
    runner: Runner, arm: ArmUnderTest, questions: Sequence[Question]
) -> list[tuple[Trial, ...]]:
    """The trials of each question, all solved in one call; none of one without sets."""
    asked = [question for question in questions if question.samples]
    stacks = [question.stack(arm) for question in asked]
    answers = zip(solve_stacks(runner, [stack for stack, _ in stacks]), stacks, strict=True)
    told = zip(asked, answers, strict=True)
    trials = iter([question.trials(rows, places) for question, (rows, (_, places)) in told])
    return [next(trials) if question.samples else () for question in questions]


def run_trial(
    runner: Runner, arm: ArmUnderTest, sample: SampleSet, *, limits: bool, seeded: bool = False
) -> Trial:
    """What running one set of poses shows."""
    return ask_all(runner, arm, [Question([sample], limits, seeded)])[0][0]


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
