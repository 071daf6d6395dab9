"""Values of several held joints that go together to a better row."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.held import values_descent
from ikgen.runtime.python.held.values_descent import _model_minimum, _ways, descended_rows

Array = NDArray[np.float64]
WANTED: Any = ("near", (), ())


def descended(
    monkeypatch: pytest.MonkeyPatch,
    cost: Any,
    starts: list[list[float]],
    high: float = np.inf,
    step: float = 0.05,
) -> tuple[Array, Array, int]:
    """From values, which are the rows, that are cut off above; and how many sweeps it took."""
    sweeps: list[int] = []

    def tried(
        arm: Any, T: Array, preference: Any, limits: bool, held: Array, rows: Array, trials: Array
    ) -> tuple[Array, Array, Array]:
        sweeps.append(len(trials))
        trials = np.minimum(trials, high)
        return trials, trials, cost(trials)

    monkeypatch.setattr(values_descent, "tried_rows", tried)
    monkeypatch.setattr(
        values_descent, "preference_costs", lambda arm, preference, q, limits: (q, cost(q), q)
    )
    held = np.array(starts)
    rows, best = descended_rows(
        SimpleNamespace(), np.eye(4), held, held.copy(), np.full(held.shape, step), WANTED, True
    )  # fmt: skip
    return rows, best, len(sweeps) // 2


def valley(q: Array) -> Array:
    """A hundred times longer than wide, aslant the values."""
    return np.asarray((q[..., 0] + q[..., 1]) ** 2 + 1e-4 * (q[..., 0] - q[..., 1]) ** 2)


def test_a_narrow_valley_is_followed_to_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    rows, cost, sweeps = descended(monkeypatch, valley, [[0.5, -0.4], [-1.0, 0.9]])
    np.testing.assert_allclose(rows, 0.0, atol=1e-6)
    assert cost.max() < 1e-12 and sweeps < 45


def test_three_values_go_together(monkeypatch: pytest.MonkeyPatch) -> None:
    A = np.array([[4.0, 1.9, 0.3], [1.9, 1.0, 0.1], [0.3, 0.1, 2.0]])

    def bowl(q: Array) -> Array:
        off = q - np.array([0.3, -0.1, 0.2])
        return np.asarray(np.einsum("...i,ij,...j", off, A, off) + 0.1 * np.cos(3.0 * q[..., 0]))

    rows, cost, _ = descended(monkeypatch, bowl, [[0.0, 0.0, 0.0]])
    beside = rows[0] + 1e-3 * np.concatenate([np.eye(3), -np.eye(3)])
    assert (bowl(beside) > cost[0]).all()


def test_a_limit_is_gone_along(monkeypatch: pytest.MonkeyPatch) -> None:
    rows, _, _ = descended(
        monkeypatch, lambda q: (q[..., 0] - 1.0) ** 2 + (q[..., 1] - 0.1) ** 2, [[0.0, 0.0]], 0.2
    )
    np.testing.assert_allclose(rows[0], [0.2, 0.1], atol=1e-6)


def test_a_limit_of_another_joint_is_gone_along(monkeypatch: pytest.MonkeyPatch) -> None:
    """It runs aslant of the values, and both lead outside of it, or to worse."""

    def cost(q: Array) -> Array:
        aside = q[..., 1] - 0.7 * q[..., 0]
        return np.where(aside >= 0.0, (q[..., 0] - 0.3) ** 2 + (q[..., 1] + 0.2) ** 2, np.inf)

    starts = [[-0.4, 0.0], [-0.35, -0.2449], [-0.1, 0.4]]
    rows, best, _ = descended(monkeypatch, cost, starts)
    foot = 0.16 / 1.49
    np.testing.assert_allclose(best, cost(np.array([foot, 0.7 * foot])), rtol=1e-3)
    assert (rows[:, 1] >= 0.7 * rows[:, 0]).all()


def test_an_edge_that_has_no_slope_is_come_to(monkeypatch: pytest.MonkeyPatch) -> None:
    """As of smallest singular values where two of them are one."""
    rows, _, _ = descended(
        monkeypatch, lambda q: np.abs(q[..., 0] - 0.123) + (q[..., 1] - 0.1) ** 2, [[0.0, 0.0]]
    )
    np.testing.assert_allclose(rows[0], [0.123, 0.1], atol=1e-5)


def test_a_quadratic_is_least_where_its_model_says() -> None:
    ways, middle = _ways(2), np.zeros(2)
    H, at = np.array([[2.0, 0.6], [0.6, 1.0]]), np.array([0.7, -0.4])
    cost = lambda w: 0.5 * (w - at) @ H @ (w - at)  # noqa: E731
    costs = np.array([[cost(w), np.inf if k == 1 else cost(-w)] for k, w in enumerate(ways)])
    found = _model_minimum(np.array([cost(middle), cost(middle)]), costs, 2)
    np.testing.assert_allclose(found, [at, [0.0, 0.0]], atol=1e-12)


def test_no_model_without_a_minimum() -> None:
    """Saddles and ridges have none, and far ones are gone to by a few steps."""
    ways = _ways(2)
    saddle = ways[:, 0] ** 2 - ways[:, 1] ** 2
    level = 1e-320 * ways[:, 0] ** 2 + ways[:, 1] ** 2
    flat = 1e-3 * ((ways[:, 0] - 99.0) ** 2 - 99.0**2) + ways[:, 1] ** 2
    found = _model_minimum(np.zeros(4), np.stack([saddle, level, 0.0 * saddle, flat], axis=1), 2)
    np.testing.assert_allclose(found, [*[[0.0, 0.0]] * 3, [4.0, 0.0]], atol=1e-9)
