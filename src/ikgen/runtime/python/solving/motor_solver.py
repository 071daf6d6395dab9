"""A compiled solver of motors' values, for seeds of the joints'."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.rows.compiled_rows import Found
from ikgen.runtime.python.solving.compiled_solving import Solver
from ikgen.runtime.python.solving.motor_values import Motors

__all__ = ["MotorSolver"]


@dataclass(frozen=True)
class MotorSolver:
    """The `Solver` that takes seeds and starts of joints, as they are checked, and gives rows of motors."""

    solver: Solver
    motors: Motors

    def solve(
        self, pose: object, held: object, seed: object, limits: object, project: object
    ) -> Found | None:
        """Implements `Solver`."""
        near = None if seed is None else self.motors.rows(np.array(seed))
        return self.solver.solve(pose, held, near, limits, project)

    def solve_batch(
        self, poses: Array, held: Array, seed: Array, limits: bool
    ) -> tuple[Array, NDArray[np.int64], Index]:
        """Implements `Solver`."""
        return self.solver.solve_batch(poses, held, self.motors.rows(seed), limits)

    def search(self, pose: Array, seed: Array, prefer: str, limits: bool) -> Found:
        """Implements `Solver`."""
        return self.solver.search(pose, self.motors.rows(seed), prefer, limits)

    def follow(self, poses: Array, start: Array, limits: bool) -> tuple[Array, int, int, Flags]:
        """Implements `Solver`."""
        return self.solver.follow(poses, self.motors.rows(start), limits)
