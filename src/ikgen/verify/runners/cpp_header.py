"""Runs an emitted C++ header through a small driver program, thousands of poses per process."""

from __future__ import annotations

import dataclasses
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ikgen.errors import BadDescriptionError, VerificationError
from ikgen.verify.runners.cpp_driver import BATCH, FORWARD, INFO, JACOBIAN, SOLVE, driver
from ikgen.verify.runners.cpp_toolchain import compile_program
from ikgen.verify.runners.runner import ArmConstants, Rows

__all__ = ["CppHeader"]

Array = NDArray[np.float64]

_STATUS = ("OK", "UNREACHABLE", "LIMITS", "INVALID")


class CppHeader:
    """A `Runner` over an emitted `<name>_ik.hpp`, compiled at construction into a temporary folder.

    `constants` are those of the arm (the header has no names or limits); its number of solutions is
    read from the header. Raises `BadDescriptionError` for a missing file or other joint counts,
    `MissingToolError` without compiler or Eigen, `VerificationError` if it does not compile.
    """

    label = "cpp"
    dynamic_shapes = False

    def __init__(self, path: Path | str, constants: ArmConstants) -> None:
        self.path = Path(path).resolve()
        if not self.path.is_file():
            raise BadDescriptionError("no such C++ header", file=str(path))
        self._directory = tempfile.TemporaryDirectory(prefix="ikgen-verify-")
        work = Path(self._directory.name)
        source, self._program = work / "driver.cpp", work / "driver"
        self._has_batch = "solve_batch(" in self.path.read_text(encoding="utf-8")
        text = driver(self.path.name, self.path.stem, batch=self._has_batch)
        source.write_text(text, encoding="utf-8")
        compile_program(source, self._program, [self.path.parent])
        dof, free, most = (int(x) for x in self._run(INFO, 0, []))
        if (dof, free) != (constants.dof, len(constants.free_joints)):
            raise BadDescriptionError(
                f"has {dof} joints, {free} of them free, instead of {constants.dof} and "
                f"{len(constants.free_joints)}", file=str(path),
            )  # fmt: skip
        self._constants = dataclasses.replace(constants, max_solutions=most)

    @property
    def constants(self) -> ArmConstants:
        """The arm's constants, with the header's number of solutions."""
        return self._constants

    def _run(self, mode: int, n: int, columns: list[Array], flags: tuple[bool, ...] = ()) -> Array:
        """One process: N items made of the columns (N, k), and what it answered."""
        head = np.array([mode, n, *flags, *[0] * (3 - len(flags))], dtype=float)
        body = np.hstack(columns).ravel() if columns else np.empty(0)
        work = Path(self._directory.name)
        request, answer = work / "request", work / "answer"
        request.write_bytes(np.concatenate([head, body]).tobytes())
        command = [str(self._program), str(request), str(answer)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise VerificationError(
                f"the emitted header's driver ended with {done.returncode}: {done.stderr[:500]}"
            )
        return np.fromfile(answer)

    def solve(
        self,
        pose: Array,
        free: Array | None = None,
        seed: Array | None = None,
        limits: bool = True,
    ) -> tuple[Array, str, NDArray[np.bool_]]:
        """Rows (k, dof), status and singular flags (k,) for one pose (4, 4)."""
        frees = None if free is None else np.asarray(free, dtype=float)[None]
        seeds = None if seed is None else np.asarray(seed, dtype=float)[None]
        rows = self.solve_many(np.asarray(pose)[None], free=frees, seeds=seeds, limits=limits)
        k = rows.count[0]
        return rows.q[0, :k], rows.status[0], rows.singular[0, :k]

    def solve_many(
        self,
        poses: Array,
        *,
        free: Array | None = None,
        seeds: Array | None = None,
        limits: bool = True,
    ) -> Rows:
        """`solve` for each of the poses (N, 4, 4) with free values (N, f) and seeds (N, dof)."""
        n = len(poses)
        columns = [_by_columns(poses)]
        columns += [extra for extra in (free, seeds) if extra is not None]
        flags = (free is not None, seeds is not None, limits)
        return self._rows(self._run(SOLVE, n, columns, flags), n)

    def _rows(self, answer: Array, n: int) -> Rows:
        dof, most = self._constants.dof, self._constants.max_solutions
        out = answer.reshape(n, 2 + most * (dof + 1))
        table = out[:, 2:].reshape(n, most, dof + 1)
        count = np.clip(out[:, 1].astype(np.int64), 0, most)
        q = np.where((np.arange(most) < count[:, None])[:, :, None], table[:, :, :dof], np.nan)
        status = tuple(_STATUS[int(s)] if s >= 0 else "UNKNOWN" for s in out[:, 0])
        return Rows(q, count, status, table[:, :, dof] != 0)

    def solve_batch(self, poses: Array, limits: bool = True) -> Rows | None:
        """The header's `solve_batch`; None where it has none."""
        if not self._has_batch:
            return None
        n = len(poses)
        return self._rows(self._run(BATCH, n, [_by_columns(poses)], (False, False, limits)), n)

    def forward(self, q: Array) -> Array:
        """Poses (N, 4, 4) for q (N, dof)."""
        return np.asarray(self._run(FORWARD, len(q), [q]).reshape(-1, 4, 4).transpose(0, 2, 1))

    def jacobian(self, q: Array) -> Array:
        """Jacobians (N, 6, dof) for q (N, dof)."""
        dof = self._constants.dof
        return np.asarray(self._run(JACOBIAN, len(q), [q]).reshape(-1, dof, 6).transpose(0, 2, 1))


def _by_columns(poses: Array) -> Array:
    """Poses (N, 4, 4) as Eigen stores them: (N, 16)."""
    return np.asarray(poses.transpose(0, 2, 1).reshape(len(poses), 16))
