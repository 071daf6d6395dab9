"""Two records of the same arms: whether rows and counts are the same, and what times and sizes became."""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.row_record import ArmRecord

__all__ = ["Difference", "compare", "same_to", "summary"]

Array = NDArray[np.float64]

ROWS_TOLERANCE = 1e-9
"""rad or m: rows closer than this are the same, where the arm is regular."""
NOISE = 1e-14
"""A pose's last digits move a row by this over its smallest singular value, and by its square root where
two rows meet."""
FACTS = ("derive", "solve", "batch", "cpp")


@dataclass(frozen=True, slots=True)
class Difference:
    """One arm. `lost`, `gained`: rows at poses whose sets differ; `poses`: how many those are, `regular`:
    of them those whose rows are all regular; `statuses`: poses with another status, with or without
    limits; `largest`: the largest distance of rows taken as the same; `state`: what else differs; `note`:
    what does not count as a difference."""

    key: str
    compared: int = 0
    poses: int = 0
    regular: int = 0
    lost: int = 0
    gained: int = 0
    statuses: int = 0
    largest: float = 0.0
    state: str = ""
    note: str = ""

    @property
    def same(self) -> bool:
        """Whether nothing differs."""
        return not (self.poses or self.statuses or self.state)


def same_to(sigma: Array) -> Array:
    """How close (rad or m) rows must be to be the same, by their smallest singular values (k,)."""
    near = np.minimum(NOISE / np.maximum(sigma, 1e-300), np.sqrt(10 * NOISE))
    return np.asarray(np.maximum(ROWS_TOLERANCE, near))


def compare(old: ArmRecord, new: ArmRecord) -> Difference:
    """Rows as sets modulo whole turns, pose by pose. Flagged rows stand for a continuum each and are
    compared by their number alone."""
    if new.solved and not old.solved:
        return Difference(old.key, note="solved now, and not before")
    if old.solved != new.solved:
        return Difference(old.key, state=f"exit code {old.facts['code']} -> {new.facts['code']}")
    if not old.solved:
        return Difference(old.key)
    if not np.array_equal(old.data["poses"], new.data["poses"]):
        return Difference(old.key, state="recorded on other poses: use --poses-of")
    lost = gained = poses = regular = 0
    largest = 0.0
    for one, two in zip(_split(old), _split(new), strict=True):
        gone, come, gap = _unmatched(one, two, old.data["turning"])
        differs = bool(gone or come)
        lost, gained, poses = lost + gone, gained + come, poses + differs
        regular += differs and min(one.worst, two.worst) > 1e-3
        largest = max(largest, gap)
    pairs = [(old.data[n] != new.data[n]) for n in ("status", "inside", "inside_status")]
    statuses = int(np.any(pairs, axis=0).sum())
    return Difference(
        old.key, len(old.data["poses"]), poses, int(regular), lost, gained, statuses, largest
    )


@dataclass(frozen=True, slots=True)
class _Rows:
    """The answer to one pose."""

    q: Array
    singular: NDArray[np.bool_]
    sigma: Array

    @property
    def worst(self) -> float:
        return float(np.min(self.sigma, initial=np.inf))


def _split(record: ArmRecord) -> Iterator[_Rows]:
    ends = np.cumsum(record.data["count"])[:-1]
    parts = [np.split(record.data[name], ends) for name in ("rows", "singular", "sigma")]
    for q, singular, sigma in zip(*parts, strict=True):
        yield _Rows(q, singular, sigma)


def _unmatched(one: _Rows, two: _Rows, turning: NDArray[np.bool_]) -> tuple[int, int, float]:
    """Rows of one alone, rows of two alone, the largest distance of the others."""
    lost = max(int(one.singular.sum() - two.singular.sum()), 0)
    gained = max(int(two.singular.sum() - one.singular.sum()), 0)
    a, b = one.q[~one.singular], two.q[~two.singular]
    limits = same_to(one.sigma[~one.singular])
    left = list(range(len(b)))
    largest = 0.0
    for row, limit in zip(a, limits, strict=True):
        apart = np.abs(b[left] - row)
        apart = np.where(turning, np.abs((apart + np.pi) % (2 * np.pi) - np.pi), apart)
        size = np.where(turning, 1.0, np.maximum(1.0, np.abs(row)))
        gaps = np.max(apart / size, axis=1, initial=0.0) if left else np.empty(0)
        if not left or gaps.min() > limit:
            lost += 1
            continue
        k = int(np.argmin(gaps))
        if limit <= ROWS_TOLERANCE:
            largest = max(largest, float(gaps[k]))
        left.pop(k)
    return lost, gained + len(left), largest


def summary(old: Sequence[ArmRecord], new: Sequence[ArmRecord]) -> Iterator[str]:
    """Lines by class: medians over the arms of the ratios new to old of times and sizes."""
    yield f"{'class':46} arms " + " ".join(f"{name:>7}" for name in (*FACTS, "py", "hpp"))
    for family in dict.fromkeys(record.family for record in old):
        pairs = [
            (a, b) for a, b in zip(old, new, strict=True)
            if a.family == family and a.solved and b.solved
        ]  # fmt: skip
        ratios = [
            [b.facts[name] / a.facts[name] for a, b in pairs if name in a.facts and name in b.facts]
            for name in FACTS
        ]
        for k in range(2):
            both = [(a.facts["sizes"], b.facts["sizes"]) for a, b in pairs]
            ratios.append([y[k] / x[k] for x, y in both if len(x) > k and len(y) > k])
        texts = [f"{statistics.median(r):7.2f}" if r else "      –" for r in ratios]
        yield f"{family[:46]:46} {len(pairs):4} " + " ".join(texts)
