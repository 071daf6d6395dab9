"""Newton's method on all of what an arm's rows are refined towards."""

from __future__ import annotations

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.newton.refinement import errors_and_slopes, refine

__all__ = ["linearized", "moved_rows", "refined"]


def linearized(arm: Arm, q: Array, aim: Array) -> tuple[Array, Array]:
    """`errors_and_slopes` of rows (k, dof) towards `aims`."""
    return errors_and_slopes(arm.chain, arm.task, arm.moving, q, aim, arm.angle)


def refined(arm: Arm, q: Array, aim: Array) -> tuple[Array, Array, Array, Array]:
    """`refine` of rows (k, dof) towards `aims`."""
    return refine(arm.chain, arm.task, arm.moving, q, aim, arm.policy, arm.angle)


def moved_rows(arm: Arm, q: Array, step: Array) -> Array:
    """Rows (k, dof) after a step (k, n) of the joints that move."""
    if not arm.free:
        return q + step
    q = q.copy()
    q[:, list(arm.moving)] += step
    return q
