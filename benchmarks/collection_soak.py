"""Poses through the C++ headers of all arms of the collection: wrong rows, missed solutions, by class.

    python -m benchmarks.collection_soak [--record] [--poses 300000] [--near 30000] [--above 1e-3]
        [--jobs 2] [--only NAME]

What `benchmarks.soak` does with ten arms and more poses. A verification takes a thousand poses of an arm;
what goes wrong once in a hundred thousand shows here alone. Prints a line for each arm, with the
configurations that failed, and for each class the sums. Exits with 1 as `benchmarks.soak` does, with 2
where an arm has no header.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from benchmarks.command_line import Source, emit, sources
from benchmarks.results import write_result
from benchmarks.soak import ABOVE, soak
from benchmarks.soak_counts import Soak

__all__ = ["by_class", "main"]


def by_class(found: Sequence[tuple[str, Soak]]) -> list[dict[str, object]]:
    """Of (class, what was found) of each arm: by class how many arms, rows and wrong ones, and of random
    poses and those beside singularities how many there were, how many missed, how many without a row."""
    out: list[dict[str, object]] = []
    for family in sorted({family for family, _ in found}):
        some = [one for name, one in found if name == family]
        rows, wrong = (sum(getattr(one, name) for one in some) for name in ("rows", "wrong"))
        totals = [sum(decade[i] for one in some for decade in one.decades) for i in range(6)]
        out.append(
            {"family": family, "arms": len(some), "rows": rows, "wrong": wrong, "poses": totals}
        )
    return out


def _soaked(source: Source, poses: int, near: int) -> Soak | str:
    """What was found, or why there is no header."""
    with tempfile.TemporaryDirectory(prefix="ikgen-soak-") as folder:
        made = emit(source, Path(folder), "cpp")
        if made.header is None:
            return f"ikgen ended with {made.code}: {made.answer.get('error', '')}"
        return soak(made, poses, near)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print what was found; 1 where something failed, 2 where an arm has no header."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument(
        "--record", action="store_true", help="benchmarks/results/collection_soak.json"
    )
    parser.add_argument("--poses", type=int, default=300_000, help="random poses of each arm")
    parser.add_argument(
        "--near", type=int, default=30_000, help="poses beside singularities of each"
    )
    parser.add_argument("--above", type=float, default=ABOVE)
    parser.add_argument("--jobs", type=int, default=1, help="arms at a time")
    parser.add_argument("--only", default="", help="arms whose names contain this")
    options = parser.parse_args(arguments)
    arms = [source for source in sources(("corpus",)) if options.only in source.key]
    found: list[tuple[str, Soak]] = []
    missing = 0
    with ThreadPoolExecutor(options.jobs) as pool:
        runs = [pool.submit(_soaked, source, options.poses, options.near) for source in arms]
        for source, run in zip(arms, runs, strict=True):
            one = run.result()
            if isinstance(one, str):
                missing += 1
                print(f"{source.key}: {one}", file=sys.stderr)
                continue
            found.append((source.family, one))
            _, missed, empty, _, beside, none = map(sum, zip(*one.decades, strict=True))
            print(
                f"{source.key}: {one.wrong} of {one.rows} rows wrong; {missed} missed, {empty} without a "
                f"row; beside singularities {beside}, {none}", *one.cases, sep="\n  ", flush=True,
            )  # fmt: skip
    classes = by_class(found)
    for c in classes:
        print(*c.values(), sep="  ")
    if options.record:
        write_result(
            "collection_soak", "python -m benchmarks.collection_soak", {"classes": classes}
        )
    return 2 if missing else int(any(one.failures(options.above) for _, one in found))


if __name__ == "__main__":
    sys.exit(main())
