"""Tests of the tests: how many small changes of the code, drawn by a seed, some test notices.

    python -m benchmarks.mutation_score [--count N] [--seed N] [--log FILE] [--again] [--record]

Changes of `forms`, `solver`, `lowering`, `program`, `runtime` (Python), `emit` and `verify`
(`benchmarks/code_mutations.py`) are drawn without regard to the package, so that however many are done
are a fair sample. Each is made in a copy of this tree, and tests that reach the changed function run till
one fails: first those of files that share a word with the module's name, then of others, the shortest of
each, together about ten seconds of processor time. None takes more than four seconds or needs a compiler,
so that the score is a lower bound of what all tests find. Golden files do not count for changes of
`runtime`, whose text they contain: they would notice any change and say nothing of what it does. A change
counts as found where a test fails, an import does, or a test takes more than four times the time that it
takes without it. What is done stands in FILE, one JSON object a line; a run with the same file goes on
behind it, with `--again` after those that no test found were tried anew. Changes not found are
printed, with the reason where none should be (`benchmarks/harmless_changes.py`). Exit code 1 where
fewer than 85 of 100 are found.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import random
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path

from benchmarks.changed_tree import Tree
from benchmarks.code_mutations import CodeMutation, code_mutations
from benchmarks.command_line import REPOSITORY
from benchmarks.forked_tests import Server
from benchmarks.function_codes import surrounding
from benchmarks.harmless_changes import why_harmless
from benchmarks.reached_functions import Reach, recorded
from benchmarks.results import write_result

__all__ = ["PACKAGES", "chosen", "drawn", "main", "score"]

PACKAGES = ("forms", "solver", "lowering", "program", "runtime", "emit", "verify")
_LOADED = ("numpy", "numpy.linalg", "pinocchio", "lxml.etree", "jinja2", "py_trees", "click", "pytest",
           "hypothesis", "multiprocessing", "concurrent.futures", "jsonschema", "sympy")  # fmt: skip
_FOLDERS = (
    "forms", "program", "lowering", "solver", "runtime", "verify", "emit", "golden", "elimination",
    "conformance", "equations", "robots", "report",
)  # fmt: skip
"""Folders of tests that are run: others start processes, or test other packages."""
_NEAR = (3.0, 6.0)  # times (s) of tests of a file near the module, and of all such
_OTHER = (1.0, 8.0)  # of another file, and of all
_LEAST = 0.85  # of all changes: a score to go out with


@dataclass(frozen=True, slots=True)
class Done:
    """What came of a mutation of the module at `path` (in src/ikgen): the first test that failed, or how
    else it was found; empty where it was not."""

    path: str
    mutation: CodeMutation
    found_by: str
    seconds: float

    @property
    def package(self) -> str:
        return self.path.split("/")[0]

    @property
    def harmless(self) -> str:
        """Why no test should notice it, where none does and that is known."""
        text = (REPOSITORY / "src" / "ikgen" / self.path).read_bytes()
        return "" if self.found_by else why_harmless(self.path, text, self.mutation)


def drawn(seed: int) -> list[tuple[str, CodeMutation]]:
    """All mutations of the packages, in the order that the seed gives."""
    source = REPOSITORY / "src" / "ikgen"
    paths = [p for package in PACKAGES for p in sorted((source / package).rglob("*.py"))]
    found = [
        (p.relative_to(source).as_posix(), mutation)
        for p in paths
        for mutation in code_mutations(p.read_bytes())
    ]
    random.Random(seed).shuffle(found)
    return found


def chosen(path: str, function: str | None, every: Mapping[str, Reach]) -> dict[str, float]:
    """The tests to run for a change in a function of the module at `path` (None: outside of all; then any
    where none reaches the module), in their order, with their times (s)."""
    anywhere = function is None and not any(reach.of(path, None) for reach in every.values())
    of_file: dict[str, dict[str, float]] = {}
    for test, reach in sorted(every.items(), key=lambda item: item[1].seconds):
        file = test.split("::")[0]
        golden = path.startswith("runtime/") and file.startswith("tests/golden/")
        if not golden and (anywhere or reach.of(path, function)):
            of_file.setdefault(file, {})[test] = reach.seconds
    words = _words(Path(path).stem)
    files = sorted(of_file, key=lambda file: not words & _words(Path(file).stem))
    found: dict[str, float] = {}
    for file in files:
        each, most = _NEAR if words & _words(Path(file).stem) else _OTHER
        left = min(most - sum(found.values()), each)
        for test, seconds in of_file[file].items():
            left -= seconds
            if left > 0.0:
                found[test] = seconds
    return found


def _words(name: str) -> set[str]:
    """Words of a module's name, by their beginnings: "slide" and "slides" are one."""
    return {word[:5] for word in name.split("_")} - {"test", "cpp", "python", "row", "form"}


