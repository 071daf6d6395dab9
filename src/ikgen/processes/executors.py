"""Work in pieces on several processes, of this machine or of a Dask cluster; whatever runs it speaks
`concurrent.futures.Executor`."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import (
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    as_completed,
)
from dataclasses import dataclass
from typing import TypeVar

from ikgen.errors import MissingToolError, UsageError
from ikgen.processes.termination import end_with_parent, end_workers

__all__ = ["EXECUTORS", "Workers", "run_pieces", "spare_cores"]

EXECUTORS = ("process", "dask")

P = TypeVar("P")
R = TypeVar("R")

_ATTEMPTS = 4
"""Pools that may lose a worker before the work is given up."""


def spare_cores() -> int:
    """How many cores this process may use beside its own; none where it is one of a pool, which uses
    them."""
    if multiprocessing.parent_process() is not None:
        return 0
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0)) - 1
    return (os.cpu_count() or 1) - 1


@dataclass(frozen=True, slots=True)
class Workers:
    """Which executor, how many workers (None: one a core) and, of Dask, the address of a scheduler that
    runs already (None: a cluster of its own on this machine)."""

    executor: str = "process"
    count: int | None = None
    scheduler: str | None = None

    def __post_init__(self) -> None:
        if self.executor not in EXECUTORS:
            hint = f"there are: {', '.join(EXECUTORS)}"
            raise UsageError(f"--executor {self.executor}: no such executor", hint=hint)
        if self.scheduler is not None and self.executor != "dask":
            raise UsageError("--scheduler needs --executor dask", hint="add it")

    @property
    def processes(self) -> int:
        """How many there are to be."""
        return self.count or os.cpu_count() or 1

    @contextlib.contextmanager
    def open(self) -> Iterator[Executor]:
        """The executor, closed at the end; where the work is broken off its processes are ended."""
        if self.executor == "dask":
            with _dask(self) as executor:
                yield executor
            return
        context = multiprocessing.get_context("spawn")
        others = multiprocessing.active_children()
        with ProcessPoolExecutor(self.processes, context, end_with_parent) as pool:
            try:
                yield pool
            except BaseException:  # whoever stops asking, or is ended, does not wait for the rest
                pool.shutdown(wait=False, cancel_futures=True)
                end_workers(others)
                raise


@contextlib.contextmanager
def _dask(workers: Workers) -> Iterator[Executor]:
    try:
        from distributed import Client, LocalCluster
    except ImportError as error:
        hint = "pip install 'ikgen[dask]'"
        raise MissingToolError(
            "--executor dask needs the package distributed", hint=hint
        ) from error
    with contextlib.ExitStack() as stack:
        address = workers.scheduler
        if address is None:
            cluster = LocalCluster(
                n_workers=workers.processes, threads_per_worker=1, dashboard_address=None
            )
            address = stack.enter_context(cluster)
        try:
            client = stack.enter_context(Client(address, timeout="20s"))
        except OSError as error:
            hint = "check that dask-scheduler runs there"
            raise UsageError(f"--scheduler {address}: no answer", hint=hint) from error
        yield client.get_executor(pure=False)


def run_pieces(
    workers: Workers | None,
    work: Callable[[P], R],
    pieces: Sequence[P],
    done: Callable[[int, int], None] = lambda ready, total: None,
) -> list[R]:
    """`work` of each piece, in their order whoever ends first; `done` is told how many are ready. Without
    `workers` this process does it.

    Where a worker is lost its pieces are begun again, by Dask or in a new pool. Raises what `work` raises,
    and `MissingToolError` where pool after pool loses a worker.
    """
    results: dict[int, R] = {}
    if workers is None:
        return [work(piece) for piece in pieces]
    for _ in range(_ATTEMPTS):
        with contextlib.suppress(BrokenExecutor), workers.open() as executor:
            left = [i for i in range(len(pieces)) if i not in results]
            waiting: dict[Future[R], int] = {executor.submit(work, pieces[i]): i for i in left}
            try:
                for future in as_completed(waiting):
                    results[waiting[future]] = future.result()
                    done(len(results), len(pieces))
            except BaseException:
                for future in waiting:
                    future.cancel()
                raise
        if len(results) == len(pieces):
            return [results[i] for i in range(len(pieces))]
    raise MissingToolError(
        f"{_ATTEMPTS} times a worker process was killed or could not start",
        hint="too little memory? --workers 1 takes the least",
    )
