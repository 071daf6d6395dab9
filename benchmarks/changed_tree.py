"""A copy of this tree in which one module at a time is changed, and its tests, run till one fails.

Which functions of ikgen a test reaches is recorded once, with its time; functions of emitted code count as
those of `runtime` whose names they have. A change inside a function is tested in a fork of a process that
has collected all tests, its function given the changed code; any other in one that imports ikgen anew.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import resource
import shutil
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import CodeType, FrameType, FunctionType
from typing import TYPE_CHECKING

from benchmarks.code_mutations import CodeMutation
from benchmarks.collection import CORPUS
from benchmarks.command_line import REPOSITORY

if TYPE_CHECKING:
    import pytest

__all__ = ["Reach", "Server", "Tree", "recorded", "surrounding"]

_NEEDED = (
    "src", "templates", "tests", "benchmarks", "urdf_fixtures", "examples", "docs", "hooks",
    "pyproject.toml", "README.md", "CHANGELOG.md",
)  # fmt: skip
_LONGEST = 4.0  # processor time (s) of a test
_LATE = 4.0  # times a test's time
_MEMORY = 6 << 30
_EMITTED = "emitted"
_OPTIONS = ("-q", "-p", "no:cacheprovider", "--hypothesis-seed=0", "-m", "not slow and not long")


@dataclass(frozen=True, slots=True)
class Reach:
    """Of a test that passes: its processor time (s) with its fixtures', and the functions that it calls,
    each "path in src/ikgen::qualified name" or "emitted::name"."""

    seconds: float
    functions: frozenset[str]

    def of(self, path: str, function: str | None) -> bool:
        """Whether it calls the function of the module at `path`; None: any of the module's."""
        if function is None:
            return any(name.startswith(f"{path}::") for name in self.functions)
        bare = f"{_EMITTED}::{_plain(function)}"
        return f"{path}::{function}" in self.functions or (
            path.startswith("runtime/") and bare in self.functions
        )


def surrounding(text: bytes, mutation: CodeMutation) -> str | None:
    """The qualified name of the outermost function whose body has the change; None outside of all."""
    same = [_named(compile(t, "", "exec")) for t in (text, mutation.applied(text))]
    if _rest(compile(text, "", "exec")) != _rest(compile(mutation.applied(text), "", "exec")):
        return None
    changed = [name for name, code in same[0].items() if _key(same[1].get(name)) != _key(code)]
    return changed[0] if len(changed) == 1 and "<" not in changed[0] else None


def _named(module: CodeType) -> dict[str, CodeType]:
    """Functions of a module and of its classes, not those inside functions."""
    found: dict[str, CodeType] = {}
    for code in module.co_consts:
        if isinstance(code, CodeType):
            if code.co_flags & 0x2:  # CO_NEWLOCALS: a function
                found[code.co_qualname] = code
            else:
                found.update(_named(code))
    return found


def _key(code: CodeType | None) -> object:
    """What a code does, without its place in the file."""
    if code is None:
        return None
    parts = tuple(
        _key(c) if isinstance(c, CodeType) else (type(c), repr(c)) for c in code.co_consts
    )
    return code.co_code, code.co_names, code.co_varnames, code.co_freevars, parts


def _rest(code: CodeType) -> object:
    """What a module and its classes do when they are imported."""
    inside = [
        _rest(c) if not c.co_flags & 0x2 else c.co_qualname
        for c in code.co_consts
        if isinstance(c, CodeType)
    ]
    plain = [(type(c), repr(c)) for c in code.co_consts if not isinstance(c, CodeType)]
    return code.co_code, code.co_names, inside, plain


def _plain(name: str) -> str:
    """A qualified name as runtime code and emitted code share it."""
    return ".".join(part.lstrip("_") for part in name.split("."))


