"""Tests that are collected once, and run in forks in which one function has other code."""

from __future__ import annotations

import gc
import json
import os
import signal
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import FunctionType
from typing import TYPE_CHECKING

from benchmarks.forked_work import forked, settle
from benchmarks.function_codes import functions_of

if TYPE_CHECKING:
    import pytest

__all__ = ["LATE", "Failing", "Server", "pytest_options"]

LATE = 4.0  # times a test's time
_START = 3.0  # s


def pytest_options(folder: Path) -> list[str]:
    """Of all runs in a copy of the tree."""
    return [
        "-q", "-p", "no:cacheprovider", "--hypothesis-seed=0", "-m", "not slow and not long",
        f"--basetemp={folder / 'scratch'}",
    ]  # fmt: skip


class Server:
    """A process that has collected the tests of the files in a copy of the tree, and runs some in forks."""

    def __init__(self, folder: Path, files: Sequence[str]) -> None:
        asking, self._ask = os.pipe()
        self._answer, answering = os.pipe()
        self._child = os.fork()
        if self._child == 0:
            try:
                os.close(self._ask)
                os.close(self._answer)
                settle(folder, keep=False)
                import pytest

                serving = _Serving(folder / "src" / "ikgen", asking, answering)
                pytest.main([*pytest_options(folder), *files], plugins=[serving])
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
        code = functions_of(compile(file.read_bytes(), str(file), "exec"))[function]
        if not those or any(len(f.__code__.co_freevars) != len(code.co_freevars) for f in those):
            return None

        def work(say: int) -> None:
            for one in those:
                one.__code__ = code
            signal.signal(signal.SIGPROF, signal.SIG_DFL)
            chosen = [(items[test], seconds) for test, seconds in tests.items() if test in items]
            self._session.config.pluginmanager.register(Failing([], say))
            following = [item for item, _ in chosen[1:]] + [None]
            for (item, seconds), after in zip(chosen, following, strict=False):
                signal.setitimer(signal.ITIMER_PROF, _START + LATE * seconds)
                item.config.hook.pytest_runtest_protocol(item=item, nextitem=after)

        return forked(work, 60.0 + 20.0 * sum(tests.values()), None)


class Failing:
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
