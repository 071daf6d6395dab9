"""Rows a part at a time."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.row_blocks import in_blocks

Array = NDArray[np.float64]


@pytest.mark.parametrize("size", [1, 3, 9, 10, 11])
def test_parts_are_put_together_in_order(size: int) -> None:
    a, b = np.arange(10.0), np.arange(20.0).reshape(10, 2)
    seen: list[int] = []

    def step(x: Array, y: Array) -> tuple[Array, Array]:
        seen.append(len(x))
        return y[:, 1] - x, 2.0 * y

    first, second = in_blocks(step, size, a, b)
    np.testing.assert_array_equal(first, b[:, 1] - a)
    np.testing.assert_array_equal(second, 2.0 * b)
    assert max(seen) <= size and sum(seen) == 10
