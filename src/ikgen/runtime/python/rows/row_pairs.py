"""Rows to be compared."""

from __future__ import annotations

from functools import cache

import numpy as np

from ikgen.runtime.python.arrays.array_types import Index

__all__ = ["pairs"]


@cache
def pairs(count: int) -> tuple[Index, Index]:
    """Each of so many rows with each one before it."""
    return np.tril_indices(count, -1)
