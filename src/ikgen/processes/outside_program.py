"""Other programs, run with a time limit and a bound on what is kept of what they print.

A compiler is several processes: all of them end where one takes too long or ikgen is ended, since they
form a group of their own.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import select
import shutil
import signal
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import IO

from ikgen.errors import MissingToolError, UsageError

__all__ = [
    "SECONDS_VARIABLE",
    "Finished",
    "RunningProgram",
    "end_programs",
    "run_program",
    "time_limit",
]

SECONDS_VARIABLE = "IKGEN_TOOL_SECONDS"
"""Environment variable: how long a compiler or a compiled driver may run."""

_SECONDS = 600.0
_MOST_KEPT = 64 * 1024
_PIECE = 64 * 1024
_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of prctl(2)
_RUNNING: set[int] = set()
"""Process numbers of the programs that run."""


@dataclass(frozen=True, slots=True)
class Finished:
    """How a program ended: its exit code, negative for the signal that ended it; the beginning of what it
    printed on stderr; whether the time limit ended it."""

    code: int
    printed: str
    late: bool = False

    @property
    def crashed(self) -> bool:
        """Whether a signal ended it, of itself or (shells tell so) of what it had started."""
        return self.code < 0 or self.code > 128

    @property
    def words(self) -> str:
        """How it ended, to follow its name."""
        if self.late:
            return f"takes more than {time_limit():g} s"
        if self.crashed:
            number = -self.code if self.code < 0 else self.code - 128
            try:
                return f"was ended by {signal.Signals(number).name}"
            except ValueError:
                return f"ended with exit code {self.code}"
        return f"ended with exit code {self.code}"


def time_limit() -> float:
    """The limit (s) of one run; raises `UsageError` where the environment names none that is a number."""
    text = os.environ.get(SECONDS_VARIABLE, "")
    try:
        seconds = float(text or _SECONDS)
    except ValueError:
        seconds = 0.0
    if not 0.0 < seconds < float("inf"):
        raise UsageError(
            f"{SECONDS_VARIABLE}={text}: no number of seconds", hint="give one above 0"
        )
    return seconds


class RunningProgram:
    """A program that was started, without input, and runs while this process goes on; it ends with this
    object. Raises `MissingToolError` where it cannot be started."""

    def __init__(
        self,
        command: Sequence[str],
        *,
        cwd: Path | None = None,
        environment: Mapping[str, str] | None = None,
    ) -> None:
        limit = time_limit()
        self._process = _started(command, cwd, environment)
        self._deadline = time.monotonic() + limit
        _RUNNING.add(self._process.pid)
        self._end = weakref.finalize(self, _ended, self._process)
        self._kept = bytearray()
        self._reader = threading.Thread(
            target=_keep, args=(self._process.stderr, self._kept), daemon=True
        )
        self._reader.start()

    def finished(self) -> Finished:
        """Wait for its end, or for the time limit since its start; nothing of it is left."""
        late = False
        try:
            _await_end(self._process.pid, self._deadline)
            self._process.wait(max(0.0, self._deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            late = True
        finally:  # an interrupt too
            self.end()
        printed = bytes(self._kept).decode("utf-8", "replace")
        return Finished(self._process.returncode, printed, late)

    def end(self) -> None:
        """End it, with all that it started, if it has not ended yet."""
        self._end()
        self._reader.join(1.0)


def run_program(
    command: Sequence[str], *, cwd: Path | None = None, environment: Mapping[str, str] | None = None
) -> Finished:
    """Run a program to its end, without input; raises `MissingToolError` where it cannot be started."""
    return RunningProgram(command, cwd=cwd, environment=environment).finished()


def _started(
    command: Sequence[str], cwd: Path | None, environment: Mapping[str, str] | None
) -> subprocess.Popen[bytes]:
    guard = _dying_command() if shutil.which(command[0]) else ()
    try:
        return subprocess.Popen(
            [*guard, *command],
            cwd=cwd,
            env=None if environment is None else {**environment},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            start_new_session=True,
            preexec_fn=None if guard else _dying_with_parent(),
        )
    except (OSError, ValueError, subprocess.SubprocessError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise MissingToolError(
            f"{command[0]} cannot be started: {reason}", hint="check that it is a program"
        ) from error


def _await_end(number: int, deadline: float) -> None:
    """Sleep until a process has ended, or the deadline, where the system tells its end (Linux): else
    `Popen.wait` looks after it ever more seldom, up to 0.05 s late."""
    if not hasattr(os, "pidfd_open"):
        return
    with contextlib.suppress(OSError):  # it is gone, or this system has none
        handle = os.pidfd_open(number)
        try:
            end = select.poll()
            end.register(handle, select.POLLIN)
            end.poll(max(0.0, 1000.0 * (deadline - time.monotonic())))
        finally:
            os.close(handle)


def _ended(process: subprocess.Popen[bytes]) -> None:
    """End a process's group; none of it is left, nor waited for."""
    _end_group(process.pid)
    process.wait()
    _RUNNING.discard(process.pid)


def _keep(stream: IO[bytes], kept: bytearray) -> None:
    """Read to the end, and keep the beginning: a program whose pipe is full would wait for ever."""
    with stream:
        while piece := os.read(stream.fileno(), _PIECE):
            kept += piece[: _MOST_KEPT - len(kept)]


def end_programs() -> None:
    """End those that run, for a process that ends without unwinding."""
    for number in list(_RUNNING):
        _end_group(number)


def _end_group(number: int) -> None:
    """End what is left of a program's group."""
    with contextlib.suppress(OSError):
        if hasattr(os, "killpg"):
            os.killpg(number, signal.SIGKILL)
        else:
            os.kill(number, signal.SIGTERM)  # Windows: at once


@cache
def _dying_command() -> tuple[str, ...]:
    """What, before a command, makes it end with this process, where there is such a program (Linux): with
    it a process starts in a tenth of the time, as nothing of this one is copied for it."""
    tool = shutil.which("setpriv") if sys.platform.startswith("linux") else None
    if tool is None:
        return ()
    command, nothing = (tool, "--pdeathsig", "KILL"), subprocess.DEVNULL
    tried = subprocess.run(
        [*command, "true"], stdin=nothing, stdout=nothing, stderr=nothing, check=False
    )
    return () if tried.returncode else command


def _dying_with_parent() -> Callable[[], object] | None:
    """What makes a new process end with this one, where the system can (Linux)."""
    if not sys.platform.startswith("linux"):
        return None
    library = ctypes.CDLL(None)  # loaded here: after fork only system calls are safe
    if not hasattr(library, "prctl"):
        return None
    return lambda: library.prctl(_DEATH_SIGNAL, signal.SIGKILL)