class Tree:
    """A copy of this repository's files."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        ignored = shutil.ignore_patterns("__pycache__", "build")
        for name in _NEEDED:
            place = REPOSITORY / name
            if place.is_dir():
                shutil.copytree(place, folder / name, ignore=ignored, symlinks=True)
            else:
                shutil.copy2(place, folder / name)

    @contextlib.contextmanager
    def changed(self, path: str, mutation: CodeMutation) -> Iterator[None]:
        """The module with the change."""
        file = self.folder / "src" / "ikgen" / path
        text, was = file.read_bytes(), file.stat()
        shutil.rmtree(self.folder / "cache", ignore_errors=True)
        file.write_bytes(mutation.applied(text))
        try:
            yield
        finally:  # with its time, so that what Python compiled of it counts again
            file.write_bytes(text)
            os.utime(file, ns=(was.st_atime_ns, was.st_mtime_ns))

    def run_anew(self, tests: Mapping[str, float]) -> str:
        """The first test that fails in a process that imports ikgen anew, or how else it ended; nothing
        where all pass. tests: their times (s)."""

        def work(say: int) -> None:
            import pytest

            notes = _Failing(list(tests), say)
            files = dict.fromkeys(test.split("::")[0] for test in tests)
            seconds = int(30.0 + _LATE * sum(tests.values()))
            resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
            code = int(pytest.main([*_OPTIONS, "-x", self._scratch, *files], plugins=[notes]))
            os.write(
                say, (notes.failed or ("" if code in (0, 5) else f"exit code {code}")).encode()
            )

        return _forked(work, 600.0 + 20.0 * sum(tests.values()), self.folder)

    def record(self, files: Sequence[str], to: Path) -> None:
        """Write what the tests of the files reach."""

        def work(say: int) -> None:
            import pytest

            notes = _Reaching(self.folder / "src" / "ikgen", to)
            options = [*_OPTIONS, self._scratch, "--continue-on-collection-errors"]
            pytest.main([*options, *files], plugins=[notes])

        _forked(work, 7200.0, self.folder, keep=True)
        with to.open("a", encoding="utf-8") as stream:  # so that those without tests are known too
            for file in files:
                stream.write(
                    json.dumps({"test": f"{file}::", "seconds": 0.0, "functions": []}) + "\n"
                )

    @property
    def _scratch(self) -> str:
        return f"--basetemp={self.folder / 'scratch'}"


def recorded(file: Path) -> dict[str, Reach]:
    """What stands in the file, one test a line."""
    lines = file.read_text(encoding="utf-8").splitlines() if file.is_file() else []
    rows = [json.loads(line) for line in lines]
    return {row["test"]: Reach(row["seconds"], frozenset(row["functions"])) for row in rows}


class Server:
    """A process that has collected the tests of the files, and runs some of them in forks."""

    def __init__(self, tree: Tree, files: Sequence[str]) -> None:
        asking, self._ask = os.pipe()
        self._answer, answering = os.pipe()
        self._child = os.fork()
        if self._child == 0:
            try:
                os.close(self._ask)
                os.close(self._answer)
                _settle(tree.folder, keep=False)
                import pytest

                serving = _Serving(tree.folder / "src" / "ikgen", asking, answering)
                pytest.main([*_OPTIONS, tree._scratch, *files], plugins=[serving])
            finally:
                os._exit(0)
        os.close(asking)
        os.close(answering)
        self._said = os.fdopen(self._answer, "r", encoding="utf-8")
        if self._said.readline() != "ready\n":
            raise SystemExit("the tests cannot be collected")

    def run(self, path: str, function: str, tests: Mapping[str, float]) -> str | None:
        """The first test that fails with the function's code as the module has it now, or how else it
        ended; nothing where all pass. None where no function can be given that code."""
        os.write(self._ask, (json.dumps([path, function, dict(tests)]) + "\n").encode())
        answer: str | None = json.loads(self._said.readline())
        return answer

    def close(self) -> None:
        os.close(self._ask)
        os.waitpid(self._child, 0)


class _Serving:
    """A plug-in of pytest: runs what it is asked for instead of everything."""

    def __init__(self, source: Path, asking: int, answering: int) -> None:
        self._source = source
        self._asking, self._answering = asking, answering

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        self._session = session
        items = {item.nodeid: item for item in session.items}
        every: dict[tuple[str, str], list[FunctionType]] = {}
        for one in gc.get_objects():
            if isinstance(one, FunctionType) and one.__code__.co_filename.startswith(
                str(self._source)
            ):
                name = Path(one.__code__.co_filename).relative_to(self._source).as_posix()
                every.setdefault((name, one.__code__.co_qualname), []).append(one)
        gc.freeze()
        os.write(self._answering, b"ready\n")
        with os.fdopen(self._asking, encoding="utf-8") as asked:
            for line in iter(asked.readline, ""):
                path, function, tests = json.loads(line)
                said = self._one(every.get((path, function), []), path, function, tests, items)
                os.write(self._answering, (json.dumps(said) + "\n").encode())
        return True

    def _one(
        self,
        those: list[FunctionType],
        path: str,
        function: str,
        tests: dict[str, float],
        items: dict[str, pytest.Item],
    ) -> str | None:
        file = self._source / path
        code = _named(compile(file.read_bytes(), str(file), "exec"))[function]
        if not those or any(len(f.__code__.co_freevars) != len(code.co_freevars) for f in those):
            return None

        def work(say: int) -> None:
            for one in those:
                one.__code__ = code
            signal.signal(signal.SIGPROF, signal.SIG_DFL)
            chosen = [(items[test], seconds) for test, seconds in tests.items() if test in items]
            self._session.config.pluginmanager.register(_Failing([], say))
            following = [item for item, _ in chosen[1:]] + [None]
            for (item, seconds), after in zip(chosen, following, strict=False):
                signal.setitimer(signal.ITIMER_PROF, 3.0 + _LATE * seconds)
                item.config.hook.pytest_runtest_protocol(item=item, nextitem=after)

        return _forked(work, 60.0 + 20.0 * sum(tests.values()), None)


class _Failing:
    """A plug-in of pytest: runs the tests that are wanted (none: all), in their order, and ends the process
    at the first that fails, having said which."""

    def __init__(self, wanted: Sequence[str], say: int) -> None:
        self.failed = ""
        self._wanted, self._say = wanted, say

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        by_name = {item.nodeid: item for item in items}
        items[:] = [by_name[test] for test in self._wanted if test in by_name]

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            os.write(self._say, report.nodeid.encode())
            os._exit(0)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed and not self.failed:
            self.failed = f"import of {report.nodeid}"


class _Reaching:
    """A plug-in of pytest: writes what each test that passes reaches."""

    def __init__(self, source: Path, to: Path) -> None:
        self._source, self._to = f"{source}{os.sep}", to
        self._called: dict[int, CodeType] = {}
        self._started = 0.0

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self._called.clear()
        self._started = _processor_time()
        signal.signal(signal.SIGPROF, _late)
        signal.signal(signal.SIGALRM, _late)
        signal.setitimer(signal.ITIMER_PROF, 1.5 * _LONGEST)
        signal.setitimer(signal.ITIMER_REAL, 20.0 * _LONGEST)
        sys.settrace(self._note)
        threading.settrace(self._note)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "setup" and report.passed:
            return
        sys.settrace(None)
        threading.settrace(None)  # type: ignore[arg-type]
        seconds = round(_processor_time() - self._started, 3)
        if report.when == "call" and report.passed and seconds < _LONGEST:
            found = sorted({self._name(c) for c in self._called.values()} - {""})
            row = {"test": report.nodeid, "seconds": seconds, "functions": found}
            with self._to.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(row) + "\n")

    def _note(self, frame: FrameType, event: str, argument: object) -> None:
        code = frame.f_code
        if id(code) not in self._called:
            self._called[id(code)] = code

    def _name(self, code: CodeType) -> str:
        name = code.co_qualname.split(".<locals>")[0]
        if name.startswith("<"):
            return ""
        if code.co_filename.startswith(self._source):
            return f"{code.co_filename.removeprefix(self._source)}::{name}"
        away = ("site-packages", "lib/python", f"{os.sep}tests{os.sep}", "<frozen")
        return "" if any(a in code.co_filename for a in away) else f"{_EMITTED}::{_plain(name)}"


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
        IKGEN_CACHE_DIR=str(folder / "cache"),
        PATH=str(Path(sys.executable).parent),
        PYTHONDONTWRITEBYTECODE="" if keep else "1",
    )


def _forked(
    work: Callable[[int], None], seconds: float, folder: Path | None, *, keep: bool = False
) -> str:
    """What `work` writes to the descriptor that it is given, in a process of its own, settled in the folder
    where there is one; or how that process ended. After `seconds` it is ended."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.close(reading)
            if folder is not None:
                _settle(folder, keep=keep)
            else:
                os.setsid()
            work(writing)
        except BaseException as error:
            os.write(writing, f"not run: {error!r}".encode())
        finally:
            os._exit(0)
    os.close(writing)
    try:
        return _awaited(child, reading, seconds)
    finally:
        os.close(reading)


def _awaited(child: int, reading: int, seconds: float) -> str:
    """What the child wrote; it and all that it started are ended."""
    deadline = time.monotonic() + seconds
    ended, status = 0, 0
    while not ended and time.monotonic() < deadline:
        time.sleep(0.01)
        ended, status = os.waitpid(child, os.WNOHANG)
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(child, signal.SIGKILL)
    if not ended:
        os.waitpid(child, 0)
        return "too late"
    if os.WIFSIGNALED(status):
        late = (signal.SIGXCPU, signal.SIGKILL, signal.SIGPROF)
        return "too late" if os.WTERMSIG(status) in late else "crashed"
    return os.read(reading, 4096).decode("utf-8", "replace")


def _processor_time() -> float:
    """Of this process and those that it started (s)."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _late(*_: object) -> None:
    raise TimeoutError
