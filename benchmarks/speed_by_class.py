"""C++ ns a pose of the whole collection by class, beside a hand-written solver of one class.

    python -m benchmarks.speed_by_class [--flags native] [--family TEXT] [--each N] [--jobs N] [--record]

Every header is timed in one process with the baseline, in turns (`cpp/ortho_parallel.hpp`: the published
formulas for an ortho-parallel base and a spherical wrist, as one writes them by hand). "ratio" is the
median over the arms of a class of the header's time over the baseline's in the same run, "worst" the
largest. `--each N` takes the first N arms of each class; `--jobs N` works on N arms at once, which takes
from all the same. Without the collection it takes the fixtures. What machines with AVX-512 and without
record stands side by side.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.collection import load_arms
from benchmarks.command_line import Source, emit, sources
from benchmarks.cpp_speed import FLAGS, run_program
from benchmarks.results import write_result
from ikgen.verify.runners.cpp_toolchain import find_compiler

SOURCE = Path(__file__).resolve().parent / "cpp" / "by_class.cpp"
RECORDS = {"AVX-512": "speed_by_class", "AVX2": "speed_by_class_avx2"}
"""Results by the widest vectors of the machine that they are from."""

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


@dataclass(frozen=True, slots=True)
class Class:
    """The arms of one class: medians of `single`, `batch` (ns a pose) and `ratio`, the largest of the first
    and of the last, and the arm that has it."""

    family: str
    arms: int
    single: float
    worst_single: float
    batch: float
    ratio: float
    worst_ratio: float
    worst: str


def by_class(timed: Sequence[Timed]) -> list[Class]:
    """The classes by name, then all arms as one, "all"."""
    families = sorted({t.family for t in timed})
    groups = [(family, [t for t in timed if t.family == family]) for family in families]
    return [_class(family, group) for family, group in [*groups, ("all", list(timed))]]


def _class(family: str, timed: Sequence[Timed]) -> Class:
    single, batch, ratio = (
        [round(getattr(t, name), digits) for t in timed]
        for name, digits in (("single", 0), ("batch", 0), ("ratio", 3))
    )
    slowest = max(timed, key=lambda t: t.ratio).name
    return Class(
        family, len(timed), statistics.median(single), max(single), statistics.median(batch),
        statistics.median(ratio), max(ratio), slowest,
    )  # fmt: skip


def table(timed: Sequence[Timed]) -> Iterator[str]:
    """A line a class, and one of all."""
    head = ("arms", "ns", "worst", "batch", "ratio", "worst")
    yield f"{'class':48} " + " ".join(f"{h:>8}" for h in head)
    for c in by_class(timed):
        yield (
            f"{c.family[:48]:48} {c.arms:8} {c.single:8.0f} {c.worst_single:8.0f} "
            f"{c.batch:8.0f} {c.ratio:8.2f} {c.worst_ratio:8.2f}"
        )
    yield f"baseline: {statistics.median(t.baseline for t in timed):.0f} ns (median over the runs)"


def instructions(flags: Sequence[str]) -> str:
    """The widest vectors that the compiler uses with these flags on this machine."""
    command = [*find_compiler(), *flags, "-dM", "-E", "-x", "c++", os.devnull]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    names = {"__AVX512F__": "AVX-512", "__AVX2__": "AVX2", "__AVX__": "AVX", "__ARM_NEON": "NEON"}
    return next((name for macro, name in names.items() if macro in done.stdout), "SSE2")


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
    parser.add_argument("--jobs", type=int, default=1, help="arms at a time")
    parser.add_argument("--record", action="store_true", help="write results/speed_by_class*.json")
    options = parser.parse_args(arguments)
    if options.record and (options.family or options.each):
        parser.error("--record is for the whole collection")
    widest = instructions(FLAGS[options.flags]) if options.record else ""
    if options.record and widest not in RECORDS:
        parser.error(f"--record is for {' and '.join(RECORDS)}, not for {widest}")
    timed: list[Timed] = []
    left: list[str] = []
    arms = chosen(options.family, options.each)
    with ThreadPoolExecutor(options.jobs) as pool:
        for source, found in zip(
            arms, pool.map(lambda arm: time_arm(arm, FLAGS[options.flags]), arms), strict=True
        ):
            if isinstance(found, str):
                print(f"{source.key:44} {found}", flush=True)
                left.append(source.key)
                continue
            timed.append(found)
            print(f"{found.name:44} {found.single:9.0f} ns, {found.ratio:.2f}", flush=True)
    if not timed:
        print("no arm was timed")
        return 1
    for line in table(timed):
        print(line)
    if options.record:
        chosen_options = f"--flags {options.flags} --jobs {options.jobs}"
        command = f"python -m benchmarks.speed_by_class {chosen_options}"
        write_result(
            RECORDS[widest],
            command,
            {
                "instructions": widest,
                "baseline": statistics.median(t.baseline for t in timed),
                "left": left,
                "classes": [asdict(c) for c in by_class(timed)],
            },
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
