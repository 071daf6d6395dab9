"""Runs that are killed at random moments over outputs that are there: what is lost, mixed or left behind.

    python -m benchmarks.kills [--kills N] [--seed N] [--record [--add]]

Two descriptions of an arm take turns, so that every run would replace all files. A run is killed
(SIGKILL, as the system's memory killer does) at a moment drawn over its whole
time, two thirds of them over its end, where files are moved. Afterwards the folder holds the files of one
run, all of them; or what is there says itself that it is not whole: `ikgen build --check` exits
with 1, no file of another run stands beside it, and the next run completes it. Exit code 1 where
anything else was found.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from benchmarks import warm_runs
from benchmarks.command_line import FIXTURES
from benchmarks.results import added_counts, write_result
from benchmarks.turns import BUILD, Project, verdict

__all__ = ["main"]


def killed(project: Project, seconds: float, draw: random.Random) -> bool:
    """Start a build and kill it; whether it was still running."""
    build = project.start(BUILD)
    sign = draw.choice(("", ".ikgen-*", ".ikgen-*/journal.json"))
    while sign and not build.ended() and not list(project.out.glob(sign)):
        time.sleep(1e-5)  # till files are staged, or about to be moved
    time.sleep(draw.uniform(0.0, 1e-3 if sign else seconds))
    os.kill(build.pid, signal.SIGKILL)
    return build.wait() == -signal.SIGKILL


def killed_once(project: Project, turn: int, seconds: float, draw: random.Random) -> str:
    """What one kill left, in words; those that begin with "WRONG" must not be."""
    project.use(turn)
    was = project.files()
    if not killed(project, seconds, draw):
        return "finished before"
    return verdict(project, turn, project.files(), was)


def run(kills: int, seed: int) -> Counter[str]:
    """What the kills left; runs that finished before do not count."""
    warm_runs.load("from-urdf", str(FIXTURES / "ur5e.urdf"), "--no-verify", "-q")
    draw, counts = random.Random(seed), Counter[str]()
    folder = Path(tempfile.mkdtemp(prefix="kills-"))
    try:
        project = Project(folder)
        started = time.monotonic()
        project.run(BUILD)
        seconds, turn = time.monotonic() - started, 0
        while counts.total() - counts["finished before"] < kills:
            counts[killed_once(project, turn, seconds, draw)] += 1
            turn += 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return counts


def main() -> int:
    """Count what the kills left."""
    parser = argparse.ArgumentParser(description="Runs killed at random moments.")
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--record", action="store_true", help="write benchmarks/results/kills.json")
    parser.add_argument("--add", action="store_true", help="to what is recorded of this commit")
    options = parser.parse_args()
    counts = run(options.kills, options.seed)
    for words, count in counts.most_common():
        print(f"{count:5}  {words}")
    wrong = sum(count for words, count in counts.items() if words.startswith("WRONG"))
    if options.record:
        left = added_counts("kills", "left", counts) if options.add else dict(counts)
        kills = sum(left.values()) - left.get("finished before", 0)
        wrong = sum(count for words, count in left.items() if words.startswith("WRONG"))
        found = {"kills": kills, "wrong": wrong, "left": left}
        write_result("kills", "python -m benchmarks.kills", found)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
