"""Steps of held values that are taken: to better rows of the same branch."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.held import solution_search
from ikgen.runtime.python.held.solution_search import Reach, _improved, improved_rows

Array = NDArray[np.float64]


def arm(count: int = 1, **more: Any) -> Any:
    fields = {
        "lower": (-9.0,) * count,
        "upper": (9.0,) * count,
        "free": tuple(range(count)),
        "most": 8,
    }
    return SimpleNamespace(period=(0.0,) * count, **{**fields, **more})


def cost_of(monkeypatch: pytest.MonkeyPatch, cost: Any, away: float = 0.0) -> list[Array]:
    """The row at held values is these, so far `away` in each; of its cost."""
    asked: list[Array] = []

    def rows(arm: Any, T: Array, held: Array) -> Any:
        asked.append(held.copy())
        return held[:, None] + away, np.ones((len(held), 1), dtype=bool)

    monkeypatch.setattr(solution_search, "rows_batch", rows)
    doubt = np.zeros(99, dtype=bool)
    monkeypatch.setattr(solution_search, "aims", lambda arm, T, held: T)
    monkeypatch.setattr(
        solution_search,
        "refine_few",
        lambda arm, q, T: (q, *doubt[None, : len(q)].repeat(2, axis=0), ~doubt[: len(q)]),
    )
    monkeypatch.setattr(solution_search, "_beside_fold", lambda arm, q, T: (q, doubt[: len(q)]))
    monkeypatch.setattr(
        solution_search, "preference_costs",
        lambda arm, preference, q, limits: (q, cost(q), q[..., 0] < 5.0),
    )  # fmt: skip
    return asked


WANTED: Any = ("near", (), ())
ANYWHERE = (-np.inf, np.inf)
FAR = Reach(np.array([-50.0, 50.0]), np.array([[-50.0], [50.0]]), np.array([False, False]))


def improved(trial: list[float], start: float = 1.0, limits: bool = True, **more: Any) -> Any:
    n = len(trial)
    now = np.full((n, 1), start), np.full((n, 1), start), np.full(n, start**2)
    better = _improved(arm(**more), np.eye(4), WANTED, limits, now, np.array(trial)[None, :, None])
    return better.tolist(), now[0][:, 0].tolist(), now[1][:, 0].tolist(), now[2].tolist()


def test_better_rows_are_taken_with_their_costs(monkeypatch: pytest.MonkeyPatch) -> None:
    cost_of(monkeypatch, lambda q: q[..., 0] ** 2)
    found = improved([0.6, 1.2, -1.0, 1.0])
    assert found[0] == [True, False, False, False]  # one as good is not better
    assert found[1] == found[2] == [0.6, 1.0, 1.0, 1.0]
    assert found[3] == pytest.approx([0.36, 1.0, 1.0, 1.0])


def test_rows_of_other_branches_and_outside_are_not(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a radian or metre from the one that the step began at."""
    cost_of(monkeypatch, lambda q: -q[..., 0])
    assert improved([1.4, 1.6, 2.4])[0] == [True, False, False]
    assert improved([5.1, 4.9], start=4.8)[0] == [False, True]
    cost_of(monkeypatch, lambda q: -q[..., 0], away=0.7)
    assert improved([1.1])[0] == [False]


def test_trials_stay_inside_the_limits_where_these_count(monkeypatch: pytest.MonkeyPatch) -> None:
    for limits, wanted in ((True, 1.2), (False, 1.3)):
        asked = cost_of(monkeypatch, lambda q: -q[..., 0])
        assert improved([1.3], limits=limits, upper=(1.2,))[1] == [wanted]
        assert asked[0].tolist() == [[wanted]]


