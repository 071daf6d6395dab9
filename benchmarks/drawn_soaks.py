"""The loop of `perturbed_arms` and `table_soak`: what is drawn, one after the other, emitted and soaked."""

from __future__ import annotations

import argparse
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from benchmarks.command_line import Emitted, Source, emit
from benchmarks.cpp_speed import FLAGS
from benchmarks.soak import soak
from benchmarks.soak_counts import Soak, table

__all__ = ["ABOVE", "add_options", "soak_drawn"]

ABOVE = 1e-5
"""Smallest singular value from which on nothing may be missed."""


def add_options(parser: argparse.ArgumentParser, count: int, poses: int, near: int) -> None:
    """What `soak_drawn` reads, with these defaults."""
    parser.add_argument("--count", type=int, default=count, help="how many are drawn")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--poses", type=int, default=poses, help="random poses of each")
    parser.add_argument("--near", type=int, default=near, help="poses beside singularities")
    parser.add_argument("--keep", type=Path, help="folder for the files of arms that failed")


def soak_drawn(options: argparse.Namespace, draw: Callable[[int, Path], tuple[Source, str]]) -> int:
    """Prints a line for each that `draw` (number, empty folder) gives, with the text beside it, and the
    counts of those that failed; returns 1 where one of them failed, 2 where one was not solved."""
    failed = missing = False
    for number in range(options.count):
        with tempfile.TemporaryDirectory(prefix="ikgen-drawn-") as folder:
            arm, text = draw(number, Path(folder))
            made = emit(arm, Path(folder), "cpp")
            found = _soaked(made, options.poses, options.near)
            head = f"{number:4} {arm.key:40} {text:22} {_task(made):18}"
            if not isinstance(found, Soak):
                missing = True
                print(head, found, flush=True)
                continue
            wrong = found.failures(ABOVE)
            print(head, f"{wrong} failures of {found.rows} rows", flush=True)
            if wrong or found.totals[2] + found.totals[5]:
                print("\n".join(table(found)), flush=True)
            if wrong:
                failed = True
                if options.keep:
                    shutil.copytree(folder, options.keep / f"{options.seed}-{number}")
    return 2 if missing else int(failed)


def _soaked(made: Emitted, poses: int, near: int) -> Soak | str:
    """What was found of the arm's header, or why there is none."""
    if made.header is None:
        return f"exit code {made.code}: {made.answer.get('error', '')}"
    return soak(made, poses, near, flags=FLAGS["native"])


def _task(made: Emitted) -> str:
    """The task that is solved, and how its first unknown is found."""
    solved = made.answer.get("solved") or [{"leaf": "elimination"}]
    return f"{made.answer.get('task', '-')} {solved[0]['leaf']}"
