"""What a solve gives back, as it is shown."""

from __future__ import annotations

import numpy as np
import pytest

from ikgen.runtime.python.rows.compiled_rows import found_nothing
from ikgen.runtime.python.rows.solutions import Solutions, Status, no_solutions

ROWS, FLAGS = np.zeros((1, 2)), np.zeros(1, dtype=bool)
ONE = "Solutions(q=array([[0., 0.]]), status=<Status.OK: 'OK'>, singular=array([False])"


@pytest.mark.parametrize(
    ("found", "shown"),
    [
        (Solutions(ROWS, Status.OK, FLAGS, names=lambda q: ()), ONE + ")"),
        (
            Solutions(ROWS, Status.OK, FLAGS, projected=ROWS),
            ONE + ", off=array([[0., 0.]]))",
        ),
    ],
)
def test_only_what_there_is_is_shown(found: Solutions, shown: str) -> None:
    assert repr(found) == shown


def test_a_reason_is_shown() -> None:
    assert repr(no_solutions(2, Status.INVALID, "no number")).endswith(", reason='no number')")


def test_those_of_compiled_solvers_look_the_same() -> None:
    class Nothing:
        status, q, singular, off = 1, np.empty((0, 2)), np.empty(0, dtype=bool), np.empty((0, 2))

        def __len__(self) -> int:
            return 0

    compiled = found_nothing(Nothing(), Status.LIMITS, lambda: "beyond")
    assert repr(compiled) == repr(no_solutions(2, Status.LIMITS, "beyond"))