def done_so_far(log: Path) -> list[Done]:
    """What stands in the file."""
    lines = log.read_text(encoding="utf-8").splitlines() if log.is_file() else []
    rows = [json.loads(line) for line in lines]
    return [Done(**{**row, "mutation": CodeMutation(**row["mutation"])}) for row in rows]


class Trial:
    """Changes of a copy of the tree, and the tests that are run for them."""

    def __init__(self, folder: Path, reached: Path) -> None:
        self.tree = Tree(folder)
        tests = [p for f in _FOLDERS for p in sorted((REPOSITORY / "tests" / f).glob("test_*.py"))]
        files = [p.relative_to(REPOSITORY).as_posix() for p in tests]
        known = {test.split("::")[0] for test in recorded(reached)}
        new = [file for file in files if file not in known]
        if new:
            self.tree.record(new, reached)
        every = recorded(reached)
        self.reached = {test: every[test] for test in every if test.split("::")[0] in files}
        self._files = files
        self._server: Server | None = None

    @property
    def server(self) -> Server:
        """Started where it is needed first."""
        if self._server is None:
            self._server = Server(self.tree.folder, self._files)
        return self._server

    def close(self) -> None:
        if self._server is not None:
            self._server.close()

    def __call__(self, path: str, mutation: CodeMutation) -> Done:
        started = time.monotonic()
        file = self.tree.folder / "src" / "ikgen" / path
        function = surrounding(file.read_bytes(), mutation)
        tests = chosen(path, function, self.reached)
        if not tests:  # a function that imports call, say
            function, tests = None, chosen(path, None, self.reached)
        with self.tree.changed(path, mutation):
            said = None if function is None else self.server.run(path, function, tests)
            if said is None:
                said = self.tree.run_anew(tests) if tests else ""
        return Done(path, mutation, said, round(time.monotonic() - started, 1))


def run(count: int, seed: int, log: Path, *, again: bool = False) -> list[Done]:
    """The first `count` of those that the seed draws, but those that stand in the file; those of it that
    were not found too, where `again` is set."""
    found = done_so_far(log)
    todo = drawn(seed)
    if [(d.path, d.mutation) for d in found] != todo[: len(found)]:
        raise SystemExit(f"{log} is of another seed or of other code")
    for name in _LOADED:
        with contextlib.suppress(ImportError):
            import_module(name)
    folder = Path(tempfile.mkdtemp(prefix="mutation-score-"))
    try:
        trial = Trial(folder, log.with_suffix(".reached"))
        for k, done in enumerate(found):
            if again and not done.found_by:
                found[k] = trial(done.path, done.mutation)
                _write(log, found)
        for path, mutation in todo[len(found) : count]:
            found.append(trial(path, mutation))
            _write(log, found)
        trial.close()
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return found[:count]


def _write(log: Path, found: Sequence[Done]) -> None:
    new = log.with_suffix(".new")
    new.write_text("".join(json.dumps(asdict(d)) + "\n" for d in found), encoding="utf-8")
    new.replace(log)


def score(found: Sequence[Done]) -> dict[str, tuple[int, int, int]]:
    """Package -> (found by a test, all, those that change nothing)."""
    every = Counter(d.package for d in found)
    noticed = Counter(d.package for d in found if d.found_by)
    same = Counter(d.package for d in found if d.harmless)
    return {p: (noticed[p], every[p], same[p]) for p in PACKAGES if every[p]}


def main() -> int:
    """Print what is not found, and the score by package."""
    parser = argparse.ArgumentParser(description="How many small changes of the code tests notice.")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--log", type=Path, default=Path("mutation_score.log"))
    parser.add_argument("--again", action="store_true", help="try anew those that were not found")
    parser.add_argument("--record", action="store_true", help="write the recorded result")
    options = parser.parse_args()
    found = run(options.count, options.seed, options.log, again=options.again)
    if not found:
        return 0
    for done in found:
        if not done.found_by:
            m = done.mutation
            why = f"  ({done.harmless})" if done.harmless else ""
            print(f"src/ikgen/{done.path}:{m.line}: {' '.join(m.old.split())} -> {m.new}{why}")
    by_package = score(found)
    noticed, every, same = (sum(row[k] for row in by_package.values()) for k in range(3))
    for name, row in {**by_package, "all": (noticed, every, same)}.items():
        print(
            f"{name:10} {row[0]:4} of {row[1]:4}  {row[0] / row[1]:6.1%}  {row[2]:3} change nothing"
        )
    if options.record:
        shown = {"seed": options.seed, "mutations": len(found), "found": by_package}
        write_result("mutation_score", "python -m benchmarks.mutation_score", shown)
    return 0 if noticed >= _LEAST * len(found) else 1


if __name__ == "__main__":
    sys.exit(main())
