"""Random DH tables: their headers put through random poses and others beside singularities.

    python -m benchmarks.table_soak [--class 3-6] [--right-angles] [--count 40] [--seed 1]
        [--poses 5000] [--near 60000] [--keep DIR]

What `benchmarks.random_chains` draws (classes are `3-6`, whose twists are right angles, and such as `6R` or
`5R1P`, of arbitrary twists or, with `--right-angles`, of these), without the verification, and what
`benchmarks.soak` counts: small arms of no maker meet in more ways than the collection's. A line for each
table, with its pattern and the leaf that solves its first unknown, and the counts of those with a wrong row
or a pose without any; 1 at the end where a row is wrong, or anything is missed or unanswered at smallest
singular values from 1e-5 on, 2 where a table is not solved. `--keep` leaves the files of those in a folder.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from benchmarks.command_line import Source
from benchmarks.drawn_soaks import add_options, soak_drawn
from benchmarks.random_chains import drawn_class, tables
from benchmarks.random_tables import pattern, table_text

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line a table, and the counts of those that failed."""
    layout = argparse.RawTextHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=layout)
    parser.add_argument("--class", dest="name", default="3-6")
    parser.add_argument("--right-angles", action="store_true")
    add_options(parser, count=40, poses=5_000, near=60_000)
    options = parser.parse_args(arguments)
    kind = drawn_class(options.name)
    if options.right_angles:
        kind = replace(kind, any_angle=False)
    drawn = tables(kind, options.seed, 0, options.count)

    def draw(number: int, folder: Path) -> tuple[Source, str]:
        _, dh = next(drawn)
        path = folder / "table.toml"
        path.write_text(table_text(dh, "arm"), encoding="utf-8")
        return Source(f"{options.name}/{options.seed}/{number}", options.name, path), pattern(dh)

    return soak_drawn(options, draw)


if __name__ == "__main__":
    sys.exit(main())
