"""Being ended by signals: with the stack unwound, so that nothing is left behind.

The system's default for SIGTERM (what a CI job gets at its time limit) ends a process on the spot: its
workers, compilers and temporary folders stay.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Sequence
from types import FrameType
from typing import TYPE_CHECKING, NoReturn

from ikgen.processes.scratch_folder import remove_own

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

__all__ = [
    "TERMINATED",
    "Terminated",
    "end_now",
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
    for name in _SIGNALS:
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _raise)


def _raise(number: int, frame: FrameType | None) -> None:
    signal.signal(number, signal.SIG_IGN)  # the next must not interrupt the unwinding
    raise Terminated


def end_with_parent() -> None:
    """For workers: end when the process that started this one has ended, however it did. What the keyboard
    interrupts is that process, which then ends its workers."""
    from multiprocessing import parent_process

    signal.signal(signal.SIGTERM, _raise_and_watch)
    unwind_on_signals()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()
    if parent is not None:
        threading.Thread(target=_await, args=(parent.sentinel,), daemon=True).start()


def _await(sentinel: int) -> None:
    from multiprocessing.connection import wait

    wait([sentinel])
    signal.raise_signal(signal.SIGTERM)
    _end_late()


def _raise_and_watch(number: int, frame: FrameType | None) -> None:
    """`_raise`, for a worker: an exception is lost where a finalizer is what the signal interrupts."""
    threading.Thread(target=_end_late, daemon=True).start()
    _raise(number, frame)


def _end_late() -> NoReturn:
    """End this process where unwinding does not: before its parent's patience ends too."""
    time.sleep(0.8 * _GRACE)
    end_now()


def end_now() -> NoReturn:
    """End this process without unwinding (a pool would go on with the next piece); its temporary folders
    are removed."""
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
