"""The four angles about two parallel axes of a loop from the other two."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.arrays.rigid_motion import inverses, rotations_z
from ikgen.runtime.python.elimination.loop_equations import of_constants

__all__ = ["parallel_turns"]


def parallel_turns(C: list[Array], side: Array, n: Array, t5: Array, t6: Array) -> Array:
    """The loop's angles (k, 6) where the parallel axes have the direction n (k, 3) in the frame between
    axes 5 and 6; `side` (k, 1) or (1, 1): 1 or -1, the direction of the third along it."""
    one = C[4] @ rotations_z(t6) @ C[5]
    four = rotations_z(-t5) @ of_constants(inverses, C[3])
    t1 = _heading(_seen(one, n)) - _heading(C[0][..., :3, 2])
    t4 = _heading(side * C[2][..., 2, :3]) - _heading(_seen(four, n))
    two = one @ rotations_z(t1) @ C[0]
    three = four @ rotations_z(-t4) @ of_constants(inverses, C[2])
    t2 = _heading(_seen(two, three[:, :3, 3] - two[:, :3, 3])) - _heading(C[1][..., :3, 3])
    rest = inverses(two @ rotations_z(t2) @ C[1]) @ three
    t3 = np.arctan2(rest[:, 1, 0] - rest[:, 0, 1], rest[:, 0, 0] + rest[:, 1, 1])
    return np.stack([t1, t2, t3, t4, t5, t6], axis=-1)


def _heading(v: Array) -> Array:
    """Angle about z of v (..., 3)."""
    return np.asarray(np.arctan2(v[..., 1], v[..., 0]), dtype=float)


def _seen(frame: Array, v: Array) -> Array:
    """v (k, 3) in the axes of frames (k, 4, 4)."""
    return np.asarray((v[:, None] @ frame[..., :3, :3])[:, 0], dtype=float)
