"""Being ended by signals: with the stack unwound, so that nothing is left behind.

The system's default for SIGTERM (what a CI job gets at its time limit) ends a process on the spot: its
workers, compilers and temporary folders stay.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Sequence
from types import FrameType
from typing import TYPE_CHECKING, NoReturn

from ikgen.processes.outside_program import end_programs
from ikgen.processes.scratch_folder import remove_own

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

__all__ = [
    "TERMINATED",
    "Terminated",
    "end_with_parent",
    "end_workers",
    "unwind_on_signals",
]

TERMINATED = 128 + signal.SIGTERM
"""Exit code of a command that SIGTERM ended, as shells say it."""

_GRACE = 5.0
"""Time (s) that a process has to unwind before it is killed."""

_SIGNALS = ("SIGTERM", "SIGHUP")


class Terminated(SystemExit):
    """Raised where a signal asked the process to end; no handler of errors stops it."""

    def __init__(self) -> None:
        super().__init__(TERMINATED)


def unwind_on_signals() -> None:
    """From now on `Terminated` is raised in the main thread where a signal would have ended the process at
    once. One that is ignored (`nohup`) stays so."""
    _on_signals(_raise)


def _on_signals(handler: Callable[[int, FrameType | None], NoReturn]) -> None:
    for name in _SIGNALS:
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, handler)


def _raise(number: int, frame: FrameType | None) -> NoReturn:
    signal.signal(number, signal.SIG_IGN)  # the next must not interrupt the unwinding
    raise Terminated


def end_with_parent() -> None:
    """For workers: end when the process that started this one has ended, however it did, and at once where
    a signal asks for it: the pool's own code would take an exception for a result, and go on. What the
    keyboard interrupts is that process, which then ends its workers."""
    from multiprocessing import parent_process

    _on_signals(_end)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()
    if parent is not None:
        threading.Thread(target=_await, args=(parent.sentinel,), daemon=True).start()


def _await(sentinel: int) -> None:
    from multiprocessing.connection import wait

    wait([sentinel])
    signal.raise_signal(signal.SIGTERM)
    time.sleep(_GRACE)  # the main thread looks after signals between its steps
    _end()


def _end(number: int = signal.SIGTERM, frame: FrameType | None = None) -> NoReturn:
    """End this process without unwinding; its programs are ended and its temporary folders removed."""
    end_programs()
    remove_own()
    os._exit(TERMINATED)


def end_workers(keep: Sequence[BaseProcess]) -> None:
    """End the processes that `multiprocessing` started from this one, but those to `keep`."""
    import multiprocessing

    workers = [process for process in multiprocessing.active_children() if process not in keep]
    for worker in workers:
        worker.terminate()
    deadline = time.monotonic() + _GRACE
    for worker in workers:
        worker.join(max(0.0, deadline - time.monotonic()))
        if worker.is_alive():
            worker.kill()
