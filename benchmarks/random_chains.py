"""Random chains: whether all are solved, and whether what was solved is right and complete.

    python -m benchmarks.random_chains [--class NAME] [--count N] [--first N] [--seed N] [--poses N]
        [--search N] [--derive-only] [--emit python,cpp] [--log FILE] [--again] [--done] [--record]

Modified DH tables, each through `ikgen from-dh` with its whole verification, special poses included.
Classes are `3-6`, 300 tables of so many joints, a quarter of them prismatic, twists (of slides theta
too) of 0 and ±90 degrees and about half of the lengths zero; and `6R`, `5R1P` and `4R2P`, together 100 of
arbitrary twists, whose solutions at 20 poses a table are compared with those of an independent search,
Newton's method from many random starts, which goes on longer where it has found fewer.
Any other class of these forms (`4-5`, `3R2P`) may be named. Arms whose joints are not independent (a
smaller rank than joints) are drawn again: they have infinitely many solutions.

What is done stands in FILE, one JSON object a line, and a run with the same file goes on behind it; with
`--again` after those that failed were tried anew; `--done` sums up what stands there. `--derive-only`
leaves out the command line and its verification: the rules, then the eliminations, and the same
comparisons. Exits with 1 where a table is not solved, wrong or incomplete.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_chains import ELIMINATION, NEITHER, RULES, Extent, Outcome, outcome
from benchmarks.random_tables import Drawn, random_table
from benchmarks.results import write_result
from ikgen.model.dh import DHChain

__all__ = ["drawn_class", "main", "totals"]


@dataclass(frozen=True, slots=True)
class Share:
    """How many tables of a class are drawn, and at how many poses of each solutions are searched."""

    tables: int
    search: int


CLASSES = {"3-6": Share(300, 0), "6R": Share(34, 20), "5R1P": Share(33, 20), "4R2P": Share(33, 20)}
"""What is taken where no class is named."""
_OTHER = Share(10, 20)
_BESIDE = re.compile(r"([1-9]\d*) missed, all of them among \d+ poses near singularities")
"""What verification says of poses beside singularities, where its own count does not fail."""


def drawn_class(name: str) -> Drawn:
    """What a class's name says: `3-6` or `5R1P`; raises `ValueError` for others."""
    if found := re.fullmatch(r"(\d)-(\d)", name):
        return Drawn(int(found[1]), int(found[2]))
    if found := re.fullmatch(r"(\d)R(?:(\d)P)?", name):
        slides = int(found[2] or 0)
        joints = int(found[1]) + slides
        return Drawn(joints, joints, slides, any_angle=True)
    raise ValueError(f"a class of tables is 3-6 or 5R1P, say, and not {name!r}")


def tables(drawn: Drawn, seed: int, first: int, count: int) -> Iterator[tuple[int, DHChain]]:
    """So many of a class behind the first ones, with their numbers."""
    rng = np.random.default_rng(seed)
    for number in range(first + count):
        dh = random_table(rng, drawn)
        if number >= first:
            yield number, dh


