"""Tuples of arrays, or of such tuples again, whose first axes belong together."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["joined", "some_of"]


def joined(*parts: Any) -> Any:
    """Several as one."""
    return type(parts[0])(
        *(joined(*x) if isinstance(x[0], tuple) else np.concatenate(x) for x in zip(*parts))
    )


def some_of(parts: Any, index: Any) -> Any:
    """Some of what they stand for."""
    return type(parts)(*(some_of(x, index) if isinstance(x, tuple) else x[index] for x in parts))
