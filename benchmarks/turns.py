"""A project whose arm has two descriptions that take turns: what is left of a run that was disturbed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

from benchmarks import warm_runs
from benchmarks.command_line import REPOSITORY

__all__ = ["BUILD", "CHECK", "FORCED", "Project", "verdict"]

ROBOT = REPOSITORY / "examples/setuptools_robot/urdf/elbow.urdf"
CONFIG = """
[[arm]]
name = "arm"
robot = "arm.urdf"
task = "position"
emit = ["python", "cpp"]
out = "out"
"""
BUILD = ("build", "-q", "--no-verify")
CHECK = (*BUILD, "--check")
FORCED = ("from-urdf", "-q", "--no-verify", "--task", "position", "--emit", "python,cpp",
          "--name", "arm", "--force", "-o", "out")  # fmt: skip


class Project:
    """A folder in `place` with one arm, its two descriptions and what each gives, and with the `scratch`
    folder that runs take for temporary files; what they print lies beside it."""

    def __init__(self, place: Path) -> None:
        self.place = place
        self.folder = place / "project"
        self.out = self.folder / "out"
        self.scratch = self.folder / "scratch"
        self.scratch.mkdir(parents=True)
        (self.folder / "ikgen.toml").write_text(CONFIG, encoding="utf-8")
        self.robots = [ROBOT.read_text(encoding="utf-8")]
        self.robots.append(self.robots[0].replace('xyz="0.3 0 0"', 'xyz="0.35 0 0"'))
        if self.robots[0] == self.robots[1]:
            raise RuntimeError("the example's forearm is no longer 0.3 m long")
        self.given: list[dict[str, str]] = []
        for turn in range(2):
            self.use(turn)
            code, said = self.run(BUILD)
            if code != 0:
                raise RuntimeError(said)
            self.given.append(self.files())

    def use(self, turn: int) -> None:
        """Make one of the descriptions that of the arm."""
        (self.folder / "arm.urdf").write_text(self.robots[turn % 2], encoding="utf-8")

    def files(self) -> dict[str, str]:
        """What a user or a compiler finds."""
        return {p.name: p.read_text("utf-8") for p in sorted(self.out.glob("[!.]*"))}

    def start(
        self, command: Sequence[str], before: Callable[[], None] = lambda: None, said: str = "said"
    ) -> warm_runs.WarmRun:
        """Begin a command in the folder."""
        environment = {"TMPDIR": str(self.scratch)}
        return warm_runs.start(command, self.folder, self.place / said, environment, before)

    def run(
        self, command: Sequence[str], before: Callable[[], None] = lambda: None
    ) -> tuple[int, str]:
        """A command to its end: exit code, and what it printed on stderr."""
        run = self.start(command, before)
        return run.wait(), run.said

    def renew(self, turn: int) -> None:
        """Begin anew with one of the descriptions, after a run that left what it must not."""
        for folder in (self.out, self.scratch):
            shutil.rmtree(folder)
            folder.mkdir()
        self.use(turn)
        self.run(BUILD)

    def is_half(self) -> bool:
        """Whether a publishing has begun and not ended."""
        return bool(list(self.out.glob(".ikgen-*/journal.json")))

    def litter(self) -> list[str]:
        """What no run should leave."""
        left = [*self.out.glob(".*"), *self.scratch.iterdir()]
        return [os.fspath(path.relative_to(self.folder)) for path in left]


def verdict(project: Project, turn: int, found: dict[str, str], was: dict[str, str]) -> str:
    """What a disturbed run left, in words; those that begin with "WRONG" must not be. `found` stands there
    after it, `was` before it."""
    new = project.given[turn % 2]
    half = project.is_half()
    stale, _ = project.run(CHECK)
    words = _in_words(found, was, new, half)
    if (found != new or half) and stale != 1:
        words = f"WRONG: not told (exit code {stale})"
    code, said = project.run(BUILD)
    if code != 0 or project.files() != new:
        return f"WRONG: not mended: {said[-300:]}"
    left = project.litter()
    return f"WRONG: left {left}" if left else words


def _in_words(found: dict[str, str], was: dict[str, str], new: dict[str, str], half: bool) -> str:
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
