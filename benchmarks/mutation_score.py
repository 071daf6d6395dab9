"""Tests of the tests: how many small changes of the code, drawn by a seed, some test notices.

    python -m benchmarks.mutation_score [--count N] [--seed N] [--log FILE] [--record]

Changes of `forms`, `solver`, `lowering`, `program`, `runtime` (Python), `emit` and `verify`
(`benchmarks/code_mutations.py`) are drawn without regard to the package, so that however many are done
are a fair sample. Each is made in a copy of this tree, and tests run till one fails: of those that take
little, the ones of its package, then some that run emitted code of many arms; about ten seconds of them,
then a minute, and none that needs a compiler, so that the score is a lower bound of what all tests find.
Golden files are left out, which would notice any change of text and say nothing of what it does. A change
counts as found where a test fails, an import does, or the tests take more than four times the processor
time that they take without it. What is done stands in FILE, one JSON object a line; a run with the same
file goes on behind it. Changes that are not found are printed.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.code_mutations import CodeMutation, code_mutations
from benchmarks.collection import CORPUS
from benchmarks.command_line import REPOSITORY
from benchmarks.results import write_result

if TYPE_CHECKING:
    import pytest

__all__ = ["PACKAGES", "drawn", "files_for", "main"]

PACKAGES = ("forms", "solver", "lowering", "program", "runtime", "emit", "verify")
_LOADED = ("numpy", "numpy.linalg", "pinocchio", "lxml.etree", "jinja2", "py_trees", "click", "pytest",
           "hypothesis", "multiprocessing", "concurrent.futures", "jsonschema", "sympy")  # fmt: skip
_NEEDED = (
    "src",
    "templates",
    "tests",
    "benchmarks",
    "urdf_fixtures",
    "examples",
    "docs",
    "pyproject.toml",
)
_FURTHER = (
    "tests/conformance/test_python.py", "tests/robots/test_tables.py", "tests/elimination/test_*.py",
    "tests/conformance/test_special_poses.py",
)  # fmt: skip
_NEAREST = (
    "tests/conformance/test_projection.py", "tests/conformance/test_self_motion.py",
    "tests/conformance/test_follow.py", "tests/conformance/test_noisy_poses.py",
    "tests/kinematics/test_*.py", "tests/equations/test_*.py", "tests/lowering/test_*.py",
)  # fmt: skip
_LONGEST = 10.0  # processor time (s) of a test
_FIRST = (
    6.0,
    2.5,
    10.0,
)  # of the tests of a file near the module, of another's, of all that run first
_THEN = (40.0, 10.0, 60.0)  # of those that run where the first ones pass
_LATE = 4.0
_MEMORY = 6 << 30


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


def files_for(path: str) -> list[str]:
    """The files of tests that run for a module: those that share a word with its name, those of its
    package, others."""
    package = path.split("/")[0]
    usual = (f"tests/{package}/test_*.py", *_FURTHER)
    files = [p for pattern in usual for p in sorted(REPOSITORY.glob(pattern))]
    named = [p for pattern in _NEAREST for p in sorted(REPOSITORY.glob(pattern))]
    near = [p for p in (*files, *named) if _words(Path(path).stem) & _words(p.stem)]
    return list(dict.fromkeys(p.relative_to(REPOSITORY).as_posix() for p in (*near, *files)))


def _words(name: str) -> set[str]:
    """Words of a module's name, by their beginnings: "slide" and "slides" are one."""
    return {word[:5] for word in name.split("_")} - {"test", "cpp", "python", "row", "form"}


