"""Two runs at once on one project: nothing is lost, nothing is half, nobody fails for the other's sake.

    python -m benchmarks.pairs [--pairs N] [--seed N] [--record]

Before each pair the arm gets its other description. Then two commands begin, the second a drawn time
after the first: two builds, a build and a check, a build and a run of `from-urdf` (all into the same
folder), or two runs of `from-urdf` of two descriptions, where the last to publish decides. Afterwards the
folder holds the files of one run, all of them; both have ended with exit code 0 (a check: 0 or 1); no
folder is left. Exit code 1 where anything else was found.
"""

from __future__ import annotations

import argparse
import random
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from benchmarks import warm_runs
from benchmarks.command_line import FIXTURES
from benchmarks.results import write_result
from benchmarks.turns import BUILD, CHECK, FORCED, Project

__all__ = ["KINDS", "main"]

KINDS: dict[str, tuple[Sequence[str], Sequence[str]]] = {
    "two builds": (BUILD, BUILD),
    "a build and a check": (BUILD, CHECK),
    "a build and from-urdf": (BUILD, (*FORCED, "arm.urdf")),
    "from-urdf of two descriptions": ((*FORCED, "arm.urdf"), (*FORCED, "other/arm.urdf")),
}


def pair(project: Project, turn: int, kind: str, apart: float) -> str:
    """What two runs left that begin some seconds `apart`, in words; those that begin with "WRONG" must not
    be."""
    project.use(turn)
    other = project.folder / "other" / "arm.urdf"
    other.parent.mkdir(exist_ok=True)
    other.write_text(project.robots[(turn + 1) % 2], encoding="utf-8")
    first, second = KINDS[kind]
    one = project.start(first, said="said")
    time.sleep(apart)
    two = project.start(second, said="said by the other")
    codes = one.wait(), two.wait()
    said = one.said + two.said
    if codes[0] != 0 or codes[1] not in ((0, 1) if second is CHECK else (0,)):
        return f"WRONG: exit codes {codes}: {said[-300:]}"
    if "Traceback" in said:
        return f"WRONG: {said[-300:]}"
    if left := project.litter():
        return f"WRONG: left {left}"
    return _whole(project, turn, both=kind == "from-urdf of two descriptions")


def _whole(project: Project, turn: int, *, both: bool) -> str:
    """Whether the folder's solvers are those of one run. Records name the file they were made from."""
    wanted = [project.given[turn % 2], *([project.given[(turn + 1) % 2]] if both else [])]
    found = project.files()
    for number, files in enumerate(wanted):
        if found.keys() == files.keys() and all(
            found[name] == files[name] for name in files if not name.endswith(".json")
        ):
            return "all files of the first" if number == 0 else "all files of the second"
    return "WRONG: not the files of one run"


def main() -> int:
    """Count what the pairs left."""
    parser = argparse.ArgumentParser(description="Two runs at once on one project.")
    parser.add_argument("--pairs", type=int, default=40)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--record", action="store_true", help="write benchmarks/results/pairs.json")
    options = parser.parse_args()
    warm_runs.load("from-urdf", str(FIXTURES / "ur5e.urdf"), "--no-verify", "-q")
    draw, counts = random.Random(options.seed), Counter[str]()
    folder = Path(tempfile.mkdtemp(prefix="pairs-"))
    try:
        project = Project(folder)
        for turn in range(options.pairs):
            kind = list(KINDS)[turn % len(KINDS)]
            words = pair(project, turn, kind, draw.choice((0.0, draw.uniform(0.0, 1.0))))
            counts[f"{kind}: {words}"] += 1
            if "WRONG" in words:
                print(f"pair {turn}: {kind}: {words}", flush=True)
            project.renew(turn)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    for words, count in sorted(counts.items()):
        print(f"{count:5}  {words}")
    wrong = sum(count for words, count in counts.items() if "WRONG" in words)
    if options.record:
        found = {"pairs": options.pairs, "wrong": wrong, "left": dict(counts)}
        write_result("pairs", "python -m benchmarks.pairs", found)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
