"""Near a singularity: the root on a side, the direction that keeps its sense, and rows that repeat."""

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
from ikgen.runtime.python.meeting_rows import Starts, _fresh, _root, _still, ends_of, rows_nearby
from ikgen.runtime.python.row_links import differences

Array = NDArray[np.float64]
ARM: Any = SimpleNamespace(
    chain=SimpleNamespace(revolute=(True, False)),
    policy=SimpleNamespace(coincident=1e-6, alike=0.05),
)


def root(side: float, rest: float, bend: float, flow: float) -> float:
    one = [np.array([[x]]) for x in (rest, bend, flow)]
    return float(_root(np.array([side]), *one)[0])


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("bend", [2.0, -3.0])
@pytest.mark.parametrize("flow", [0.0, 1e-3, -1e-3, 0.2, -0.2])
def test_the_root_is_that_on_its_side_of_the_least(side: float, bend: float, flow: float) -> None:
    """`flow x + bend x^2 / 2 = rest` has two, beside -flow / bend."""
    rest = 0.01 * np.sign(bend)
    x = root(side, rest, bend, flow)
    assert flow * x + 0.5 * bend * x * x == pytest.approx(rest, abs=1e-14)
    assert (root(-side, rest, bend, flow) - x) * side < 0.0 or flow == 0.0
    assert root(-side, rest, bend, flow) != pytest.approx(x)


def test_a_straight_line_has_none_and_none_is_far() -> None:
    for side in (1.0, -1.0):
        assert root(side, 0.01, 0.0, 0.3) == 0.0  # straight: the other joints have done it all
        assert abs(root(side, 1.0, 1e-9, 0.0)) == pytest.approx(0.3)


def test_the_direction_of_least_motion_keeps_its_sense() -> None:
    rng = np.random.default_rng(5)
    for _ in range(6):
        u, s, vt = np.linalg.svd(rng.normal(size=(6, 6)))
        slope = (u * np.array([*s[:-1], 1e-6])) @ vt
        for sense in (1.0, -1.0):
            start = sense * vt[-1] + 0.3 * rng.normal(size=6)
            found = _still(slope[None], start[None], 1e-12)[0]
            np.testing.assert_allclose(found, np.sign(start @ vt[-1]) * vt[-1], atol=1e-6)


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
    starts = Starts(rows, np.zeros((n, 4, 4)), places, np.zeros(n, bool), np.array(source))
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
    given = np.zeros(1, np.intp), np.zeros(1, bool), np.zeros(1, int)
    starts = Starts(bent(low)[None], pose[None], *given)
    of, rows, _ = rows_nearby(arm._ARM, starts, ends_of(arm._ARM, starts.q, starts.T))
    assert not of.any() and np.abs(arm.forward(rows) - pose).max() < 1e-9
    assert np.abs(rows - bent(low + off)).max(axis=1).min() < 1e-8
    assert rows[:, 2].min() - bent(low)[2] == pytest.approx(-off, rel=1e-2)
