"""Which rows go on as which from one value of a held joint to the next."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.rows.row_links import linked_rows, origins

ARM: Any = SimpleNamespace(period=(WHOLE_TURN, 0.0))


def test_rows_go_on_as_the_nearest_that_is_nearest_to_them() -> None:
    q = np.array([
        [[3.1, 0.0], [0.0, 2.0], [1.0, 1.0]],
        [[0.1, 2.1], [-3.1, 0.1], [1.1, 1.0]],
        [[0.3, 2.0], [0.2, 2.1], [3.0, 0.2]],
    ])  # fmt: skip
    real = np.array([[True, True, True], [True, True, False], [True, True, True]])
    links = linked_rows(ARM, q, real)
    assert links.tolist() == [[1, 0, -1], [1, 2, -1]]
    assert linked_rows(ARM, q, real & False).tolist() == [[-1] * 3] * 2


def test_rows_of_curves_that_cross_stay_in_their_columns() -> None:
    """Where all do: not where one of them is far from its own before, or is no more."""
    values = [[-0.01, 0.01, 2.0], [0.01, -0.01, 2.0], [0.02, -0.02, 1.5]]
    q = np.stack([np.array(values), np.zeros((3, 3))], axis=2)
    real = np.ones((3, 3), dtype=bool)
    assert linked_rows(ARM, q, real).tolist() == [[1, 0, 2], [0, 1, 2]]
    assert linked_rows(ARM, q, real, guarded=True).tolist() == [[0, 1, 2], [0, 1, 2]]
    q[1, 2, 0] = 1.6
    assert linked_rows(ARM, q, real, guarded=True).tolist() == [[1, 0, 2], [0, 1, 2]]
    q[1, 2, 0], real[1:, 2] = 2.0, False
    assert linked_rows(ARM, q, real, guarded=True).tolist() == [[1, 0, -1], [0, 1, -1]]


def test_each_row_knows_what_goes_on_as_it() -> None:
    following = np.array([[2, -1, 0], [-1, -1, -1], [1, 2, -1]])
    assert origins(following).tolist() == [[2, -1, 0], [-1, -1, -1], [-1, 0, 1]]
