"""Runs emitted code through a program that answers requests in files: for any compiled language.

The program is called with two file names. The first holds doubles in the machine's byte order: a head
of five (mode, N, has free values, has seeds, limits), then N items. The answers go to the second:

| mode | item | answer |
|---|---|---|
| 0 | none | joints, free joints, most solutions; then, if it likes, the constants below |
| 1 solve | pose (16, columns first), free values, seed | status, count, then all rows |
| 2 forward | joints | pose (16, columns first) |
| 3 jacobian | joints | 6 by joints, columns first |
| 4 solve_batch | pose | as for solve |
| 5 follow | pose of the path, where it starts (joints) | status, how many were reached, then all rows |
| 6 search | pose, seed | as for solve |
| 7 self_motion | pose | count, then the ends of as many intervals |

Status: 0 OK, 1 UNREACHABLE, 2 LIMITS, 3 INVALID, and of a path alone 4 SINGULAR. There are as many rows as
solutions at most, each the joints and whether it is singular, and of a path one for each pose; those beyond
the count are zeros.

Constants are the defaults of the free joints; then, if it likes, the lower limits and the upper ones of all
joints, and as texts the base link, the tip link and the names of the joints. A text is its length in bytes
and the bytes of its UTF-8. What is told is checked.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ikgen.errors import BadDescriptionError, VerificationError
from ikgen.processes.outside_program import run_program
from ikgen.verify.runners.runner import ArmConstants, Rows

__all__ = [
    "BATCH",
    "FOLLOW",
    "FORWARD",
    "INFO",
    "JACOBIAN",
    "SEARCH",
    "SELF_MOTION",
    "SOLVE",
    "ProgramRunner",
]

INFO, SOLVE, FORWARD, JACOBIAN, BATCH, FOLLOW, SEARCH, SELF_MOTION = range(8)
"""What the first number of a request asks for."""

Array = NDArray[np.float64]

_STATUS = ("OK", "UNREACHABLE", "LIMITS", "INVALID", "SINGULAR")


class ProgramRunner:
    """A `Runner` (and `MovingRunner`) over a program; its folder takes the requests and answers.

    `constants` are those of the arm; the number of solutions is asked of the program. `batch` says
    whether it knows mode 4, `motions` whether 5 and 6, `intervals` whether 7. Raises
    `BadDescriptionError` where the program has other joints: with `made`, which waits for a program that
    is being made, and is called before each use, when it is used first.
    """

    dynamic_shapes = False

    def __init__(
        self,
        label: str,
        program: Path,
        constants: ArmConstants,
        *,
        batch: bool,
        source: str,
        made: Callable[[], None] | None = None,
        motions: bool = False,
        intervals: bool = False,
    ) -> None:
        self.label = label
        self.moves, self.has_self_motion = motions, intervals
        self._program = program
        self._has_batch = batch
        self._given, self._source, self._made = constants, source, made
        self._told = None if made else self._ask()

    @property
    def constants(self) -> ArmConstants:
        """The arm's constants, with the program's number of solutions."""
        if self._told is None:
            self._told = self._ask()
        return self._told

    def _ask(self) -> ArmConstants:
        """The constants with what the program tells."""
        constants, told = self._given, self._run(INFO, 0, [])
        dof, free, most = (int(x) for x in told[:3])
        if (dof, free) != (constants.dof, len(constants.free_joints)):
            raise BadDescriptionError(
                f"has {dof} joints, {free} of them free, instead of {constants.dof} and "
                f"{len(constants.free_joints)}",
                file=self._source,
                hint="generate it anew: it is another arm's, or held joints have changed",
            )
        return _told(dataclasses.replace(constants, max_solutions=most), told[3:])

    def _run(self, mode: int, n: int, columns: list[Array], flags: tuple[bool, ...] = ()) -> Array:
        """One process: N items made of the columns (N, k), and what it answered."""
        if self._made is not None:
            self._made()
        head = np.array([mode, n, *flags, *[0] * (3 - len(flags))], dtype=float)
        body = np.hstack(columns).ravel() if columns else np.empty(0)
        work = self._program.parent
        request, answer = work / "request", work / "answer"
        request.write_bytes(np.concatenate([head, body]).tobytes())
        done = run_program([str(self._program), str(request), str(answer)])
        if done.late or done.code:
            said = f": {done.printed[:500]}" if done.printed.strip() else ""
            raise VerificationError(
                f"the emitted {self.label} code's driver {done.words}{said}",
                hint="generate it anew; where it takes too long, give more IKGEN_TOOL_SECONDS",
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
        dof, most = self.constants.dof, self.constants.max_solutions
        out = answer.reshape(n, 2 + most * (dof + 1))
        table = out[:, 2:].reshape(n, most, dof + 1)
        count = np.clip(out[:, 1].astype(np.int64), 0, most)
        q = np.where((np.arange(most) < count[:, None])[:, :, None], table[:, :, :dof], np.nan)
        status = tuple(_name(s) for s in out[:, 0].tolist())
        return Rows(q, count, status, table[:, :, dof] != 0)

    def solve_batch(
        self, poses: Array, limits: bool = True, free: Array | None = None
    ) -> Rows | None:
        """The language's `solve_batch`; None where it has none, or for free values, which requests lack."""
        if not self._has_batch or free is not None:
            return None
        n = len(poses)
        return self._rows(self._run(BATCH, n, [_by_columns(poses)], (False, False, limits)), n)

    def forward(self, q: Array) -> Array:
        """Poses (N, 4, 4) for q (N, dof)."""
        return np.asarray(self._run(FORWARD, len(q), [q]).reshape(-1, 4, 4).transpose(0, 2, 1))

    def jacobian(self, q: Array) -> Array:
        """Jacobians (N, 6, dof) for q (N, dof)."""
        dof = self.constants.dof
        return np.asarray(self._run(JACOBIAN, len(q), [q]).reshape(-1, dof, 6).transpose(0, 2, 1))

    def follow(self, poses: Array, start: Array) -> tuple[Array, str, NDArray[np.bool_]]:
        """Rows (N, dof) along poses (N, 4, 4), NaN from the first that was not reached, the status, and
        which are singular (N,)."""
        n, dof = len(poses), self.constants.dof
        starts = np.broadcast_to(np.asarray(start, dtype=float), (n, dof))
        status, reached, *rows = self._run(FOLLOW, n, [_by_columns(poses), starts]).tolist()
        table = np.array(rows).reshape(n, dof + 1)
        q = np.where(np.arange(n)[:, None] < reached, table[:, :dof], np.nan)
        return q, _name(status), table[:, dof] != 0

    def search(self, pose: Array, seed: Array) -> Array:
        """The best rows (k, dof) near a seed (dof,)."""
        columns = [_by_columns(np.asarray(pose)[None]), np.asarray(seed, dtype=float)[None]]
        return next(iter(self._rows(self._run(SEARCH, 1, columns), 1)))

    def self_motion(self, pose: Array) -> Array:
        """Ends (k, 2) of the intervals of what is held."""
        told = self._run(SELF_MOTION, 1, [_by_columns(np.asarray(pose)[None])])
        return told[1:].reshape(-1, 2)