class Tree:
    """A copy of this repository's files, in which one module at a time is changed."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in _NEEDED:
            place = REPOSITORY / name
            ignored = shutil.ignore_patterns("__pycache__", "results", "build")
            if place.is_dir():
                shutil.copytree(place, folder / name, ignore=ignored, symlinks=True)
            else:
                shutil.copy2(place, folder / name)

    @contextlib.contextmanager
    def changed(self, path: str, mutation: CodeMutation) -> Iterator[None]:
        """The module with the change."""
        file = self.folder / "src" / "ikgen" / path
        text, was = file.read_bytes(), file.stat()
        file.write_bytes(mutation.applied(text))
        try:
            yield
        finally:  # with its time, so that what Python compiled of it counts again
            file.write_bytes(text)
            os.utime(file, ns=(was.st_atime_ns, was.st_mtime_ns))

    def run(self, tests: Iterable[str], seconds: float, times: Path | None = None) -> str:
        """The first test that fails, "too late" (seconds of processor time), or nothing where all pass.
        Where `times` is given all are run, and the time of those that pass is written there."""
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            self._run_here(tests, writing, seconds, times)
        os.close(writing)
        try:
            return _awaited(child, reading, seconds)
        finally:
            os.close(reading)

    def _run_here(
        self, tests: Iterable[str], writing: int, seconds: float, times: Path | None
    ) -> None:
        """In a process of its own, that ends here."""
        try:
            _settle(self.folder, keep=times is not None)
            import pytest

            notes = _Notes()
            files = dict.fromkeys(test.split("::")[0] for test in tests)
            if times is None:
                resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds)))
            options = [
                "-q",
                "-p",
                "no:cacheprovider",
                "--hypothesis-seed=0",
                "-m",
                "not slow and not long",
            ]
            options += ["-x"] if times is None else ["--continue-on-collection-errors"]
            if times is None:
                notes.wanted = set(tests)
            code = int(pytest.main([*options, *files], plugins=[notes]))
            if times is not None:
                times.write_text(json.dumps(notes.seconds, indent=0), encoding="utf-8")
            os.write(writing, (notes.failed or ("" if code == 0 else f"exit code {code}")).encode())
        except BaseException as error:
            os.write(writing, f"not run: {error!r}".encode())
        finally:
            os._exit(0)


def _settle(folder: Path, *, keep: bool) -> None:
    """Make this process one that works in the copy of the tree, prints nothing and finds no compiler (what
    needs one takes too long)."""
    os.setsid()
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    os.chdir(folder)
    silent = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(silent, stream)
    ours = (REPOSITORY, REPOSITORY / "src")
    here = [str(folder / "src"), str(folder)]
    sys.path[:] = here + [p for p in sys.path if p and Path(p).resolve() not in ours]
    for name in [n for n in sys.modules if n.split(".")[0] in ("ikgen", "benchmarks", "tests")]:
        del sys.modules[name]
    sys.dont_write_bytecode = not keep
    os.environ.update(
        PYTHONPATH=os.pathsep.join(here),
        IKGEN_CORPUS=str(CORPUS),
        PATH=str(Path(sys.executable).parent),
        PYTHONDONTWRITEBYTECODE="" if keep else "1",
    )


class _Notes:
    """A plug-in of pytest: runs the tests that are wanted (None: all), notes the times of those that pass
    and what failed first."""

    def __init__(self) -> None:
        self.failed = ""
        self.wanted: set[str] | None = None
        self.seconds: dict[str, float] = {}
        self._started = 0.0

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        if self.wanted is not None:
            items[:] = [item for item in items if item.nodeid in self.wanted]

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self._started = _processor_time()
        if self.wanted is None:
            signal.signal(signal.SIGPROF, _late)
            signal.setitimer(signal.ITIMER_PROF, 2.0 * _LONGEST)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed and not self.failed:
            self.failed = report.nodeid
        if report.when == "call" and report.passed:
            self.seconds[report.nodeid] = round(_processor_time() - self._started, 3)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed and not self.failed:
            self.failed = f"import of {report.nodeid}"


def _processor_time() -> float:
    """Of this process and those that it started (s)."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _late(*_: object) -> None:
    raise TimeoutError


def _awaited(child: int, reading: int, seconds: float) -> str:
    """What the child wrote; it and all that it started are ended."""
    deadline = time.monotonic() + 20.0 * seconds
    ended, status = 0, 0
    while not ended and time.monotonic() < deadline:
        time.sleep(0.02)
        ended, status = os.waitpid(child, os.WNOHANG)
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(child, signal.SIGKILL)
    if not ended:
        os.waitpid(child, 0)
        return "too late"
    if os.WIFSIGNALED(status):
        return "too late" if os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL) else "crashed"
    return os.read(reading, 4096).decode("utf-8", "replace")


