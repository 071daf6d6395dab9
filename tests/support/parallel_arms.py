"""Chains of six joints with two parallel axes, of every kind that has an elimination of its own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from tests.elimination.test_elimination import dh_frames

from ikgen.runtime.python.arrays.rigid_motion import inverses
from ikgen.runtime.python.elimination.parallel_links import MEETING, PLAIN, UPRIGHT

__all__ = ["KINDS", "exchanged", "flipped", "parallel_frames", "rounded_frames"]

Array = NDArray[np.float64]
KINDS = (PLAIN, UPRIGHT, MEETING)
_H = 0.5 * np.pi


def parallel_frames(kind: int, *, right_angle: float = _H) -> Array:
    """Axes 2 and 3 parallel, 0.5 m apart, beside links of the kind; the others in general position."""
    alpha, a = [0.3, right_angle, 0.0, right_angle, 1.1, -0.9], [0.0, 0.0, 0.5, 0.0, 0.08, 0.05]
    d = [0.1, 0.0, 0.0, 0.4, 0.15, 0.1]
    if kind == UPRIGHT:
        a[1], a[3] = 0.12, 0.07
    if kind == MEETING:
        alpha[1], alpha[3], d[1], d[2] = 1.2, -0.8, 0.06, 0.03
    return dh_frames(alpha, a, d)


def rounded_frames(kind: int) -> Array:
    """The same with right angles of four digits."""
    return parallel_frames(kind, right_angle=1.5708)


def exchanged(frames: Array) -> Array:
    """Base and tip of a chain (7, 4, 4) exchanged: axes 4 and 5 are the parallel ones."""
    return np.asarray(inverses(frames)[::-1])


def flipped(frames: Array) -> Array:
    """The same chain, its third axis in the opposite direction."""
    half = np.diag([1.0, -1.0, -1.0, 1.0])
    out = frames.copy()
    out[2], out[3] = frames[2] @ half, half @ frames[3]
    return out