def _name(status: float) -> str:
    return _STATUS[int(status)] if 0 <= status < len(_STATUS) else "UNKNOWN"


def _told(constants: ArmConstants, told: Array) -> ArmConstants:
    """The constants with what the program tells of them."""
    dof, free = constants.dof, len(constants.free_joints)
    if not len(told):
        return constants
    constants = dataclasses.replace(constants, free_defaults=tuple(told[:free].tolist()))
    if len(told) == free:
        return constants
    lower, upper, letters = np.split(told[free:], [dof, 2 * dof])
    base, tip, *joints = _texts(letters)
    return dataclasses.replace(
        constants,
        lower=lower,
        upper=upper,
        base_link=base,
        tip_link=tip,
        joint_names=tuple(joints),
    )


def _texts(told: Array) -> list[str]:
    """The texts of a line of numbers, each its length in bytes and the bytes."""
    texts, at = [], 0
    while at < len(told):
        end = at + 1 + int(told[at])
        texts.append(bytes(told[at + 1 : end].astype(np.uint8)).decode("utf-8", "replace"))
        at = end
    return texts


def _by_columns(poses: Array) -> Array:
    """Poses (N, 4, 4) as Eigen stores them: (N, 16)."""
    return np.asarray(poses.transpose(0, 2, 1).reshape(len(poses), 16))
