"""Arguments as arrays of real numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["real_array"]


def real_array(values: ArrayLike, name: str) -> Array:
    """The values as doubles; raises ValueError for what is no array of numbers, nor are texts and None, and
    for complex ones, whose imaginary part would be lost."""
    try:
        array = np.asarray(values)
        if array.dtype.kind in "biuf":
            return np.asarray(array, dtype=float)
        if array.dtype.kind == "O" and all(hasattr(x, "__float__") for x in array.flat):
            return np.asarray(array, dtype=float)
    except (TypeError, ValueError, OverflowError):
        array = np.empty(0, dtype=object)
    if array.dtype.kind == "c":
        raise ValueError(f"{name} has complex values")
    raise ValueError(f"{name} is no array of numbers: {type(values).__name__}")
