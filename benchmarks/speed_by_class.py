"""C++ ns a pose of the whole collection by class, beside a hand-written solver of one class.

    python -m benchmarks.speed_by_class [--flags native] [--family TEXT] [--each N] [--record]

Every header is timed in one process with the baseline, in turns (`cpp/ortho_parallel.hpp`: the published
formulas for an ortho-parallel base and a spherical wrist, as one writes them by hand). "ratio" is the
median over the arms of a class of the header's time over the baseline's in the same run, "worst" the
largest. `--each N` takes the first N arms of each class. Without the collection it takes the fixtures.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.collection import load_arms
from benchmarks.command_line import Source, emit, sources
from benchmarks.cpp_speed import FLAGS, run_program
from benchmarks.results import write_result

SOURCE = Path(__file__).resolve().parent / "cpp" / "by_class.cpp"
BASELINE_ERROR = 1e-6
"""A baseline that is farther off is not right, and its time tells nothing."""


@dataclass(frozen=True, slots=True)
class Timed:
    """One arm: ns a pose of `solve`, of `solve_batch`, of the baseline, and the ratio of the first to the
    last; mean `rows` a pose."""

    name: str
    family: str
    single: float
    batch: float
    baseline: float
    ratio: float
    rows: float


def time_arm(source: Source, flags: Sequence[str]) -> Timed | str:
    """The arm's times, or why there are none."""
    with tempfile.TemporaryDirectory(prefix="ikgen-speed-") as folder:
        made = emit(source, Path(folder), "cpp")
        if made.header is None:
            return f"exit code {made.code}"
        _, numbers = run_program(SOURCE, made.header, flags)
    single, batch, baseline, ratio, error, rows = numbers
    if not error < BASELINE_ERROR:
        raise RuntimeError(f"the baseline is off by {error}")
    return Timed(source.key, source.family, single, batch, baseline, ratio, rows)


def table(timed: Sequence[Timed]) -> Iterator[str]:
    """A line a class, and one of all."""
    head = ("arms", "ns", "worst", "batch", "ratio", "worst")
    yield f"{'class':48} " + " ".join(f"{h:>8}" for h in head)
    families = sorted({t.family for t in timed})
    for family in [*families, ""]:
        rows = [t for t in timed if t.family == family or not family]
        single, ratio = [t.single for t in rows], [t.ratio for t in rows]
        batch = statistics.median(t.batch for t in rows)
        yield (
            f"{family[:48] or 'all':48} {len(rows):8} {statistics.median(single):8.0f} {max(single):8.0f} "
            f"{batch:8.0f} {statistics.median(ratio):8.2f} {max(ratio):8.2f}"
        )
    yield f"baseline: {statistics.median(t.baseline for t in timed):.0f} ns (median over the runs)"


def chosen(family: str, each: int | None) -> list[Source]:
    """The arms of the collection, or else the fixtures."""
    found = sources(("corpus",) if load_arms() else ("fixtures",))
    seen: Counter[str] = Counter()
    out = []
    for source in found:
        seen[source.family] += 1
        if family.lower() in source.family.lower() and (
            each is None or seen[source.family] <= each
        ):
            out.append(source)
    return out


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line an arm, then the table."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("--flags", choices=FLAGS, default="native")
    parser.add_argument("--family", default="", help="only classes whose name contains this")
    parser.add_argument("--each", type=int, help="the first N arms of each class")
    parser.add_argument("--record", action="store_true", help="write results/speed_by_class.json")
    options = parser.parse_args(arguments)
    if options.record and (options.family or options.each):
        parser.error("--record is for the whole collection")
    timed = []
    for source in chosen(options.family, options.each):
        found = time_arm(source, FLAGS[options.flags])
        if isinstance(found, str):
            print(f"{source.key:44} {found}", flush=True)
            continue
        timed.append(found)
        print(f"{found.name:44} {found.single:9.0f} ns, {found.ratio:.2f}", flush=True)
    if not timed:
        print("no arm was timed")
        return 1
    for line in table(timed):
        print(line)
    if options.record:
        command = f"python -m benchmarks.speed_by_class --flags {options.flags}"
        write_result("speed_by_class", command, {"arms": [asdict(t) for t in timed]})
    return 0


if __name__ == "__main__":
    sys.exit(main())
