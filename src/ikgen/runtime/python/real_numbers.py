"""Arguments as arrays of real numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.array_types import Array

__all__ = ["real_array"]


def real_array(values: ArrayLike, name: str) -> Array:
    """The values as doubles; raises ValueError for complex ones, whose imaginary part would be lost."""
    array = np.asarray(values)
    if array.dtype.kind == "c":
        raise ValueError(f"{name} has complex values")
    return np.asarray(array, dtype=float)
