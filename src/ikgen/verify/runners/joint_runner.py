"""Runs emitted code that takes and gives values of motors as if they were those of the joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ikgen.model.arrays import Array
from ikgen.model.transmission import Transmission
from ikgen.verify.runners.cpp_header import CppHeader
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.runners.runner import ArmConstants, Rows, Stack, solve_stacks

__all__ = ["JointRunner"]


class JointRunner:
    """A `Runner` (and `MovingRunner`) over another one whose values are those of motors: the `transmission`
    is what was asked for, not what the code says, so that checks against the joints check it too."""

    def __init__(self, runner: PythonModule | CppHeader, transmission: Transmission) -> None:
        self._runner, self._transmission = runner, transmission
        self.label, self.dynamic_shapes = runner.label, runner.dynamic_shapes

    @property
    def constants(self) -> ArmConstants:
        """The code's constants."""
        return self._runner.constants

    def close(self) -> None:
        """Close what it runs, if that can be closed."""
        if isinstance(self._runner, CppHeader):
            self._runner.close()

    def _motors(self, joints: Array) -> Array:
        """Motor values of joint values; rows of another length as they are: the code has to refuse them."""
        if joints.shape[-1:] != self._transmission.offset.shape:
            return joints
        return self._transmission.motors(joints)

    def solve(
        self,
        pose: Array,
        free: Array | None = None,
        seed: Array | None = None,
        limits: bool = True,
    ) -> tuple[Array, str, NDArray[np.bool_]]:
        """Rows (k, dof), status and singular flags (k,) for one pose (4, 4)."""
        near = None if seed is None else self._motors(seed)
        q, status, singular = self._runner.solve(pose, free, near, limits)
        return self._transmission.joints(q), status, singular

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
        """`solve_many` of each."""
        asked = [
            one if one.seeds is None else one._replace(seeds=self._motors(one.seeds))
            for one in stacks
        ]
        found = solve_stacks(self._runner, asked)
        return [replace(rows, q=self._transmission.joints(rows.q)) for rows in found]

    def solve_batch(
        self, poses: Array, limits: bool = True, free: Array | None = None
    ) -> Rows | None:
        """The code's own batch function."""
        rows = self._runner.solve_batch(poses, limits, free)
        return None if rows is None else replace(rows, q=self._transmission.joints(rows.q))

    def forward(self, q: Array) -> Array:
        """Poses (N, 4, 4) for q (N, dof)."""
        return self._runner.forward(self._motors(q))

    def jacobian(self, q: Array) -> Array:
        """Jacobians (N, 6, dof) for q (N, dof)."""
        return self._runner.jacobian(self._motors(q)) @ self._transmission.inverse

    @property
    def moves(self) -> bool:
        """Whether the code follows paths and searches."""
        return self._runner.moves

    @property
    def has_self_motion(self) -> bool:
        """Whether it tells the intervals of what is held."""
        return self._runner.has_self_motion

    def follow(self, poses: Array, start: Array) -> tuple[Array, str, NDArray[np.bool_]]:
        """Rows (N, dof) along poses (N, 4, 4), NaN from the first that was not reached, the status, and
        which are singular (N,)."""
        q, status, singular = self._runner.follow(poses, self._motors(start))
        return self._transmission.joints(q), status, singular

    def search(self, pose: Array, seed: Array) -> Array:
        """The best rows (k, dof) near a seed."""
        return self._transmission.joints(self._runner.search(pose, self._motors(seed)))

    def self_motion(self, pose: Array) -> Array:
        """Ends (k, 2) of the intervals of what is held."""
        return self._runner.self_motion(pose)
