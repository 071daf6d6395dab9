"""Rows a part at a time, so that their arrays fit into a processor's cache."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["in_blocks"]


def in_blocks(step: Callable[..., Any], size: int, *rows: Array) -> Any:
    """The arrays that `step` makes of `rows`, arrays (k, ...), `size` of them at a time."""
    if len(rows[0]) <= size:
        return step(*rows)
    parts = [step(*(x[i : i + size] for x in rows)) for i in range(0, len(rows[0]), size)]
    return tuple(np.concatenate(part) for part in zip(*parts))
