"""Runs an emitted Python module, loaded from its file."""

from __future__ import annotations

import contextlib
import importlib.util
import itertools
import sys
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ikgen.errors import BadDescriptionError
from ikgen.model.arrays import Array
from ikgen.tasks import find_task
from ikgen.verify.runners.module_helpers import Answer, solve_with_helpers
from ikgen.verify.runners.runner import ArmConstants, Rows, Stack

__all__ = ["PythonModule"]


_ALONE = 32  # one pose of so many is solved by itself

_NAMES = (
    "JOINT_NAMES", "LOWER", "UPPER", "BASE_LINK", "TIP_LINK", "DOF", "MAX_SOLUTIONS", "TASK",
    "FREE_JOINTS", "SOURCE_SHA256", "GENERATOR_VERSION", "Status", "Solutions", "forward",
    "jacobian", "solve", "solve_batch",
)  # fmt: skip
_serial = itertools.count()


def _load(path: Path) -> ModuleType:
    """Execute the file as a module of a name of its own; errors name the file."""
    name = f"_ikgen_verified_{next(_serial)}_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None or not path.is_file():
        hint = "check the path, or generate it with --emit python"
        raise BadDescriptionError("no such Python module", file=str(path), hint=hint)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look their module up here
    writes, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        with contextlib.redirect_stdout(sys.stderr):  # stdout may be for JSON
            spec.loader.exec_module(module)
    except Exception as error:
        what = f"{type(error).__name__}: {error}"
        hint = "generate it anew, with ikgen of this version"
        raise BadDescriptionError(
            f"cannot be imported: {what}", file=str(path), hint=hint
        ) from error
    finally:
        sys.dont_write_bytecode = writes
        sys.modules.pop(name, None)
    return module


def _task_name(module: ModuleType) -> str:
    """The task with the tool's axis, where that is not the task's first."""
    task, axis = str(module.TASK), getattr(module, "TOOL_AXIS", None)
    return task if axis is None else find_task(task, axis).name


