"""Disk faults at each call that changes a file: what is lost, mixed or left behind.

    python -m benchmarks.faults [--most N] [--seed N] [--record]

Two descriptions of an arm take turns, so that every run would replace all files. In each run one call of
the system that writes, makes, moves or removes something in the project or in the folder for temporary
files fails: the disk is full from there on, everything is read-only from there on, one call gives an
input/output error, or the process is killed there. A run that was not killed must end with exit code 2
and words on what happened (or 0, with all of its files), no traceback; the folder holds the files of one
run, all of them, or says itself that it is not whole; the next run completes it, and nothing is left. Exit
code 1 where anything else was found. Needs a C compiler and a system where libraries can be loaded before
the C library (Linux).
"""

from __future__ import annotations

import argparse
import atexit
import ctypes
import errno
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from benchmarks import warm_runs
from benchmarks.command_line import REPOSITORY
from benchmarks.results import write_result
from benchmarks.turns import BUILD, Project, verdict

__all__ = ["KINDS", "main"]

LIBRARY = "IKGEN_FAULTS_LIBRARY"
"""Environment variable: the library that is loaded, set by this command for itself."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of fault: the error's number (0: a kill), and which calls it concerns from its moment on: one
    (0), all (1), all that need room (2)."""

    words: str
    error: int
    calls: int


KINDS = (
    Kind("disk full", errno.ENOSPC, 2),
    Kind("read-only", errno.EROFS, 1),
    Kind("input/output error", errno.EIO, 0),
    Kind("killed", 0, 0),
)


def armed(folder: Path, number: int, kind: Kind) -> Callable[[], None]:
    """What arms the library in the process that calls it."""

    def arm() -> None:
        _library().fault_arm(os.fsencode(folder), ctypes.c_long(number), kind.error, kind.calls)

    return arm


def _library() -> ctypes.CDLL:
    return ctypes.CDLL(os.environ[LIBRARY])


def calls_of_a_run(project: Project, turn: int, kind: Kind) -> int:
    """How many calls of a run the kind concerns."""
    project.use(turn)
    seen = project.place / "seen"

    def note() -> None:
        armed(project.folder, 0, kind)()
        atexit.register(lambda: seen.write_text(str(_library().fault_seen())))

    project.run(BUILD, before=note)
    return int(seen.read_text())


def with_one_fault(project: Project, turn: int, number: int, kind: Kind) -> str:
    """What a run with a fault at its call `number` left, in words; those that begin with "WRONG" must not
    be."""
    project.use(turn)
    was, new = project.files(), project.given[turn % 2]
    code, said = project.run(BUILD, before=armed(project.folder, number, kind))
    found = project.files()
    if kind.error and not _is_told(code, said, kind):
        return f"WRONG: exit code {code}: {said[-300:]}"
    if code == 0 and found != new:
        return "WRONG: not all files, and exit code 0"
    return verdict(project, turn, found, was)


def _is_told(code: int, said: str, kind: Kind) -> bool:
    if "Traceback" in said or "please report" in said or code not in (0, 2):
        return False
    return code == 0 or os.strerror(kind.error) in said


def moments(project: Project, most: int, draw: random.Random) -> Iterator[tuple[int, Kind]]:
    """Each call of each kind, or as many of them as are wanted."""
    every = [
        (number, kind)
        for turn, kind in enumerate(KINDS)
        for number in range(1, calls_of_a_run(project, turn, kind) + 1)
    ]
    yield from every if len(every) <= most else sorted(draw.sample(every, most), key=every.index)


def run(most: int, seed: int) -> dict[str, Counter[str]]:
    """What was left, by kind of fault."""
    warm_runs.load("from-urdf", str(REPOSITORY / "urdf_fixtures/ur5e.urdf"), "--no-verify", "-q")
    counts = {kind.words: Counter[str]() for kind in KINDS}
    folder = Path(tempfile.mkdtemp(prefix="faults-"))
    try:
        project = Project(folder)
        for turn, (number, kind) in enumerate(list(moments(project, most, random.Random(seed)))):
            words = with_one_fault(project, turn, number, kind)
            counts[kind.words][words] += 1
            if words.startswith("WRONG"):
                print(f"{kind.words} at call {number}: {words}", flush=True)
                project.renew(turn)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return counts


def compiled(folder: Path) -> Path:
    """The library that makes calls fail; raises `RuntimeError` where it cannot be compiled."""
    compiler = shutil.which("cc")
    if compiler is None:
        raise RuntimeError("needs a C compiler")
    library = folder / "libfaults.so"
    source = REPOSITORY / "benchmarks" / "cpp" / "faults.c"
    subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", library, source, "-ldl"], check=True)
    return library


def main() -> int:
    """Count what the faults left."""
    parser = argparse.ArgumentParser(description="Runs with a fault of the disk.")
    parser.add_argument("--most", type=int, default=1000, help="as many faults at most")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--record", action="store_true", help="write benchmarks/results/faults.json"
    )
    options = parser.parse_args()
    if LIBRARY not in os.environ:
        with tempfile.TemporaryDirectory(prefix="faults-") as folder:
            library = str(compiled(Path(folder)))
            environment = {**os.environ, "LD_PRELOAD": library, LIBRARY: library}
            command = [sys.executable, "-m", "benchmarks.faults", *sys.argv[1:]]
            return subprocess.run(command, env=environment).returncode
    counts = run(options.most, options.seed)
    wrong = 0
    for kind, left in counts.items():
        for words, count in left.most_common():
            print(f"{kind:20} {count:4}  {words[:100]}")
            wrong += count if words.startswith("WRONG") else 0
    if options.record:
        faults = sum(sum(left.values()) for left in counts.values())
        found = {"faults": faults, "wrong": wrong, "left": {k: dict(c) for k, c in counts.items()}}
        write_result("faults", "python -m benchmarks.faults", found)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
