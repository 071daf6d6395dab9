"""Work in processes of their own, inside a copy of this repository's files."""

from __future__ import annotations

import contextlib
import os
import resource
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

from benchmarks.collection import CORPUS
from benchmarks.command_line import REPOSITORY

__all__ = ["forked", "settle"]

_MEMORY = 6 << 30


def settle(folder: Path, *, keep: bool) -> None:
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


def forked(
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
                settle(folder, keep=keep)
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
