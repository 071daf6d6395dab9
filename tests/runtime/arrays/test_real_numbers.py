"""What counts as an array of real numbers."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from ikgen.runtime.python.arrays.real_numbers import real_array


@pytest.mark.parametrize(
    "good", [1, [1, 2.5], [True, False], np.float32([1.0]), [Fraction(1, 2)], []]
)
def test_numbers_of_any_kind_are_doubles(good: Any) -> None:
    found = real_array(good, "q")
    assert found.dtype == float and found.tolist() == np.asarray(good, dtype=float).tolist()


@pytest.mark.parametrize(
    "bad", ["1", ["1", "2"], [None, 1.0], [[1.0], [1.0, 2.0]], b"1", {}, [10**400]]
)
def test_what_is_no_number_is_refused(bad: Any) -> None:
    with pytest.raises(ValueError, match="q is no array of numbers"):
        real_array(bad, "q")


def test_an_imaginary_part_is_not_lost() -> None:
    with pytest.raises(ValueError, match="q has complex values"):
        real_array([1.0 + 0.0j], "q")
