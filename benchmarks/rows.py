"""Rows of emitted modules before and after a change: the same, arm by arm?

    PYTHONPATH=<old>/src python -m benchmarks.rows record old.npz [--poses 60] [--compiled 1]
    python -m benchmarks.rows record new.npz --poses-of old.npz
    python -m benchmarks.rows compare old.npz new.npz

`record` runs the command `python -m ikgen` that is on the path on the fixtures, the tables of the IKBT
suite and, where it is at hand, the collection of robots; it solves with the emitted module the same
poses each time: half of them random, a quarter with joints at multiples of 45 degrees, a quarter with
one joint 10^-1 to 10^-10 beside a right angle. `--poses-of` takes poses and held joints of an earlier
record, without which two records may differ by the last digits of their poses. `compare` exits with 1
where an arm differs: in rows (as sets, to 1e-9; closer to a singularity to what the last digits of a
pose move), statuses, or in that it is no longer solved.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from benchmarks.command_line import Source, sources
from benchmarks.row_comparison import Difference, compare, summary
from benchmarks.row_record import ArmRecord, load, record_arm, save

COLLECTIONS = ("fixtures", "suite", "corpus")


def record(options: argparse.Namespace) -> int:
    """Write the record; 0 even where arms are unsolved, which is part of it."""
    old = load(options.poses_of) if options.poses_of else {}
    wanted = [
        s for s in sources(options.collection)
        if (not options.arm or s.key.split("/")[1] in options.arm)
        and options.family.lower() in s.family.lower() and (not old or s.key in old)
    ]  # fmt: skip
    timed = _first_of_each(wanted, options.compiled)

    def run(source: Source) -> ArmRecord:
        return record_arm(source, options.poses, old.get(source.key), compiled=source.key in timed)

    records = []
    with ThreadPoolExecutor(options.jobs) as pool:
        for one in pool.map(run, wanted):
            records.append(one)
            rows = int(one.data["count"].sum()) if one.solved else 0
            print(f"{one.key:44} {one.facts['code']} {one.facts['derive']:6.1f} s {rows:5} rows"
                  f"  {one.facts['message'][:60]}", flush=True)  # fmt: skip
    save(options.out, records, {"poses": options.poses})
    return 0


def _first_of_each(wanted: Sequence[Source], count: int) -> set[str]:
    """The keys of the first arms of each class, whose headers are compiled and timed."""
    seen: Counter[str] = Counter()
    out = set()
    for source in wanted:
        seen[source.family] += 1
        if seen[source.family] <= count:
            out.add(source.key)
    return out


def report(options: argparse.Namespace) -> int:
    """Print what differs, and the ratios; 1 if anything differs."""
    old, new = load(options.old), load(options.new)
    both = [key for key in old if key in new]
    found = [compare(old[key], new[key]) for key in both]
    found += [Difference(key, state="only in one record") for key in old.keys() ^ new.keys()]
    for d in found:
        if d.note:
            print(f"{d.key:44} {d.note}")
        if not d.same:
            print(
                f"{d.key:44} {d.poses:3} of {d.compared} poses ({d.regular} regular): {d.lost} rows lost, "
                f"{d.gained} gained; {d.statuses} statuses or counts within limits  {d.state}"
            )
    largest = max((d.largest for d in found), default=0.0)
    print(f"{sum(d.same for d in found)} of {len(found)} arms the same; rows to {largest:.1e}")
    print("\nratios, new to old (medians)")
    for line in summary([old[k] for k in both], [new[k] for k in both]):
        print(line)
    return 0 if all(d.same for d in found) else 1


def main(arguments: Sequence[str] | None = None) -> int:
    """The command line."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    commands = parser.add_subparsers(required=True)
    one = commands.add_parser("record", help="solve and write a record")
    one.add_argument("out", type=Path)
    one.add_argument("--poses", type=int, default=60)
    one.add_argument("--poses-of", type=Path, help="an earlier record")
    one.add_argument("--collection", nargs="+", choices=COLLECTIONS, default=list(COLLECTIONS))
    one.add_argument("--family", default="", help="only classes whose name contains this")
    one.add_argument("--arm", action="append", default=[], help="only this arm (repeatable)")
    one.add_argument("--compiled", type=int, default=0, help="headers a class to compile and time")
    one.add_argument("--jobs", type=int, default=1)
    one.set_defaults(run=record)
    two = commands.add_parser("compare", help="compare two records")
    two.add_argument("old", type=Path)
    two.add_argument("new", type=Path)
    two.set_defaults(run=report)
    options = parser.parse_args(arguments)
    return int(options.run(options))


if __name__ == "__main__":
    sys.exit(main())
