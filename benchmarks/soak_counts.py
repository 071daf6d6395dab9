"""What came of many poses, by smallest singular value: wrong rows, missed solutions, unanswered poses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

__all__ = ["DECADES", "Soak", "added", "table"]

DECADES = 14
"""Powers of ten that are told apart; the last holds all below (see cpp/soak.cpp)."""


@dataclass(frozen=True, slots=True)
class Soak:
    """What was found. `decades`: per power of ten of the smallest singular value, poses, missed and
    unanswered of the random poses and the same of those beside singularities; `cases` spells out
    failures."""

    rows: int
    wrong: int
    decades: tuple[tuple[int, ...], ...]
    cases: tuple[str, ...]

    @property
    def totals(self) -> tuple[int, ...]:
        """The sums over all decades."""
        return tuple(map(sum, zip(*self.decades, strict=True)))

    def failures(self, above: float) -> int:
        """Wrong rows, and misses and unanswered poses at singular values from `above` on."""
        kept = [d for k, d in enumerate(self.decades) if 10.0 ** -(k + 1) >= above * (1 - 1e-9)]
        return self.wrong + sum(d[i] for d in kept for i in (1, 2, 4, 5))


def added(parts: Sequence[Soak]) -> Soak:
    """The sum of several runs."""
    decades = zip(*(p.decades for p in parts), strict=True)
    return Soak(
        sum(p.rows for p in parts),
        sum(p.wrong for p in parts),
        tuple(tuple(map(sum, zip(*d, strict=True))) for d in decades),
        tuple(case for p in parts for case in p.cases),
    )


def table(found: Soak) -> Iterator[str]:
    """The lines to print."""
    yield f"{'smallest singular value':26} {'random':>10} {'missed':>7} {'no row':>7}  " + (
        f"{'beside':>9} {'missed':>7} {'no row':>7}"
    )
    for k, d in enumerate(found.decades):
        if d[0] or d[3]:
            span = f"1e-{k:02} to 1e-{k + 1:02}" if k else "0.1 and more"
            last = f"below 1e-{k:02}" if k == len(found.decades) - 1 else span
            yield f"{last:26} {d[0]:10} {d[1]:7} {d[2]:7}  {d[3]:9} {d[4]:7} {d[5]:7}"
    yield f"{found.rows} rows, {found.wrong} wrong"
    yield from found.cases
