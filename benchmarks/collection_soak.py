"""Poses through the emitted code of all arms of the collection: wrong rows, missed solutions, by class.

    python -m benchmarks.collection_soak [--record] [--poses 300000] [--near 30000] [--above 1e-3]
        [--jobs 2] [--only NAME] [--language cpp|python]

What `benchmarks.soak` does with ten arms and more poses. A verification takes a thousand poses of an arm;
what goes wrong once in a hundred thousand shows here alone. Prints a line for each arm, with the
configurations that failed, and for each class the sums; of modules 3,000 poses of either kind where nothing
else is asked. Exits with 1 as `benchmarks.soak` does, with 2 where an arm was not solved. `--record` keeps
what was found of headers.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from benchmarks.command_line import Source, emit, sources
from benchmarks.module_soak import soak_module
from benchmarks.results import write_result
from benchmarks.soak import ABOVE, soak
from benchmarks.soak_counts import Soak, added

__all__ = ["by_class", "main"]

POSES = {"cpp": (300_000, 30_000), "python": (3_000, 3_000)}
"""Language -> poses of each arm where nothing else is asked: random ones, and beside singularities."""


def by_class(found: Sequence[tuple[str, Soak]]) -> list[dict[str, object]]:
    """Of (class, what was found) of each arm: by class how many arms, rows and wrong ones, and of random
    poses and those beside singularities how many there were, how many missed, how many without a row."""
    out: list[dict[str, object]] = []
    for family in sorted({family for family, _ in found}):
        some = [one for name, one in found if name == family]
        whole = added(some)
        counts = {"rows": whole.rows, "wrong": whole.wrong, "poses": list(whole.totals)}
        out.append({"family": family, "arms": len(some), **counts})
    return out


def _soaked(source: Source, language: str, poses: int, near: int) -> Soak | str:
    """What was found, or why there is no code."""
    with tempfile.TemporaryDirectory(prefix="ikgen-soak-") as folder:
        made = emit(source, Path(folder), language)
        if made.code:
            return f"ikgen ended with {made.code}: {made.answer.get('error', '')}"
        return (soak if language == "cpp" else soak_module)(made, poses, near)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print what was found; 1 where something failed, 2 where an arm was not solved."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument(
        "--record", action="store_true", help="benchmarks/results/collection_soak.json"
    )
    parser.add_argument("--language", choices=POSES, default="cpp")
    parser.add_argument("--poses", type=int, help="random poses of each arm")
    parser.add_argument("--near", type=int, help="poses beside singularities of each")
    parser.add_argument("--above", type=float, default=ABOVE)
    parser.add_argument("--jobs", type=int, default=1, help="arms at a time")
    parser.add_argument("--only", default="", help="arms whose names contain this")
    options = parser.parse_args(arguments)
    if options.record and options.language != "cpp":
        parser.error("--record keeps what was found of headers: leave out --language python")
    if options.record and options.only:
        parser.error("--record is for the whole collection")
    poses, near = POSES[options.language]
    counts = options.poses or poses, options.near or near
    arms = [source for source in sources(("corpus",)) if options.only in source.key]
    found: list[tuple[str, Soak]] = []
    missing = 0
    with ProcessPoolExecutor(options.jobs) as pool:
        runs = [pool.submit(_soaked, source, options.language, *counts) for source in arms]
        for source, run in zip(arms, runs, strict=True):
            one = run.result()
            if isinstance(one, str):
                missing += 1
                print(f"{source.key}: {one}", file=sys.stderr)
                continue
            found.append((source.family, one))
            _, missed, empty, _, beside, none = one.totals
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