class Log:
    """What was done, by class, seed and number, in memory and in a file where one is named."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self.found: dict[tuple[str, int, int], Outcome] = {}
        text = path.read_text(encoding="utf-8") if path is not None and path.is_file() else ""
        for line in text.splitlines():
            key, row = json.loads(line)
            self.found[key[0], key[1], key[2]] = Outcome(**row)

    def add(self, key: tuple[str, int, int], done: Outcome) -> None:
        """In place of an earlier outcome of the same table."""
        self.found[key] = done
        if self._path is not None:
            lines = [json.dumps([list(k), asdict(o)]) + "\n" for k, o in self.found.items()]
            new = self._path.with_name(self._path.name + ".new")
            new.write_text("".join(lines), encoding="utf-8")
            new.replace(self._path)


def run(options: argparse.Namespace, log: Log, folder: Path) -> dict[str, list[Outcome]]:
    """The outcomes of each class, those of the log among them."""
    found: dict[str, list[Outcome]] = {}
    for name in options.classes or CLASSES:
        share = CLASSES.get(name, _OTHER)
        count = share.tables - options.first if options.count is None else options.count
        search = share.search if options.search is None else options.search
        extent = Extent(not options.derive_only, options.emit, options.poses, search)
        found[name] = []
        for number, dh in tables(drawn_class(name), options.seed, options.first, count):
            key = (name, options.seed, number)
            done = log.found.get(key)
            if done is None and options.done:
                continue
            if done is None or (options.again and not done.good):
                done = outcome(dh, folder, extent, number)
                log.add(key, done)
                print(line(name, number, done), flush=True)
            found[name].append(done)
    return found


def line(name: str, number: int, done: Outcome) -> str:
    """What is printed of a table."""
    left = [
        f"{count} {word}"
        for count, word in (
            (int(done.refused), "refused"), (done.wrong, "wrong"), (done.missed, "missed"),
            (done.searched - done.equal, "counted otherwise by search"),
        )
        if count
    ]  # fmt: skip
    return f"{name} #{number} {done.chain}: {done.way} {', '.join(left)} {done.said}"


def totals(name: str, found: Sequence[Outcome]) -> dict[str, Any]:
    """The figures of a class."""
    ways = Counter(o.way for o in found)
    beside = [int(text) for o in found for text in _BESIDE.findall(o.said)]
    seconds = [o.seconds for o in found]
    return {
        "class": name,
        "tables": len(found),
        "solved": sum(o.way != NEITHER and not o.refused for o in found),
        "by_rules": ways[RULES],
        "by_elimination": ways[ELIMINATION],
        "wrong": sum(o.wrong for o in found),
        "missed": sum(o.missed for o in found),
        "beside": sum(beside),
        "beside_tables": len(beside),
        "searched": sum(o.searched for o in found),
        "equal": sum(o.equal for o in found),
        "median": round(float(np.median(seconds)), 2),
        "longest": max(seconds),
        "commits": sorted({o.commit for o in found}),
    }


def parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    """The options."""
    layout = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("--class", dest="classes", action="append", metavar="NAME",
                        help="repeatable (default: 3-6, 6R, 5R1P, 4R2P)")  # fmt: skip
    parser.add_argument("--count", type=int, help="tables a class")
    parser.add_argument("--first", type=int, default=0, help="tables to draw and leave out")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--poses", type=int, default=100, help="to check the rows at")
    parser.add_argument("--search", type=int, help="poses a table to compare with a search")
    parser.add_argument("--derive-only", action="store_true", help="not through `ikgen from-dh`")
    parser.add_argument("--emit", default="python", help="what `ikgen from-dh` writes")
    parser.add_argument("--log", type=Path, help="file of what is done, to go on from")
    parser.add_argument("--again", action="store_true", help="try anew what failed")
    parser.add_argument("--done", action="store_true", help="nothing but what stands in the log")
    parser.add_argument("--record", action="store_true", help="write results/random_chains.json")
    options = parser.parse_args(arguments)
    for name in options.classes or ():
        try:
            drawn_class(name)
        except ValueError as error:
            parser.error(str(error))
    return options


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line a table and the figures of each class; 1 where one failed."""
    options = parsed(arguments)
    with tempfile.TemporaryDirectory() as folder:
        found = run(options, Log(options.log), Path(folder))
    rows = [totals(name, outcomes) for name, outcomes in found.items() if outcomes]
    for row in rows:
        print(", ".join(f"{key} {value}" for key, value in row.items() if key != "commits"))
    if options.record:
        write_result("random_chains", "python -m benchmarks.random_chains", {"classes": rows})
    return int(not all(o.good for outcomes in found.values() for o in outcomes))


if __name__ == "__main__":
    sys.exit(main())
