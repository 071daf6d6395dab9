"""Runs that are killed at random moments over outputs that are there: what is lost, mixed or left behind.

    python -m benchmarks.kills [--kills N] [--seed N] [--record]

Two descriptions of an arm take turns, so that every run would replace all files. A run is killed
(SIGKILL, of the process alone as the system's memory killer does) at a moment drawn over its whole
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
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from benchmarks.command_line import REPOSITORY
from benchmarks.results import write_result

__all__ = ["main"]

ROBOT = REPOSITORY / "examples/setuptools_robot/urdf/elbow.urdf"
CONFIG = """
[[arm]]
name = "arm"
robot = "arm.urdf"
task = "position"
emit = ["python", "cpp"]
out = "out"
"""
BUILD = (sys.executable, "-m", "ikgen", "build", "-q", "--no-verify")
CHECK = (*BUILD, "--check")


class Project:
    """A folder with one arm, its two descriptions and what each gives."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.out = folder / "out"
        self.scratch = folder / "scratch"
        self.scratch.mkdir()
        (folder / "ikgen.toml").write_text(CONFIG, encoding="utf-8")
        self.robots = [ROBOT.read_text(encoding="utf-8")]
        self.robots.append(self.robots[0].replace('xyz="0.3 0 0"', 'xyz="0.35 0 0"'))
        if self.robots[0] == self.robots[1]:
            raise RuntimeError("the example's forearm is no longer 0.3 m long")
        self.given: list[dict[str, str]] = []
        self.seconds = 0.0
        for turn in range(2):
            self.use(turn)
            started = time.monotonic()
            subprocess.run(BUILD, cwd=folder, check=True, env=self._environment())
            self.seconds = time.monotonic() - started
            self.given.append(self.files())

    def _environment(self) -> dict[str, str]:
        return {**os.environ, "TMPDIR": str(self.scratch)}

    def use(self, turn: int) -> None:
        """Make one of the descriptions that of the arm."""
        (self.folder / "arm.urdf").write_text(self.robots[turn % 2], encoding="utf-8")

    def files(self) -> dict[str, str]:
        """What a user or a compiler finds."""
        return {p.name: p.read_text("utf-8") for p in sorted(self.out.glob("[!.]*"))}

    def run(self, command: tuple[str, ...]) -> int:
        """A command to its end."""
        return subprocess.run(command, cwd=self.folder, env=self._environment()).returncode

    def kill(self, draw: random.Random) -> bool:
        """Start a build and kill it; whether it was still running."""
        build = subprocess.Popen(BUILD, cwd=self.folder, env=self._environment())
        sign = draw.choice(("", ".ikgen-*", ".ikgen-*/journal.json"))
        while sign and build.poll() is None and not list(self.out.glob(sign)):
            time.sleep(1e-5)  # till files are staged, or about to be moved
        time.sleep(draw.uniform(0.0, 1e-3 if sign else self.seconds))
        build.send_signal(signal.SIGKILL)
        return build.wait() == -signal.SIGKILL


def killed_once(project: Project, turn: int, draw: random.Random) -> str:
    """What one kill left, in a word; words that begin with "WRONG" must not be."""
    project.use(turn)
    was = project.files()
    if not project.kill(draw):
        return "finished before"
    found = project.files()
    half = bool(list(project.out.glob(".ikgen-*/journal.json")))
    stale = project.run(CHECK)
    new = project.given[turn % 2]
    verdict = _verdict(found, was, new, half)
    if (found != new or half) and stale != 1:
        verdict = "WRONG: not told"
    if project.run(BUILD) != 0 or project.files() != new:
        return "WRONG: not mended"
    left = [*project.out.glob(".ikgen-*"), *project.scratch.iterdir()]
    return f"WRONG: left {left}" if left else verdict


def _verdict(found: dict[str, str], was: dict[str, str], new: dict[str, str], half: bool) -> str:
    if found == was:
        return "before the first file was moved"
    if found == new:
        return "after the last file was moved"
    solvers = {name: text for name, text in found.items() if not name.endswith(".json")}
    mixed = any(solvers.get(n) == was[n] for n in solvers) and any(
        solvers.get(n) == new[n] for n in solvers
    )
    if mixed or not half:
        return "WRONG: files of two runs"
    return "between: not loadable, told, and completed by the next run"


def main() -> int:
    """Count what the kills left."""
    parser = argparse.ArgumentParser(description="Runs killed at random moments.")
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--record", action="store_true", help="write benchmarks/results/kills.json")
    options = parser.parse_args()
    draw, counts = random.Random(options.seed), Counter[str]()
    folder = Path(tempfile.mkdtemp(prefix="kills-"))
    try:
        project = Project(folder)
        for turn in range(options.kills):
            counts[killed_once(project, turn, draw)] += 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    for words, count in counts.most_common():
        print(f"{count:5}  {words}")
    wrong = sum(count for words, count in counts.items() if words.startswith("WRONG"))
    if options.record:
        found = {"kills": options.kills, "wrong": wrong, "left": dict(counts)}
        write_result("kills", "python -m benchmarks.kills", found)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
