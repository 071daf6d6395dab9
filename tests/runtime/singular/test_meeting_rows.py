"""Near a singularity: rows that repeat, and both of two that meet."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.cpp_modules import solver_module
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.rows.row_links import differences
from ikgen.runtime.python.singular.meeting_rows import Starts, _fresh, leads_of, rows_nearby

Array = NDArray[np.float64]
ARM: Any = SimpleNamespace(
    period=(WHOLE_TURN, 0.0),
    policy=SimpleNamespace(coincident=1e-6, neighbouring=0.05),
    beside=np.eye(4)[None],
)


def test_gaps_are_on_the_shortest_way_of_what_turns() -> None:
    a, b = np.array([3.0, 3.0]), np.array([-3.0, -3.0])
    np.testing.assert_allclose(differences(ARM, a, b), [2.0 * np.pi - 6.0, -6.0])
    np.testing.assert_allclose(differences(ARM, b, a), [6.0 - 2.0 * np.pi, 6.0])


def fresh(
    q: list[list[float]], source: list[int], near: str = "", stalled: str = "", pose: str = ""
) -> list[bool]:
    n = len(q)
    flags = [np.array([c == "x" for c in text.ljust(n, ".")]) for text in (near, stalled)]
    places = np.array([int(c) for c in pose.ljust(n, "0")])
    rows = np.array(q)
    none = np.zeros(n, bool)
    starts = Starts(rows, np.zeros((n, 4, 4)), places, none, np.array(source), 0 * places)
    return _fresh(ARM, rows, starts, *flags).tolist()  # type: ignore[no-any-return]


def test_rows_of_poses_beside_are_fresh_where_no_earlier_row_is_the_same() -> None:
    a, b = [0.5, 1.0], [1.5, 1.0]
    assert fresh([a, b, a], [0, 0, 1]) == [True, True, False]
    assert fresh([a, b, [0.5 + 2.0 * np.pi, 1.0]], [0, 0, 1]) == [True, True, False]
    assert fresh([a, a], [0, 0]) == [True, True]  # what the pose itself has is told apart elsewhere
    assert fresh([a, b, a], [0, 0, 1], pose="011") == [True, True, True]
    assert fresh([a, b, a], [-1, 0, 1]) == [
        True,
        True,
        True,
    ]  # what is given leads to its own alone
    assert fresh([[0.5, 1e3], [0.5, 1e3 + 5e-4]], [0, 1]) == [True, False]  # slides by their size
    assert fresh([[0.5, 1.0], [0.5 + 5e-6, 1.0]], [0, 1]) == [True, True]


def test_a_row_that_stalled_near_another_solution_is_not_fresh() -> None:
    a, near, far = [0.5, 1.0], [0.52, 1.0], [0.7, 1.0]
    assert fresh([a, near], [0, 1], near="xx", stalled=".x") == [True, False]
    assert fresh([a, near], [0, 1], near="xx", stalled="..") == [True, True]
    assert fresh([a, near], [0, 1], near=".x", stalled=".x") == [True, True]
    assert fresh([a, far], [0, 1], near="xx", stalled=".x") == [True, True]
    assert fresh([near, a], [1, 0], near="xx", stalled="x.") == [True, True]


@pytest.mark.parametrize("off", [1e-4, 1e-5])
def test_both_rows_beside_a_fold_are_found_from_it(off: float, tmp_path: Path) -> None:
    """The stretched arm stands between the two rows of a pose at which it is a little bent."""
    arm = import_text(emit_module(solver_module("kuka_kr6r900sixx")), tmp_path)
    straight = np.array([0.2, -0.9, -1.0, 0.3, 0.6, -0.4])

    def bent(by: float) -> Array:
        return straight + by * np.eye(6)[2]

    low, high = 0.0, 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        turned = np.linalg.det(arm.jacobian(bent(low))) * np.linalg.det(arm.jacobian(bent(middle)))
        low, high = (low, middle) if turned < 0.0 else (middle, high)
    pose = arm.forward(bent(low + off))
    own = np.zeros(1, np.intp), np.zeros(1, bool), np.zeros(1, int), np.zeros(1, np.intp)
    starts = Starts(bent(low)[None], pose[None], *own)
    of, rows, _ = rows_nearby(arm._ARM, leads_of(arm._ARM, starts, np.zeros((1, 1), bool)))
    assert not of.any() and np.abs(arm.forward(rows) - pose).max() < 1e-9
    assert np.abs(rows - bent(low + off)).max(axis=1).min() < 1e-8
    assert rows[:, 2].min() - bent(low)[2] == pytest.approx(-off, rel=1e-2)
