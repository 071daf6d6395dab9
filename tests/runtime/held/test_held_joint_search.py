"""Where the search over a held joint starts in an interval."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ikgen.runtime.python.held import held_joint_search
from ikgen.runtime.python.held.branch_ends import BranchEnd
from ikgen.runtime.python.held.held_joint_search import _best_of_each, _starts
from ikgen.runtime.python.held.self_motion import Piece

HELD = np.array([0.0, 0.2, 0.4, 0.6, 0.8])


def end(inner: float) -> BranchEnd:
    return BranchEnd(inner, inner + 1e-10, np.array([inner]), 0, [], False, False, inner, False)


def started(
    monkeypatch: pytest.MonkeyPatch,
    cost: Any,
    low: BranchEnd | float,
    high: BranchEnd | float,
    samples: tuple[tuple[int, int], ...] = ((1, 0), (2, 0), (3, 0)),
) -> list[tuple[float, float]]:
    """Values at which the search starts, and how far it may step first, where a row's value is the held
    joint's."""
    monkeypatch.setattr(
        held_joint_search, "preference_costs", lambda arm, wanted, q, limits: (q, cost(q[..., 0]), q > 0.0)
    )  # fmt: skip
    tracks: Any = SimpleNamespace(rows=SimpleNamespace(held=HELD, q=HELD[:, None, None]))
    piece = Piece(low, high, 0, samples)
    joint: Any = SimpleNamespace(arm=None)
    starts = _starts(tracks, piece, ("near", (), ()), joint, True)
    assert all(row[0] == value for value, row, *_ in starts)
    assert all(reach == piece.reach() for *_, reach, _ in starts)
    return [(value, step) for value, _, step, _, _ in starts]


def test_the_ends_of_an_interval_count(monkeypatch: pytest.MonkeyPatch) -> None:
    found = started(monkeypatch, lambda x: x, end(0.13), end(0.67))
    assert found == [(0.13, pytest.approx(0.035))]
    found = started(monkeypatch, lambda x: -x, end(0.13), end(0.67))
    assert found == [(0.67, pytest.approx(0.035))]


def test_a_branch_goes_no_farther_than_its_ends() -> None:
    """As far as these are known, and beyond the range where that ends before."""
    assert Piece(end(0.13), end(0.67), 0, ()).reach() == (0.13, 0.67)
    assert Piece(0.2, 0.6, 0, ()).reach() == (-np.inf, np.inf)
    sliver = replace(end(0.13), outer=0.12)  # which was not looked for
    assert Piece(sliver, 0.6, 0, ()).reach() == (0.12, np.inf)


def test_ends_of_the_range_are_samples_themselves(monkeypatch: pytest.MonkeyPatch) -> None:
    assert [v for v, _ in started(monkeypatch, lambda x: x, 0.2, 0.6)] == [0.2]
    assert [v for v, _ in started(monkeypatch, lambda x: -x, 0.2, 0.6)] == [0.6]


def test_samples_better_than_those_beside_them_are_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    found = started(monkeypatch, lambda x: (x - 0.45) ** 2, end(0.13), end(0.67))
    assert found == [(0.4, pytest.approx(0.1))]
    found = started(monkeypatch, lambda x: -((x - 0.45) ** 2), end(0.13), end(0.67))
    assert [v for v, _ in found] == [0.13, 0.67]
    alike = started(monkeypatch, lambda x: 0.0 * x, end(0.13), end(0.67))
    assert [v for v, _ in alike] == [0.13, 0.2, 0.4, 0.6, 0.67]
    assert [step for _, step in alike] == pytest.approx([0.035, 0.1, 0.1, 0.1, 0.035])


def test_about_a_lone_sample_the_search_starts_close(monkeypatch: pytest.MonkeyPatch) -> None:
    """An interval at whose ends the range ends as well, and one sample in it."""
    lone = started(monkeypatch, lambda x: x, 0.2, 0.2, ((1, 0),))
    assert lone == [(0.2, pytest.approx(5e-4))]


def test_of_each_interval_the_best_row_is_taken() -> None:
    group, cost = np.array([0, 0, 2, 2, 1]), np.array([3.0, 1.0, 0.5, 0.7, 2.0])
    assert _best_of_each(group, cost).tolist() == [2, 1, 4]
    assert _best_of_each(group[:0], cost[:0]).tolist() == []
