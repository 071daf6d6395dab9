"""What the checks need of emitted code, whatever its language."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from ikgen.model.arrays import Array
from ikgen.tasks import POSE

__all__ = ["ArmConstants", "MovingRunner", "Rows", "Runner", "Stack", "StackRunner", "solve_stacks"]


@dataclass(frozen=True, slots=True)
class ArmConstants:
    """The constants of an emitted module (`docs`: JOINT_NAMES, LOWER, ...); limits in rad or m.
    `free_defaults` are the values that free joints take where none are given; None where the code
    does not tell."""

    joint_names: tuple[str, ...]
    lower: Array
    upper: Array
    base_link: str
    tip_link: str
    max_solutions: int
    task: str = POSE.name
    free_joints: tuple[str, ...] = ()
    free_defaults: tuple[float, ...] | None = None

    @property
    def dof(self) -> int:
        """Number of actuated joints."""
        return len(self.joint_names)


@dataclass(frozen=True, slots=True)
class Rows:
    """Answers for N poses. `q` (N, M, dof) in rad or m, NaN beyond `count` (N,); `status`: N names
    (OK, UNREACHABLE, LIMITS, INVALID); `singular` (N, M)."""

    q: Array
    count: NDArray[np.int64]
    status: tuple[str, ...]
    singular: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.count)

    def __iter__(self) -> Iterator[Array]:
        return (rows[:count] for rows, count in zip(self.q, self.count, strict=True))

    @property
    def mask(self) -> NDArray[np.bool_]:
        """(N, M): which entries are rows."""
        return np.asarray(np.arange(self.q.shape[1]) < self.count[:, None])

    def flat(self) -> tuple[NDArray[np.int64], Array, NDArray[np.bool_]]:
        """All rows in a line: index of the pose (K,), q (K, dof), singular (K,)."""
        mask = self.mask
        return np.nonzero(mask)[0], self.q[mask], self.singular[mask]

    def at(self, index: NDArray[np.int64]) -> Rows:
        """The rows of the poses `index` (k,)."""
        status = tuple(self.status[k] for k in index.tolist())
        return Rows(self.q[index], self.count[index], status, self.singular[index])

    def with_answers(self, index: NDArray[np.int64], other: Rows) -> Rows:
        """These with those of the poses `index` (k,) replaced by the `other` ones."""
        width = max(self.q.shape[1], other.q.shape[1])
        q = np.full((len(self), width, self.q.shape[2]), np.nan)
        singular = np.zeros((len(self), width), dtype=bool)
        q[:, : self.q.shape[1]], singular[:, : self.q.shape[1]] = self.q, self.singular
        q[index], singular[index] = np.nan, False
        q[index, : other.q.shape[1]] = other.q
        singular[index, : other.q.shape[1]] = other.singular
        count, status = self.count.copy(), list(self.status)
        count[index] = other.count
        for k, name in zip(index.tolist(), other.status, strict=True):
            status[k] = name
        return Rows(q, count, tuple(status), singular)


class Stack(NamedTuple):
    """`poses` (N, 4, 4) with values `free` (N, f) of held joints and `seeds` (N, dof), if there are any."""

    poses: Array
    free: Array | None = None
    seeds: Array | None = None
    limits: bool = True

    def at(self, which: slice | NDArray[np.bool_] | NDArray[np.int64]) -> Stack:
        """Some of the poses."""
        free, seeds = (None if x is None else x[which] for x in (self.free, self.seeds))
        return Stack(self.poses[which], free, seeds, self.limits)

    def each(self) -> Iterator[tuple[Array, Array | None, Array | None, bool]]:
        """Pose, held values, seed and limits of one after the other."""
        for i, pose in enumerate(self.poses):
            free, seed = (None if x is None else x[i] for x in (self.free, self.seeds))
            yield pose, free, seed, self.limits


class Runner(Protocol):
    """Emitted code that can be run. `label` is its language; `dynamic_shapes` says whether a
    wrongly shaped pose can be handed over at all (and must raise `ValueError`)."""

    label: str
    dynamic_shapes: bool

    @property
    def constants(self) -> ArmConstants:
        """The module's constants."""

    def solve(
        self,
        pose: Array,
        free: Array | None = None,
        seed: Array | None = None,
        limits: bool = True,
    ) -> tuple[Array, str, NDArray[np.bool_]]:
        """Rows (k, dof), status and singular flags (k,) for one pose (4, 4)."""

    def solve_many(
        self,
        poses: Array,
        *,
        free: Array | None = None,
        seeds: Array | None = None,
        limits: bool = True,
    ) -> Rows:
        """`solve` for each of the poses (N, 4, 4) with free values (N, f) and seeds (N, dof)."""

    def solve_batch(
        self, poses: Array, limits: bool = True, free: Array | None = None
    ) -> Rows | None:
        """The module's own batch function for poses (N, 4, 4) with free values (N, f), flags all false;
        None where the language has none that takes these."""

    def forward(self, q: Array) -> Array:
        """Poses (N, 4, 4) for q (N, dof)."""

    def jacobian(self, q: Array) -> Array:
        """Jacobians (N, 6, dof) for q (N, dof)."""


@runtime_checkable
class StackRunner(Protocol):
    """A runner that solves several stacks faster than one after the other."""

    def solve_stacks(self, stacks: Sequence[Stack]) -> list[Rows]:
        """`Runner.solve_many` of each."""
        ...


def solve_stacks(runner: Runner, stacks: Sequence[Stack]) -> list[Rows]:
    """`solve_many` of each stack."""
    if isinstance(runner, StackRunner):
        return runner.solve_stacks(stacks)
    return [
        runner.solve_many(one.poses, free=one.free, seeds=one.seeds, limits=one.limits)
        for one in stacks
    ]


@runtime_checkable
class MovingRunner(Protocol):
    """A runner of code that follows paths and chooses what it holds; `moves`: whether its code does."""

    @property
    def moves(self) -> bool: ...

    @property
    def has_self_motion(self) -> bool:
        """Whether the code tells the intervals of what is held."""
        ...

    def follow(self, poses: Array, start: Array) -> tuple[Array, str, NDArray[np.bool_]]:
        """Rows (N, dof) along poses (N, 4, 4), NaN from the first that was not reached, the status, and
        which are singular (N,)."""
        ...

    def search(self, pose: Array, seed: Array) -> Array:
        """The best rows (k, dof) near a seed (dof,)."""
        ...

    def self_motion(self, pose: Array) -> Array:
        """Ends (k, 2), rad or m, of the intervals of what is held."""
        ...