class Baseline:
    """How long each test takes without a change (s), of those that pass; kept in `file`."""

    def __init__(self, tree: Tree, file: Path) -> None:
        if not file.is_file():
            paths = {path for path, _ in drawn(0)}
            every = dict.fromkeys(test for path in sorted(paths) for test in files_for(path))
            tree.run(list(every), 3600.0, times=file)
        self.seconds: dict[str, float] = json.loads(file.read_text(encoding="utf-8"))

    def stages(self, path: str) -> list[dict[str, float]]:
        """The tests to run for a module, with their times: some that take little, and more where those
        pass."""
        first = self._within(path, *_FIRST, set())
        return [first, self._within(path, *_THEN, set(first))]

    def _within(
        self, path: str, near: float, other: float, most: float, done: set[str]
    ) -> dict[str, float]:
        """Tests that are not done, the shortest of each file, till these times (s) are used."""
        of_file: dict[str, list[str]] = {file: [] for file in files_for(path)}
        for test, seconds in sorted(self.seconds.items(), key=lambda item: item[1]):
            file = test.split("::")[0]
            if file in of_file and seconds < _LONGEST and test not in done:
                of_file[file].append(test)
        found: dict[str, float] = {}
        for file, tests in of_file.items():
            alike = _words(Path(path).stem) & _words(Path(file).stem)
            left = min(most - sum(found.values()), near if alike else other)
            for test in tests:
                left -= self.seconds[test]
                if left > 0.0:
                    found[test] = self.seconds[test]
        return found


def _limit(tests: Mapping[str, float]) -> float:
    """The time (s) that tests may take, their imports too."""
    return 30.0 + _LATE * sum(tests.values())


def done_so_far(log: Path) -> list[Done]:
    """What stands in the file."""
    lines = log.read_text(encoding="utf-8").splitlines() if log.is_file() else []
    rows = [json.loads(line) for line in lines]
    return [Done(**{**row, "mutation": CodeMutation(**row["mutation"])}) for row in rows]


def run(count: int, seed: int, log: Path) -> list[Done]:
    """The first `count` of those that the seed draws, but those that stand in the file."""
    found = done_so_far(log)
    todo = drawn(seed)
    if [(d.path, d.mutation) for d in found] != todo[: len(found)]:
        raise SystemExit(f"{log} is of another seed or of other code")
    for name in _LOADED:
        with contextlib.suppress(ImportError):
            import_module(name)
    folder = Path(tempfile.mkdtemp(prefix="mutation-score-"))
    try:
        tree = Tree(folder)
        baseline = Baseline(tree, log.with_suffix(".times"))
        for path, mutation in todo[len(found) : count]:
            started = time.monotonic()
            with tree.changed(path, mutation):
                runs = (tree.run(tests, _limit(tests)) for tests in baseline.stages(path) if tests)
                said = next(filter(None, runs), "")
            done = Done(path, mutation, said, round(time.monotonic() - started, 1))
            found.append(done)
            with log.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(asdict(done)) + "\n")
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return found[:count]


def score(found: Sequence[Done]) -> dict[str, tuple[int, int]]:
    """Package -> (found by a test, all)."""
    every = Counter(d.package for d in found)
    noticed = Counter(d.package for d in found if d.found_by)
    return {package: (noticed[package], every[package]) for package in PACKAGES if every[package]}


def main() -> int:
    """Print what is not found, and the score by package."""
    parser = argparse.ArgumentParser(description="How many small changes of the code tests notice.")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--log", type=Path, default=Path("mutation_score.log"))
    parser.add_argument("--record", action="store_true", help="write the recorded result")
    options = parser.parse_args()
    found = run(options.count, options.seed, options.log)
    for done in found:
        if not done.found_by:
            m = done.mutation
            print(f"src/ikgen/{done.path}:{m.line}: {' '.join(m.old.split())} -> {m.new}")
    by_package = score(found)
    for package, (noticed, every) in by_package.items():
        print(f"{package:10} {noticed:4} of {every:4}  {noticed / every:6.1%}")
    noticed = sum(n for n, _ in by_package.values())
    print(f"{'all':10} {noticed:4} of {len(found):4}  {noticed / len(found):6.1%}")
    if options.record:
        shown = {"seed": options.seed, "mutations": len(found), "found": by_package}
        write_result("mutation_score", "python -m benchmarks.mutation_score", shown)
    return 0 if noticed >= 0.85 * len(found) else 1


if __name__ == "__main__":
    sys.exit(main())
