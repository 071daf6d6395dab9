"""The verifications of several sets of samples as one."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from ikgen.verify.verification_report import CheckResult, SigmaBand, VerificationReport

__all__ = ["merged_reports"]


def merged_reports(parts: Sequence[VerificationReport]) -> VerificationReport:
    """One report of the same module's samples in several blocks (at least one), in their order: counts and
    times are sums, deviations the largest, a case the first."""
    first = parts[0]
    names = dict.fromkeys(check.name for part in parts for check in part.checks)
    histogram: Counter[int] = Counter()
    for part in parts:
        histogram.update(dict(part.histogram))
    return replace(
        first,
        samples=sum(part.samples for part in parts),
        checks=tuple(
            _check([c for part in parts for c in part.checks if c.name == name]) for name in names
        ),
        histogram=tuple(sorted(histogram.items())),
        seconds=sum(part.seconds for part in parts),
        bands=_bands([band for part in parts for band in part.bands]),
        by_default=(
            sum(part.by_default[0] for part in parts),
            sum(part.by_default[1] for part in parts),
        ),
    )


def _check(parts: Sequence[CheckResult]) -> CheckResult:
    """One check over all blocks; its words are those of the first that failed."""
    told = next((part for part in parts if not part.passed), parts[0])
    worst: dict[str, float] = {}
    for part in parts:
        for name, value in part.worst:
            worst[name] = max(worst.get(name, value), value)
    return replace(
        told,
        count=sum(part.count for part in parts),
        failures=sum(part.failures for part in parts),
        worst=tuple(worst.items()),
    )


def _bands(parts: Sequence[SigmaBand]) -> tuple[SigmaBand, ...]:
    """The counts of each band, in the order in which they come first."""
    whole: dict[tuple[float, float], SigmaBand] = {}
    for band in parts:
        edges = (band.low, band.high)
        known = whole.get(edges)
        whole[edges] = band if known is None else replace(
            known,
            poses=known.poses + band.poses,
            missed=known.missed + band.missed,
            loose=known.loose + band.loose,
            unanswered=known.unanswered + band.unanswered,
            case=known.case or band.case,
        )  # fmt: skip
    return tuple(whole.values())
