"""Stacks of poses for an emitted Python module, solved by several processes where that takes long."""

from __future__ import annotations

import os
import pickle
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, suppress
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ikgen.errors import MissingToolError
from ikgen.model.arrays import Array
from ikgen.processes.executors import spare_cores
from ikgen.processes.outside_program import RunningProgram
from ikgen.processes.scratch_folder import ScratchFolder
from ikgen.verify.runners.runner import Stack

__all__ = ["Answer", "Solve", "help_out", "solve_with_helpers"]


Answer = tuple[Array, str, NDArray[np.bool_]]
"""Rows (k, dof), status and singular flags (k,) of a pose."""

Solve = Callable[[Stack], list[Answer]]
"""Answers to the poses of a stack."""

_PART = 1024
"""Poses solved together: how many they are changes last digits, so the number of cores has no say in it."""

_MANY = 1000
"""With fewer poses than this, no helper is considered."""

_TRIED = 64
"""One pose in this many is timed to estimate the whole."""

_WORTH = 1.5
"""Seconds of work for which other processes are started: each takes some 0.4 s to load the module."""

_WORK = "work"
"""The file of the parts."""

_PROGRAM = "ikgen.verify.runners.module_program"


def solve_with_helpers(module: Path, stacks: Sequence[Stack], solve: Solve) -> list[list[Answer]]:
    """What `solve` answers to each stack; where that takes long other processes, which load the `module`,
    take parts of the work. The answers are the same, whoever gives them."""
    parts = [_parts(stack) for stack in stacks]
    found = iter(_solved(module, [part for some in parts for part in some], solve))
    return [_joined(list(islice(found, len(some)))) for some in parts]


def _parts(stack: Stack) -> list[Stack]:
    """Every n-th pose each, so that what is hard is dealt out."""
    n = max(1, -(-len(stack.poses) // _PART))
    return [stack.at(slice(k, None, n)) for k in range(n)]


def _joined(answers: Sequence[list[Answer]]) -> list[Answer]:
    """The answers to all parts in the order of the poses."""
    n = len(answers)
    return [answers[k % n][k // n] for k in range(sum(map(len, answers)))]


def _solved(module: Path, parts: Sequence[Stack], solve: Solve) -> list[list[Answer]]:
    """The answers to each part. What a helper left, which may be ended or not even start, is done here."""
    found: dict[int, list[Answer]] = {}
    count = min(spare_cores(), len(parts) - 1)
    if count > 0 and _seconds(parts, solve) > _WORTH:
        found = _shared(module, parts, solve, count)
    return [found[k] if k in found else solve(part) for k, part in enumerate(parts)]


def _shared(
    module: Path, parts: Sequence[Stack], solve: Solve, count: int
) -> dict[int, list[Answer]]:
    """Number of a part -> what this process answered to it, or one of so many helpers."""
    with ScratchFolder("ikgen-") as folder, ExitStack() as ends:
        (folder / _WORK).write_bytes(pickle.dumps([tuple(part) for part in parts]))
        helpers: dict[str, RunningProgram] = {}
        with suppress(MissingToolError):
            for name in map(str, range(count)):
                places = str(module.resolve()), str(folder.resolve()), name
                command = [sys.executable, "-m", _PROGRAM, *places]
                # Python looks for modules where it is started: not where the user is.
                helpers[name] = RunningProgram(command, cwd=folder)
                ends.callback(helpers[name].end)
        found = {k: solve(parts[k]) for k in _taken(folder, len(parts))}
        for name, helper in helpers.items():
            if helper.finished().code == 0:
                found |= pickle.loads((folder / name).read_bytes())
    return found


def _seconds(parts: Sequence[Stack], solve: Solve) -> float:
    """What all poses may take, as some of each part do."""
    if sum(len(part.poses) for part in parts) < _MANY:
        return 0.0
    start = time.perf_counter()
    for part in parts:
        solve(part.at(slice(None, None, _TRIED)))
    return (time.perf_counter() - start) * _TRIED


def help_out(folder: Path, name: str, solve: Solve) -> None:
    """Solve parts of the work in the folder that nobody else has taken; the answers go to a file of a
    `name` there."""
    parts = [Stack(*fields) for fields in pickle.loads((folder / _WORK).read_bytes())]
    found = {k: solve(parts[k]) for k in _taken(folder, len(parts))}
    (folder / name).write_bytes(pickle.dumps(found))


def _taken(folder: Path, count: int) -> Iterator[int]:
    """Numbers of parts, each for the first process that asks."""
    for k in range(count):
        with suppress(FileExistsError):
            os.close(os.open(folder / f"taken-{k}", os.O_CREAT | os.O_EXCL))
            yield k
