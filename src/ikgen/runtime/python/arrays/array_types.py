"""Names of the types that all of the runtime speaks of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["Array", "Flags", "Index", "Row", "Single"]

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Index = NDArray[np.intp]
Row = tuple[float, ...]
Single = NDArray[np.float32]
