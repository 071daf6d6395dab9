"""How near rows come to the configurations whose poses are solved."""

from __future__ import annotations

from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ikgen.verify.runners.cpp_header import CppHeader

__all__ = ["gaps_in_both", "row_gaps"]

Array = NDArray[np.float64]


def row_gaps(found: Array, q: Array) -> Array:
    """How far (N,) the nearest of rows found (N, M, dof), NaN where there are fewer, is from revolute
    joints q (N, dof), whole turns aside."""
    off = np.abs((found - q[:, None] + np.pi) % (2.0 * np.pi) - np.pi).max(axis=2)
    return np.asarray(np.where(np.isnan(off), np.inf, off).min(axis=1))


def gaps_in_both(arm: ModuleType, header: CppHeader, q: Array, *, limits: bool = True) -> Array:
    """The same (2, N) of what the header finds at the poses of q, and of what the module does."""
    poses = arm.forward(q)
    batch, _, _ = arm.solve_batch(poses, limits=limits)
    rows = header.solve_many(poses, limits=limits)
    return np.array([row_gaps(found, q) for found in (rows.q, batch)])
