"""Which functions of ikgen each test reaches, and in what time.

Functions of emitted code count as those of `runtime` whose names they have.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
from dataclasses import dataclass
from pathlib import Path
from types import CodeType, FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest

__all__ = ["Reach", "Reaching", "recorded"]

_LONGEST = 4.0  # processor time (s) of a test
_EMITTED = "emitted"


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


def recorded(file: Path) -> dict[str, Reach]:
    """What stands in the file, one test a line."""
    lines = file.read_text(encoding="utf-8").splitlines() if file.is_file() else []
    rows = [json.loads(line) for line in lines]
    return {row["test"]: Reach(row["seconds"], frozenset(row["functions"])) for row in rows}


def _plain(name: str) -> str:
    """A qualified name as runtime code and emitted code share it."""
    return ".".join(part.lstrip("_") for part in name.split("."))


class Reaching:
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


def _processor_time() -> float:
    """Of this process and those that it started (s)."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def _late(*_: object) -> None:
    raise TimeoutError
