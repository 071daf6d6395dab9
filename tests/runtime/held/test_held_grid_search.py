"""The grid of held joints' values that is searched first."""

from __future__ import annotations

from math import inf, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.chains import rotation, translation

from ikgen.runtime.python.arm.chain_kinematics import chain_of
from ikgen.runtime.python.held.held_grid_search import _distinct, _grid, _lowest

Array = NDArray[np.float64]
TO_X = rotation([0.0, 1.0, 0.0], pi / 2)


def arm(kinds: str, lower: tuple[float, ...], upper: tuple[float, ...]) -> Any:
    """All joints are held; slides and turns are along x."""
    frames = np.array([TO_X, *[np.eye(4)] * len(kinds)])
    motions = tuple((j, kind == "R", 1.0, 0.0) for j, kind in enumerate(kinds))
    return SimpleNamespace(
        chain=chain_of(frames, motions, len(kinds)), lower=lower, upper=upper,
        free=tuple(range(len(kinds))), task=SimpleNamespace(entries=((0, 3),)),
        period=tuple(2.0 * pi if kind == "R" else 0.0 for kind in kinds),
    )  # fmt: skip


def axes(one: Any, middle: tuple[float, ...], limits: bool = True) -> tuple[list[Array], Any]:
    values, steps = _grid(one, translation(0.4, 0.0, 0.0), middle, limits)
    each = [np.unique(column) for column in values.T]
    assert len(values) == np.prod([len(axis) for axis in each]) == len(np.unique(values, axis=0))
    return each, steps


def test_all_pairs_of_evenly_spread_values_are_on_it() -> None:
    one = arm("RR", (-1.0, 0.5), (1.0, 2.0))
    (first, second), steps = axes(one, (-1.0, 0.5))
    assert len(first) == len(second) == 100
    np.testing.assert_allclose(first, np.linspace(-1.0, 1.0, 100), atol=1e-15)
    np.testing.assert_allclose(second, np.linspace(0.5, 2.0, 100), atol=1e-15)
    assert steps == pytest.approx((1.0 / 99.0, 0.75 / 99.0))


def test_what_is_wanted_is_on_it_as_far_as_limits_allow() -> None:
    one = arm("RR", (-1.0, 0.5), (1.0, 2.0))
    (first, second), _ = axes(one, (0.123, 9.0))
    assert 0.123 in first and second[-1] == 2.0
    others = np.sort(np.abs(first[:, None] - np.linspace(-1.0, 1.0, 100)).min(axis=1))
    assert others[-2] < 1e-15 < others[-1] < 0.5 * 2.0 / 99.0


@pytest.mark.parametrize("ends", [(-inf, 0.5), (-0.5, inf), (-inf, inf)])
def test_a_turn_that_is_not_bounded_on_both_sides_goes_once_around(
    ends: tuple[float, float],
) -> None:
    low, high = ends
    for limits in (True, False):
        (first, _), steps = axes(arm("RR", (low, 0.0), (high, 1.0)), (pi, 0.0), limits)
        assert (first[0], first[-1]) == (-pi, pi) and steps[0] == pytest.approx(pi / 99.0)
    (_, second), _ = axes(arm("RR", (low, 0.0), (high, 1.0)), (pi, pi), False)
    assert (second[0], second[-1]) == (-pi, pi)


def test_an_unbounded_slide_is_looked_at_a_metre_to_either_side() -> None:
    for low, high, wanted in (
        (-inf, inf, (2.0, 4.0)),
        (-inf, 3.5, (2.0, 3.5)),
        (-inf, 1.0, (0.0, 1.0)),
        (2.5, inf, (2.5, 4.0)),
        (7.0, inf, (7.0, 8.0)),
    ):
        one = arm("RP", (0.0, low), (1.0, high))
        (_, second), _ = axes(one, (0.0, 3.0))
        assert (second[0], second[-1]) == wanted


def lines(one: Any, costs: Array, rows: Array, away: Array) -> list[tuple[int, int]]:
    point, row = _lowest(one, rows, costs, away, 0.7)
    return list(zip(point.tolist(), row.tolist(), strict=True))


def grid(count: int) -> tuple[Array, Array]:
    """Two values from -1 to 1 (n,), all pairs."""
    axis = np.linspace(-1.0, 1.0, count)
    first, second = np.meshgrid(axis, axis, indexing="ij")
    return first.reshape(-1), second.reshape(-1)


def test_each_minimum_of_each_branch_is_one_start() -> None:
    """The cost rises from two places, which one branch has and the other has not."""
    one, (x, y) = arm("PP", (-1.0, -1.0), (1.0, 1.0)), grid(9)
    first = (x**2 - 0.25) ** 2 + (y - 0.25) ** 2  # least at (-0.5, 0.25) and (0.5, 0.25)
    second = 5.0 + (x + 0.75) ** 2 + (y + 0.5) ** 2
    rows = np.stack([np.stack([x, y], axis=1), np.stack([x + 9.0, y], axis=1)], axis=1)
    found = lines(one, np.stack([first, second], axis=1), rows, np.zeros((81, 2)))
    assert [(x[point], y[point], row) for point, row in found] == [
        (-0.5, 0.25, 0), (0.5, 0.25, 0), (-0.75, -0.5, 1),
    ]  # fmt: skip


def test_branches_are_known_wherever_they_are_in_order() -> None:
    one, (x, y) = arm("PP", (-1.0, -1.0), (1.0, 1.0)), grid(9)
    costs = np.stack([x**2 + y**2, 5.0 + (x - 0.5) ** 2 + y**2], axis=1)
    rows = np.stack([np.stack([x, y], axis=1), np.stack([x + 9.0, y], axis=1)], axis=1)
    turned = np.arange(81) % 2 == 1
    costs[turned], rows[turned] = costs[turned, ::-1], rows[turned, ::-1]
    found = lines(one, costs, rows, np.zeros((81, 2)))
    assert [(x[point], y[point]) for point, _ in found] == [(0.0, 0.0), (0.5, 0.0)]


def test_of_rows_as_good_as_each_other_the_nearest_is_one() -> None:
    """A joint that the task does not read changes no cost."""
    one, (x, y) = arm("PP", (-1.0, -1.0), (1.0, 1.0)), grid(9)
    rows, away = np.stack([x, y], axis=1)[:, None], (x - 0.3) ** 2 + y**2
    found = lines(one, (y**2)[:, None], rows, away[:, None])
    assert [(x[point], y[point]) for point, _ in found] == [(0.25, 0.0)]


def test_rows_outside_are_no_starts() -> None:
    one, (x, y) = arm("PP", (-1.0, -1.0), (1.0, 1.0)), grid(5)
    costs, rows = np.full((25, 1), inf), np.stack([x, y], axis=1)[:, None]
    assert lines(one, costs, rows, np.zeros((25, 1))) == []
    costs[7] = 3.0
    assert lines(one, costs, rows, np.zeros((25, 1))) == [(7, 0)]


def test_what_ends_at_the_same_row_is_taken_once() -> None:
    one = arm("RP", (-1.0, -1.0), (1.0, 1.0))
    one.policy = SimpleNamespace(neighbouring=1e-2)
    rows = np.array([[0.1, 0.0], [0.1 + 2.0 * pi, 0.005], [0.1, 2.0 * pi], [0.12, 0.0]])
    assert _distinct(one, rows, np.array([1, 0, 2, 3])) == [1, 2, 3]
