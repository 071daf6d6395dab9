"""The task of a planar arm's position, as an arm of the runtime takes it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["Plane"]

Array = NDArray[np.float64]


class Plane:
    """The task of a position in the plane."""

    @staticmethod
    def error(pose: Array, T: Array) -> Array:
        return T[:, :2, 3] - pose[:, :2, 3]

    @staticmethod
    def rows(_: Array, J: Array) -> Array:
        return J[:, :2]