class PythonModule:
    """A `Runner` over an emitted `<name>_ik.py`.

    Raises `BadDescriptionError` where the file cannot be imported or lacks a name of the contract.
    """

    label = "python"
    dynamic_shapes = True

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self.module = _load(self.path)
        missing = [name for name in _NAMES if not hasattr(self.module, name)]
        if missing:
            raise BadDescriptionError(
                f"not an emitted module: lacks {', '.join(missing)}",
                file=str(path),
                hint="generate it again with ikgen from-urdf or ikgen build",
            )
        m = self.module
        self._constants = ArmConstants(
            tuple(m.JOINT_NAMES), np.asarray(m.LOWER, float), np.asarray(m.UPPER, float),
            m.BASE_LINK, m.TIP_LINK, int(m.MAX_SOLUTIONS), _task_name(m), tuple(m.FREE_JOINTS),
            getattr(m, "_FREE_DEFAULTS", None),
        )  # fmt: skip

    @property
    def constants(self) -> ArmConstants:
        """The module's constants."""
        return self._constants

    def solve(
        self,
        pose: Array,
        free: Array | None = None,
        seed: Array | None = None,
        limits: bool = True,
    ) -> Answer:
        """Rows (k, dof), status and singular flags (k,) for one pose (4, 4)."""
        return self._answer(self.module.solve(pose, free=free, seed=seed, limits=limits))

    def branch_names(self, q: Array) -> tuple[str, ...]:
        """What tells rows (k, dof) of one pose apart, as the module's `Solutions.branch` does."""
        names: tuple[str, ...] = self.module._branch_names(self.module._ARM, q)
        return names

    def solve_many(
        self,
        poses: Array,
        *,
        free: Array | None = None,
        seeds: Array | None = None,
        limits: bool = True,
    ) -> Rows:
        """`solve` for each of the poses (N, 4, 4) with free values (N, f) and seeds (N, dof)."""
        return self.solve_stacks([Stack(poses, free, seeds, limits)])[0]

    def solve_stacks(self, stacks: Sequence[Stack]) -> list[Rows]:
        """`solve` for each pose: of 32 one by itself, of the others those that leave doubts in stacks; with
        other processes where that takes long."""
        answers = solve_with_helpers(self.path, stacks, self.answers)
        return [self._rows(one) for one in answers]

    def answers(self, stack: Stack) -> list[Answer]:
        """The answers to the poses of one stack, in this process."""
        each = np.arange(len(stack.poses))
        stacks = hasattr(self.module, "_solve_each") and not hasattr(self.module, "_MOTORS")
        alone = each % _ALONE == 0 if stacks else each >= 0
        stacked = iter(() if alone.all() else self._stacked(stack.at(~alone)))
        return [
            self.solve(*one) if alone[i] else next(stacked) for i, one in enumerate(stack.each())
        ]

    def _stacked(self, stack: Stack) -> list[Answer]:
        found = self.module._solve_each(self.module._ARM, *stack)
        return [self._answer(one) for one in found]

    def _answer(self, found: Any) -> Answer:
        """The answer that a `Solutions` is."""
        q = np.asarray(found.q, dtype=float).reshape(-1, self._constants.dof)
        return q, found.status.name, np.asarray(found.singular, dtype=bool).reshape(len(q))

    def _rows(self, answers: list[Answer]) -> Rows:
        width = max([self._constants.max_solutions, *(len(q) for q, _, _ in answers)])
        q = np.full((len(answers), width, self._constants.dof), np.nan)
        singular = np.zeros((len(answers), width), dtype=bool)
        for i, (rows, _, flags) in enumerate(answers):
            q[i, : len(rows)], singular[i, : len(rows)] = rows, flags
        count = np.array([len(rows) for rows, _, _ in answers], dtype=np.int64)
        return Rows(q, count, tuple(status for _, status, _ in answers), singular)

    def solve_batch(
        self, poses: Array, limits: bool = True, free: Array | None = None
    ) -> Rows | None:
        """The module's `solve_batch`, by default with its values for free joints; flags are all false."""
        q, count, status = self.module.solve_batch(poses, free=free, limits=limits)
        q = np.asarray(q, dtype=float)
        names = tuple(getattr(s, "name", None) or self.module.Status(s).name for s in status)
        return Rows(q, np.asarray(count, dtype=np.int64), names, np.zeros(q.shape[:2], dtype=bool))

    @property
    def moves(self) -> bool:
        """Whether the module follows paths and searches."""
        return hasattr(self.module, "follow") and hasattr(self.module, "search")

    @property
    def has_self_motion(self) -> bool:
        """Whether it tells the intervals of what is held."""
        return hasattr(self.module, "self_motion")

    def follow(self, poses: Array, start: Array) -> tuple[Array, str, NDArray[np.bool_]]:
        """Rows (N, dof) along poses (N, 4, 4), NaN from the first that was not reached, the status, and
        which are singular (N,)."""
        path = self.module.follow(poses, start=start)
        return (
            np.asarray(path.q, dtype=float),
            path.status.name,
            np.asarray(path.singular, dtype=bool),
        )

    def search(self, pose: Array, seed: Array) -> Array:
        """The best rows (k, dof) near a seed."""
        found = self.module.search(pose, seed=seed, prefer="near")
        return np.asarray(found.q, dtype=float).reshape(-1, self._constants.dof)

    def self_motion(self, pose: Array) -> Array:
        """Ends (k, 2) of the intervals of what is held."""
        found = self.module.self_motion(pose)
        return np.array([[one.low, one.high] for one in found], dtype=float).reshape(-1, 2)

    def forward(self, q: Array) -> Array:
        """Poses (N, 4, 4) for q (N, dof)."""
        return np.asarray(self.module.forward(q), dtype=float)

    def jacobian(self, q: Array) -> Array:
        """Jacobians (N, 6, dof) for q (N, dof), one call each."""
        return np.array([self.module.jacobian(row) for row in q], dtype=float)
