"""Differences of single entries of poses, and their derivatives by the joints."""

from __future__ import annotations

from typing import Any

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["Entries", "entry_errors", "entry_lane_errors", "entry_lane_rows", "entry_rows"]

Entries = tuple[tuple[int, int], ...]  # row and column of each; column 3 is the position


def entry_errors(
    entries: Entries, weight: Array, pose: Array, T: Array, flat: bool = False
) -> Array:
    """What poses (k, 4, 4) are off T (k, 4, 4), times the weights: (k, entries)."""
    lanes, aim = pose.transpose(1, 2, 0), T.transpose(1, 2, 0)
    return np.asarray(entry_lane_errors(entries, weight, lanes, aim, flat).T)


def entry_rows(entries: Entries, weight: Array, pose: Array, J: Array, flat: bool = False) -> Array:
    """The entries' derivatives (k, entries, dof) at poses (k, 4, 4), by their Jacobians (k, 6, dof)."""
    rows = entry_lane_rows(entries, weight, pose.transpose(1, 2, 0), J.transpose(2, 1, 0), flat)
    return np.asarray(rows.transpose(2, 1, 0))


def entry_lane_errors(
    entries: Entries, weight: Array, pose: Array, T: Array, flat: bool = False
) -> Array:
    """`entry_errors` (entries, k) of upper rows (3, 4, k). A `flat` heading counts by where it points: that
    of a tool which a rounded file tilts is a little shorter than 1."""
    row, column = zip(*entries)
    at = pose[row, column]
    if flat:
        heading = np.array(column) != 3
        short = 1.0 - (at[heading] ** 2).sum(axis=0)
        at[heading] *= 1.0 + short * (0.5 + short * (0.375 + 0.3125 * short))
    return np.asarray((T[row, column] - at) * weight[:, None])


def entry_lane_rows(
    entries: Entries, weight: Array, pose: Array, J: Any, flat: bool = False
) -> Any:
    """`entry_rows` (dof, entries, k) of upper rows (3, 4, k) and Jacobians (dof, 6, k)."""
    out = np.empty((len(J), len(entries), J.shape[2]), dtype=J.dtype)
    for i, (r, c) in enumerate(entries):
        if c == 3:
            out[:, i] = J[:, r]
        else:
            j, k = (r + 1) % 3, (r + 2) % 3
            out[:, i] = J[:, 3 + j] * pose[k, c] - J[:, 3 + k] * pose[j, c]
    if flat:
        heading = [i for i, (_, c) in enumerate(entries) if c != 3]
        along = np.stack([pose[entries[i]] for i in heading]).astype(J.dtype)
        out[:, heading] -= along * (along * out[:, heading]).sum(axis=1, keepdims=True)
    return out * weight.astype(J.dtype)[:, None]
