"""The tool and the base as exact as the rows, for tasks that read a part of the pose.

A whole pose is freed from both before anything is solved, whatever their digits. A task that reads one
axis of the tool has it in its equations: an axis that is the last joint's but for the sixth digit would be
a general one there, in equations whose coefficients are the file's rounding.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ikgen.kinematics.file_frames import frames_beside, largest_deviation
from ikgen.kinematics.forward import pose_difference
from ikgen.kinematics.row_ends import tidy_pose
from ikgen.kinematics.snapping import SnapLog, snap_rotation
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain

__all__ = ["with_exact_ends"]

_ANGLE = 2e-3
"""rad."""
_SAME = 2e-15


def with_exact_ends(dh: DHChain, *, length_tolerance: float = 1e-5) -> DHChain:
    """`dh` with angles of `X_base` and `X_tip` within 2 mrad of multiples of pi/12, and lengths within
    `length_tolerance` (m) of zero, as these; told in its snaps and its deviation."""
    log = SnapLog()
    X_base = _exact(dh.X_base, "base", length_tolerance, log)
    X_tip = _exact(dh.X_tip, "tool", length_tolerance, log)
    if X_base is dh.X_base and X_tip is dh.X_tip:
        return dh
    frames = frames_beside(dh, dh.rows, (X_base, X_tip))
    exact = replace(dh, X_base=X_base, X_tip=X_tip, file_frames=frames, snaps=dh.snaps + log.snaps)
    return replace(exact, deviation=largest_deviation(exact))


def _exact(X: Array, name: str, near: float, log: SnapLog) -> Array:
    """One end's transform (4, 4)."""
    out = np.array(X)
    out[:3, :3] = snap_rotation(X[:3, :3], _ANGLE, _ANGLE)
    log.add(f"turn of the {name}", pose_difference(out, X)[1], 0.0)
    for i, axis in enumerate("xyz"):
        if abs(X[i, 3]) <= near:
            log.add(f"{axis} of the {name}", float(X[i, 3]), 0.0)
            out[i, 3] = 0.0
    return X if float(np.abs(out - X).max()) < _SAME else tidy_pose(out)