def test_none_is_asked_beyond_the_end_of_a_branch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nor where it is already, which rows of a fold do not tell."""
    asked = cost_of(monkeypatch, lambda q: -q[..., 0])
    start = (1.0, np.array([1.0]), 0.1, (0.5, 1.15), FAR)
    rows, cost = improved_rows(arm(), np.eye(4), [start], WANTED, True)
    assert rows[0, 0] == -cost[0] == 1.15 and max(trial.max() for trial in asked) == 1.15
    assert [len(trial) for trial in asked[-5:]] == [1] * 5  # inwards alone


def test_steps_get_shorter_where_none_is_better(monkeypatch: pytest.MonkeyPatch) -> None:
    """By somewhat more than the half, so that they come to other places."""
    asked = cost_of(monkeypatch, lambda q: (q[..., 0] - 0.3) ** 2)
    start = (0.3, np.array([0.3]), 0.4, ANYWHERE, FAR)
    rows, _ = improved_rows(arm(), np.eye(4), [start], WANTED, True)
    np.testing.assert_allclose(rows[0], 0.3, atol=1e-6)
    steps = [float(np.abs(trial[0] - 0.3).max()) for trial in asked]
    np.testing.assert_allclose(steps[:8], 0.4 * 0.4 ** np.arange(8), rtol=1e-6)


def test_each_start_is_led_to_the_minimum_beside_it(monkeypatch: pytest.MonkeyPatch) -> None:
    cost_of(monkeypatch, lambda q: (q[..., 0] - np.round(q[..., 0])) ** 2 + 1e-3 * q[..., 0])
    starts = [(x, np.array([x]), 0.1, ANYWHERE, FAR) for x in (3.2, 1.1, 1.9, -0.8)]
    rows, cost = improved_rows(arm(), np.eye(4), starts, WANTED, True)
    np.testing.assert_allclose(rows[:, 0], [3.0, 1.0, 2.0, -1.0], atol=1e-3)
    np.testing.assert_allclose(cost, 1e-3 * rows[:, 0], atol=1e-6)


def fold(monkeypatch: pytest.MonkeyPatch, bend: float) -> list[int]:
    """Rows of x (first entry) at held value h (second): x * x = 1 - h times a bend, two that meet at h = 1.
    How many were asked of the closed form."""
    asked: list[int] = []

    def rows(arm: Any, T: Array, held: Array) -> Any:
        asked.append(len(held))
        return np.stack([[0.0 * held[:, 0], held[:, 0]]], axis=0).transpose(2, 0, 1), held < 1.0

    def approach(arm: Any, q: Array, aim: Array, side: Array) -> tuple[Array, Array]:
        x = side * np.sqrt(np.maximum(bend * (1.0 - aim[:, 0]), 0.0))
        return np.stack([x, aim[:, 0]], axis=1), np.abs(x)

    def refined(arm: Any, q: Array, aim: Array) -> Any:
        return q, np.where(aim[:, 0] <= 1.0, 0.0, 1e-9), None, None

    none = np.zeros(9, dtype=bool)
    monkeypatch.setattr(solution_search, "rows_batch", rows)
    monkeypatch.setattr(solution_search, "aims", lambda arm, T, held: held)
    monkeypatch.setattr(
        solution_search, "refine_few", lambda arm, q, T: (q, none[: len(q)], 0, none[: len(q)])
    )
    monkeypatch.setattr(solution_search, "approach", approach)
    monkeypatch.setattr(solution_search, "refined", refined)
    return asked


def test_rows_beside_a_fold_are_of_the_branch_that_is_nearer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = fold(monkeypatch, bend=1.0)
    policy = SimpleNamespace(exact=1e-12)
    two = arm(2, policy=policy, free=(1,))
    rows = np.array([[0.01, 0.9999], [-0.01, 0.9999]])
    trial = np.full((2, 1), 0.9996)
    row, near = solution_search._next_rows(two, np.zeros((2, 4, 4)), rows, trial)
    np.testing.assert_allclose(row, [[0.02, 0.9996], [-0.02, 0.9996]])
    assert near.all() and not asked


@pytest.mark.parametrize(("bend", "at"), [(1.0, 1.0001), (100.0, 0.9999)])
def test_beyond_a_fold_and_far_from_one_the_closed_form_is_asked(
    monkeypatch: pytest.MonkeyPatch, bend: float, at: float
) -> None:
    asked = fold(monkeypatch, bend)
    policy = SimpleNamespace(exact=1e-12)
    two = arm(2, policy=policy, free=(1,))
    _, near = solution_search._next_rows(
        two, np.zeros((1, 4, 4)), np.array([[0.0, 1.0]]), np.full((1, 1), at)
    )
    assert asked == [1] and near.tolist() == [at < 1.0]


@pytest.mark.parametrize("fold", [0, 1])
def test_a_branch_goes_as_the_root_of_the_value_beside_a_fold(fold: int) -> None:
    ends, folds = np.array([[0.0, 1.0]]), np.array([[fold == 0, fold == 1]])

    def row(x: float) -> list[float]:
        return [-float(np.sqrt(x if fold == 0 else 1.0 - x)), x]

    reach = Reach(ends, np.array([[row(0.0), row(1.0)]]), folds)
    two = arm(2)
    for begin, trial in ((float(fold), 0.3), (0.5, 0.2), (0.5, 0.9), (0.4, 0.4)):
        found = reach.ahead(two, np.array([begin]), np.array([row(begin)]), np.array([trial]))
        assert found[0, 0] == pytest.approx(row(trial)[0], abs=1e-12)
