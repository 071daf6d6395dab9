"""Arguments as arrays of real numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["real_array"]


def real_array(values: ArrayLike, name: str) -> Array:
    """The values as doubles. Raises ValueError for what is no array of numbers, as texts and None are
    none, and for complex ones, whose imaginary part would be lost."""
    kind = ""
    try:
        array = np.asarray(values)
        kind = array.dtype.kind
        if kind in "biuf" or (kind == "O" and all(hasattr(x, "__float__") for x in array.flat)):
            return np.asarray(array, dtype=float)
    except (TypeError, ValueError, OverflowError):
        pass  # ragged rows, or a number beyond what a double holds
    if kind == "c":
        raise ValueError(f"{name} has complex values")
    raise ValueError(f"{name} is no array of numbers: {type(values).__name__}")
