"""Newton's method on curves along which a pose hardly moves."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Chain
from ikgen.runtime.python.arm.task_interface import Task
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.newton.refinement import errors_and_slopes

__all__ = ["flat_steps"]

_FLAT_STEPS = 60
_FLAT_LONGEST = 0.3  # rad or arm lengths: a step along a singular direction
_FLAT_ENOUGH = 1e-14  # error


def flat_steps(
    chain: Chain, task: Task, moving: Sequence[int], q: Array, T: Array
) -> tuple[Array, Array]:
    """The best rows of undamped steps of the joints `moving` from q (k, dof) towards T (k, 4, 4), and their
    errors (k,): beside a continuum, where the error along a curve is as small as its derivative, whose
    square the normal equations of damped steps lose. By singular values, each direction's step bounded."""
    moving = list(moving)
    best, result, going = np.full(len(q), inf), q.copy(), np.arange(len(q))
    for _ in range(_FLAT_STEPS):
        error, slope = errors_and_slopes(chain, task, moving, q, T, None)
        worst = np.abs(error).max(axis=1)
        better = worst < best[going]
        result[going[better]], best[going[better]] = q[better], worst[better]
        on = worst > _FLAT_ENOUGH
        if not on.any():
            break
        going, q, T, error, slope = (x[on] for x in (going, q, T, error, slope))
        U, s, Vt = np.linalg.svd(slope, full_matrices=False)
        along = np.einsum("kmi,km->ki", U, error) / np.maximum(s, 1e-300)
        along = np.clip(along, -_FLAT_LONGEST, _FLAT_LONGEST)
        q[:, moving] += np.einsum("kij,ki->kj", Vt, along)
    return result, best
