"""What a verification found: one result per named check, and the report that gathers them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

__all__ = ["CheckResult", "SigmaBand", "VerificationReport"]


@dataclass(frozen=True, slots=True)
class CheckResult:
    """The outcome of one check. `count` things were looked at, `failures` of them were wrong;
    `worst` names the largest deviations (the name ends in the unit); `worst_case` spells out one
    failure."""

    name: str
    passed: bool
    count: int
    failures: int = 0
    worst: tuple[tuple[str, float], ...] = ()
    detail: str = ""
    worst_case: str = ""

    def to_dict(self) -> dict[str, Any]:
        """For JSON; an infinite deviation becomes None."""
        worst = {name: value if math.isfinite(value) else None for name, value in self.worst}
        return {
            "name": self.name,
            "passed": self.passed,
            "count": self.count,
            "failures": self.failures,
            "worst": worst,
            "detail": self.detail,
            "worst_case": self.worst_case,
        }

    @property
    def numbers(self) -> str:
        """The deviations as one line of text."""
        return ", ".join(f"{name} {value:.1e}" for name, value in self.worst)


@dataclass(frozen=True, slots=True)
class SigmaBand:
    """Poses whose generating configurations have smallest singular values of at least `low` and below
    `high`: how many, at how many of them that configuration is `missed` among the rows, at how many a
    row is it only as far as its own closure error goes (`loose`), how many are `unanswered`, without
    any row; `case` spells out one miss."""

    low: float
    high: float
    poses: int
    missed: int = 0
    loose: int = 0
    unanswered: int = 0
    case: str = ""

    def to_dict(self) -> dict[str, Any]:
        """For JSON; an infinite edge becomes None."""
        return {
            "low": self.low,
            "high": self.high if math.isfinite(self.high) else None,
            "poses": self.poses,
            "missed": self.missed,
            "loose": self.loose,
            "unanswered": self.unanswered,
            "case": self.case,
        }


@dataclass(frozen=True, slots=True)
class VerificationReport:
    """All checks of one emitted module. `label` is its language; `histogram` pairs a number of
    solutions with how many of the random poses have it (limits disregarded); `bands` counts what was
    found by how singular the configurations are; `by_default` says at how many of how many random poses
    the default values of held joints have a row, none of none where no joint is held; `seconds` is the
    time taken, which stays out of `to_dict` so that equal runs give equal text."""

    label: str
    base_link: str
    tip_link: str
    task: str
    samples: int
    seed: int
    checks: tuple[CheckResult, ...]
    histogram: tuple[tuple[int, int], ...] = ()
    notes: tuple[str, ...] = ()
    locked: tuple[tuple[str, float], ...] = ()
    seconds: float = 0.0
    bands: tuple[SigmaBand, ...] = ()
    by_default: tuple[int, int] = (0, 0)

    @property
    def passed(self) -> bool:
        """Whether there are checks and all of them passed."""
        return bool(self.checks) and all(check.passed for check in self.checks)

    @property
    def failed(self) -> tuple[CheckResult, ...]:
        """The checks that did not pass."""
        return tuple(check for check in self.checks if not check.passed)

    def check(self, name: str) -> CheckResult:
        """The result of the check `name`; raises `KeyError` if it did not run."""
        for check in self.checks:
            if check.name == name:
                return check
        raise KeyError(name)

    @property
    def worst_closure(self) -> tuple[float, float]:
        """Largest position (m) and rotation (rad) error over all returned rows; NaN if none ran."""
        worst = dict(next((c.worst for c in self.checks if c.name == "closure"), ()))
        return worst.get("position m", math.nan), worst.get("rotation rad", math.nan)

    @property
    def missed(self) -> int:
        """Generating configurations, at whatever singular value, and solutions of the numerical search
        that no row gives."""
        searched = sum(c.failures for c in self.checks if c.name == "exhaustive search")
        return searched + sum(band.missed for band in self.bands)

    @property
    def missed_words(self) -> str:
        """How many are missed, and whether all of them are singular enough not to fail."""
        words = f"{self.missed} missed"
        if not self.missed or not self.passed:
            return words
        near = sum(band.poses for band in self.bands if math.isfinite(band.high))
        words = f"{words}, all of them among {near} poses near singularities"
        without = sum(band.unanswered for band in self.bands)
        return f"{words}, {without} without a row" if without else words

    @property
    def solutions(self) -> tuple[int, float, int]:
        """Least, mean and greatest number of solutions over the random poses; zeros if none ran."""
        total = sum(poses for _, poses in self.histogram)
        if not total:
            return 0, 0.0, 0
        counts = [count for count, _ in self.histogram]
        mean = sum(count * poses for count, poses in self.histogram) / total
        return min(counts), mean, max(counts)

    def _by_default(self) -> dict[str, int] | None:
        answered, poses = self.by_default
        return {"answered": answered, "poses": poses} if poses else None

    @property
    def worst_case(self) -> str:
        """The first failed check in words, with its numbers and its case; "" when all passed."""
        if not self.failed:
            return ""
        check = self.failed[0]
        parts = [f"{check.name}: {check.failures} of {check.count} wrong", check.numbers]
        parts += [check.detail, check.worst_case]
        return "; ".join(part for part in parts if part)

    def table(self) -> list[tuple[str, str, str, str, str]]:
        """Rows to render: check, "ok" or "FAILED", things checked, deviations, detail."""
        return [
            (c.name, "ok" if c.passed else "FAILED", str(c.count), c.numbers, c.detail)
            for c in self.checks
        ]

    def to_dict(self) -> dict[str, Any]:
        """For JSON; equal runs give equal dictionaries."""
        least, mean, greatest = self.solutions
        return {
            "label": self.label,
            "base_link": self.base_link,
            "tip_link": self.tip_link,
            "task": self.task,
            "samples": self.samples,
            "seed": self.seed,
            "passed": self.passed,
            "solutions": {"min": least, "mean": mean, "max": greatest},
            "histogram": {str(count): poses for count, poses in self.histogram},
            "by_default": self._by_default(),
            "by_sigma": [band.to_dict() for band in self.bands],
            "missed": self.missed,
            "notes": list(self.notes),
            "locked": dict(self.locked),
            "checks": [check.to_dict() for check in self.checks],
        }
