"""Arguments as arrays of real numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["real_array"]


def real_array(values: ArrayLike, name: str) -> Array:
    """The values as doubles; raises ValueError for what is no array of numbers, and for complex ones, whose
    imaginary part would be lost."""
    try:
        array = np.asarray(values)
        if array.dtype.kind != "c":
            return np.asarray(array, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} is no array of numbers: {type(values).__name__}") from None
    raise ValueError(f"{name} has complex values")
