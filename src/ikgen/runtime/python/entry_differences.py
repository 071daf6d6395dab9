"""Differences of single entries of poses, and their derivatives by the joints."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.array_types import Array
from ikgen.runtime.python.chain_kinematics import cross

__all__ = ["Entries", "entry_errors", "entry_rows"]

Entries = tuple[tuple[int, int], ...]  # row and column of each; column 3 is the position


def entry_errors(entries: Entries, weight: Array, pose: Array, T: Array) -> Array:
    """What poses (k, 4, 4) are off T (k, 4, 4), times the weights: (k, entries)."""
    row, column = zip(*entries)
    return np.asarray((T[:, row, column] - pose[:, row, column]) * weight)


def entry_rows(entries: Entries, weight: Array, pose: Array, J: Array) -> Array:
    """The entries' derivatives (k, entries, dof) at poses (k, 4, 4), by their Jacobians (k, 6, dof)."""
    out = np.empty((len(pose), len(entries), J.shape[2]))
    for i, (r, c) in enumerate(entries):
        if c == 3:
            out[:, i] = J[:, r]
        else:
            out[:, i] = cross(J[:, 3:].transpose(0, 2, 1), pose[:, None, :3, c])[:, :, r]
    return out * weight[:, None]
