"""Motions of the tool to poses beside, where roots come apart.

Newton's method takes back what right angles made coincide. Farther off what more than two solutions that
meet become is not real, or far from them, but regular ones come apart of which more than two share the
hidden angle; closer by an elimination that has no rank at the pose leaves no digits.
"""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.arrays.rigid_motion import inverses, rotations_z

__all__ = ["ASIDE", "CLOSE", "FARTHER"]


def _displaced(by: float) -> tuple[Array, Array]:
    """A rotation of about so much (rad), as much of a translation (arm lengths), and their inverse."""
    X = np.eye(4)
    one, other = rotations_z(np.array([0.9, 1.1]) * by)
    X[:3, :3] = (one @ other[[2, 0, 1, 3]][:, [2, 0, 1, 3]])[:3, :3]
    X[:3, 3] = 0.8 * by, -1.1 * by, 0.6 * by
    return X, inverses(X)


ASIDE, FARTHER, CLOSE = _displaced(1e-3), _displaced(0.03), (_displaced(1e-6), _displaced(1e-8))
