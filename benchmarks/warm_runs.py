"""The command line in forks of this process, which has loaded what it needs already: what matters of many
short runs is what they do, and most of their time would go into imports."""

from __future__ import annotations

import atexit
import os
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

__all__ = ["LATE", "WarmRun", "load", "start"]

LATE = -1000
"""Exit code of a run that its time limit ended."""

_LOADED = ("ikgen", "numpy", "pinocchio", "lxml", "jinja2", "py_trees", "xacro", "yaml", "click", "json",
           "multiprocessing", "concurrent", "tomllib", "asyncio", "importlib", "email", "uuid")  # fmt: skip


def load(*arguments: str) -> None:
    """Import what a run with these arguments imports, which goes to a folder of its own. Nothing else of it
    stays, so that later runs begin as new ones do."""
    folder = Path(tempfile.mkdtemp(prefix="warm-"))  # no object that forks would remove it with
    try:
        names = folder / "names"

        def note() -> None:
            atexit.register(lambda: names.write_text("\n".join(sys.modules), encoding="utf-8"))

        run = start(arguments, folder, folder / "said", before=note)
        if run.wait() != 0:
            raise RuntimeError(run.said)
        for name in names.read_text(encoding="utf-8").split():
            if name.startswith(_LOADED) and name not in sys.modules:
                import_module(name)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@dataclass(slots=True)
class WarmRun:
    """A running command: its process and where it writes what it prints on stderr."""

    pid: int
    stderr: Path

    def wait(self, seconds: float = 600.0) -> int:
        """Its exit code, negative for the signal that ended it, `LATE` where it takes too long."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            pid, status = os.waitpid(self.pid, os.WNOHANG)
            if pid:
                return os.waitstatus_to_exitcode(status)
            time.sleep(1e-3)
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        return LATE

    def ended(self) -> bool:
        """Whether it has ended, without waiting for it."""
        return os.waitid(os.P_PID, self.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None

    @property
    def said(self) -> str:
        """What it printed on stderr so far."""
        return self.stderr.read_text(encoding="utf-8", errors="replace")


def start(
    arguments: Sequence[str],
    folder: Path,
    stderr: Path,
    environment: dict[str, str] | None = None,
    before: Callable[[], None] = lambda: None,
) -> WarmRun:
    """`ikgen` with these arguments in a folder; `before` is called in its process, before it begins."""
    pid = os.fork()
    if pid == 0:
        _run(["ikgen", *arguments], folder, stderr, environment or {}, before)
    return WarmRun(pid, stderr)


def _run(
    argv: list[str],
    folder: Path,
    stderr: Path,
    environment: dict[str, str],
    before: Callable[[], None],
) -> None:
    """In the process of the run, which ends here."""
    code = 1
    try:
        out = os.open(os.devnull, os.O_RDWR)
        err = os.open(stderr, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
        for stream, to in ((0, out), (1, out), (2, err)):
            os.dup2(to, stream)
        os.environ.update(environment)
        tempfile.tempdir = None  # what this process knows of it
        os.chdir(folder)
        sys.argv = argv
        from ikgen.cli.main import main

        before()
        try:
            main()
        except SystemExit as error:
            code = error.code if isinstance(error.code, int) else 1
        atexit._run_exitfuncs()
        sys.stderr.flush()
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
    finally:
        os._exit(code)
