"""Stacks of poses in parts, solved by other processes too: with the same answers, whoever gives them."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from tests.support.fake_arms import six_axis_module

from ikgen.processes.executors import spare_cores
from ikgen.verify.runners import module_helpers
from ikgen.verify.runners.module_helpers import solve_with_helpers
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.runners.runner import Stack

COUNT = 20


def stacks(module: PythonModule) -> list[Stack]:
    rng = np.random.default_rng(4)
    q = rng.uniform(-1.5, 1.5, (COUNT, 6))
    poses = module.forward(q)
    return [Stack(poses), Stack(poses[:7], seeds=q[:7], limits=False), Stack(poses[:0])]


def small(monkeypatch: pytest.MonkeyPatch, cores: int = 1) -> None:
    """Parts of four poses, worth a helper however fast they are solved."""
    for name, value in (("_PART", 4), ("_MANY", 1), ("_WORTH", 0.0)):
        monkeypatch.setattr(module_helpers, name, value)
    monkeypatch.setattr(module_helpers, "spare_cores", lambda: cores)


def solved(module: PythonModule, own: list[int]) -> list[bytes]:
    """The answers, as bytes; how many poses each call of this process had goes to `own`."""

    def solve(stack: Stack) -> list[module_helpers.Answer]:
        own.append(len(stack.poses))
        return module.answers(stack)

    found = solve_with_helpers(module.path, stacks(module), solve)
    assert [len(answers) for answers in found] == [COUNT, 7, 0]
    return [
        q.tobytes() + flags.tobytes() + status.encode() for one in found for q, status, flags in one
    ]


def only_first(folder: Path, count: int) -> Iterator[int]:
    """This process takes part 0, and leaves the others."""
    os.close(os.open(folder / "taken-0", os.O_CREAT | os.O_EXCL))
    yield 0


def test_helpers_answer_as_the_process_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    module, alone, own = six_axis_module(tmp_path), [], []
    monkeypatch.chdir(tmp_path)
    (tmp_path / "numpy.py").write_text("raise SystemExit(3)")  # none of Python's business
    small(monkeypatch, cores=0)
    without = solved(module, alone)
    assert alone == [4] * 5 + [4, 3, 0]
    small(monkeypatch)
    monkeypatch.setattr(module_helpers, "_taken", only_first)
    assert solved(module, own) == without
    assert own == [1] * 7 + [0] + [4]  # what it may take, then the one part


@pytest.mark.parametrize("broken", ["no program", "no interpreter"])
def test_what_helpers_leave_is_done_here(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, broken: str
) -> None:
    module, own = six_axis_module(tmp_path), []
    small(monkeypatch, cores=0)
    without = solved(module, [])
    small(monkeypatch, cores=3)
    monkeypatch.setattr(module_helpers, "_taken", only_first)
    if broken == "no program":
        monkeypatch.setattr(module_helpers, "_PROGRAM", "ikgen.no_such_program")
    else:
        monkeypatch.setattr(sys, "executable", str(tmp_path / "nothing"))
    assert solved(module, own) == without
    assert own[8:] == [4] * 6 + [3, 0]


def test_few_poses_and_fast_ones_need_no_helper(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    module = six_axis_module(tmp_path)
    small(monkeypatch)
    monkeypatch.setattr(module_helpers, "_shared", None)
    for name, value in (("_MANY", 28), ("_WORTH", 1e3)):
        small(monkeypatch)
        monkeypatch.setattr(module_helpers, name, value)
        own: list[int] = []
        solved(module, own)
        assert own[-8:] == [4] * 5 + [4, 3, 0] and len(own) == (8 if name == "_MANY" else 16)


def test_a_process_of_a_pool_has_no_cores_to_spare(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1, 2}, raising=False)
    assert spare_cores() == 2
    monkeypatch.setattr("multiprocessing.parent_process", lambda: object())
    assert spare_cores() == 0
