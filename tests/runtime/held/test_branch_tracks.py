"""What may happen to rows between two samples of a held joint: limits, and ways to folds."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.held import branch_tracks
from ikgen.runtime.python.held.branch_tracks import (
    _SAFETY,
    _hidden_folds,
    _limit_crossings,
    _reach,
    _row_bends,
    tracked,
)
from ikgen.runtime.python.held.held_joint import Rows

ARM = SimpleNamespace(
    most=2,
    moving=(0,),
    lower=np.array([-1.0]),
    upper=np.array([3.0]),
    period=(WHOLE_TURN,),
    policy=SimpleNamespace(limit_tolerance=1e-9),
    rounded=False,
)


@pytest.mark.parametrize(
    ("start", "change", "bend", "dead", "count"),
    [
        (1.2, 0.3, 0.01, False, 0),  # inside at both ends
        (2.9, 0.3, 0.01, False, 1),  # out by one limit
        (2.9 - 2.0 * math.pi, 0.3, 0.01, False, 1),  # the same on another turn
        (3.5, 0.3, 0.01, True, 0),  # outside all over
        (2.98, 0.04, 0.03, False, 2),  # bent so much that it may go out and come back
        (2.9, 0.05, 0.2, False, 2),  # inside at both ends, and may be out between them
        (-1.3, 0.2, 0.01, True, 0),
        (3.2, 1.9, 0.01, True, 0),  # outside, past the far side of the turn
    ],
)
def test_limits_that_may_be_crossed(
    start: float, change: float, bend: float, dead: bool, count: int
) -> None:
    linked = np.ones((1, 1), dtype=bool)
    q, way, off = (np.full((1, 1, 1), x) for x in (start, change, bend))
    found = _limit_crossings(ARM, q, way, off, linked, True)
    assert bool(found[0][0, 0]) == dead
    if not dead:
        assert found[1][0, 0] == count
    free = _limit_crossings(ARM, q, way, off, linked, False)
    assert not free[0].any() and not free[1].any()


@pytest.mark.parametrize("where", [0, 1])
def test_the_way_to_a_fold_grows_as_the_root_of_the_distance(where: int) -> None:
    """q - q_fold = sqrt(h - h_fold), the fold at the far end of the cell: its own way over the other's."""
    own, beside = np.array([0.2, 0.5]), np.array([0.3, 0.1])
    reach = _reach(own, beside, where)
    assert reach[-1 if where else 0] == 1.0
    shares = np.sqrt(own) / (np.sqrt(own + beside) - np.sqrt(own))
    most = reach[:-1] if where else reach[1:]
    assert (most >= shares).all() and (most <= _SAFETY * shares).all()


HELD = np.array([0.0, 0.1, 0.3, 0.35, 0.6, 0.7])
FREE = SimpleNamespace(period=(0.0, 0.0))


def rows_of(*branches: list[Callable[[float], float]], real: Any = None, folds: Any = None) -> Rows:
    """Rows over `HELD`, each given by its joints' values."""
    q = np.array([[[joint(h) for joint in row] for row in branches] for h in HELD])
    there = np.ones(q.shape[:2], dtype=bool) if real is None else np.array(real, dtype=bool)
    margins = np.full((*there.shape, 1), 1.0) if folds is None else np.array(folds)[..., None]
    return Rows(HELD, q, there, margins)


def test_bends_are_bounded_by_second_differences() -> None:
    """Of a parabola's bend over a cell, c w^2 / 4, four times as much; of a straight line nothing."""
    line, bent = (lambda h: 1.0 + 2.0 * h), (lambda h: 0.3 - h + 5.0 * h * h)
    rows = rows_of([line, bent], [bent, line])
    straight = np.tile([0, 1], (5, 1))
    q, change, bend = _row_bends(FREE, rows, straight)
    width = np.diff(HELD)
    np.testing.assert_array_equal(q, rows.q[:-1])
    np.testing.assert_allclose(change, np.diff(rows.q, axis=0))
    np.testing.assert_allclose(bend[:, 0, 1], _SAFETY * 5.0 * width**2 / 4.0)
    np.testing.assert_allclose(bend[:, 1, 0], _SAFETY * 5.0 * width**2 / 4.0)
    assert bend[:, 0, 0].max() < 1e-12 and bend[:, 1, 1].max() < 1e-12
    swapped = Rows(HELD, rows.q.copy(), rows.real, rows.folds)
    swapped.q[3:] = swapped.q[
        3:, ::-1
    ]  # the same rows, from the fourth sample on in the other order
    links = straight.copy()
    links[2] = [1, 0]
    np.testing.assert_allclose(_row_bends(FREE, swapped, links)[2][:3], bend[:3])
    np.testing.assert_allclose(_row_bends(FREE, swapped, links)[2][3:], bend[3:, ::-1])


def test_the_larger_of_the_bends_on_both_sides_counts() -> None:
    kink: Callable[[float], float] = lambda h: 8.0 * max(h - 0.3, 0.0)  # noqa: E731
    zero: Callable[[float], float] = lambda h: 0.0  # noqa: E731
    bend = _row_bends(FREE, rows_of([kink, zero]), np.zeros((5, 1), dtype=int))[2][:, 0, 0]
    width = np.diff(HELD)
    there = _SAFETY * 8.0 / (width[1] + width[2]) * width**2 / 4.0
    np.testing.assert_allclose(bend, [0.0, there[1], there[2], 0.0, 0.0], atol=1e-12)


def test_a_row_without_neighbours_may_bend_as_far_as_it_goes() -> None:
    row: Callable[[float], float] = lambda h: -2.0 * h  # noqa: E731
    links = np.array([[-1], [-1], [0], [-1], [-1]])
    bend = _row_bends(FREE, rows_of([row, row]), links)[2][:, 0, 0]
    assert bend[2] == pytest.approx(2.0 * 0.05)


@pytest.mark.parametrize(
    ("margin", "real", "cells"),
    [
        (lambda h: 1.0 + h, True, []),
        (
            lambda h: 40.0 * (h - 0.2) * (h - 0.22),
            True,
            [1, 3],
        ),  # below 0 between two samples, or maybe
        (lambda h: -40.0 * (h - 0.2) * (h - 0.22), False, [1, 3]),  # and above
        (lambda h: -1.0 - h, False, []),
    ],
)
def test_rows_that_may_come_and_go_between_samples(
    margin: Callable[[float], float], real: bool, cells: list[int]
) -> None:
    zero: Callable[[float], float] = lambda h: 0.0  # noqa: E731
    folds = [[margin(h)] for h in HELD]
    rows = rows_of([zero, zero], real=np.full((6, 1), real), folds=folds)
    none, nowhere = np.zeros((5, 1), dtype=bool), np.zeros(5, dtype=bool)
    found = _hidden_folds(rows, none, nowhere)
    assert np.flatnonzero(found[:, 0]).tolist() == cells
    if real:
        assert not _hidden_folds(rows, ~none, nowhere).any()
    nothing = Rows(HELD, rows.q, rows.real, rows.folds[:, :, :0])
    assert not _hidden_folds(nothing, none, nowhere).any()


def test_rows_that_margins_promise_may_come_and_go_in_the_cells_that_are_named() -> None:
    """Of a rounded arm: it has not what its closed form has, and may have it between two samples."""
    zero: Callable[[float], float] = lambda h: 0.0  # noqa: E731
    for margin, likely in ((1.0, True), (-1.0, False)):
        rows = rows_of([zero], real=np.zeros((6, 1), dtype=bool), folds=[[margin] for _ in HELD])
        for named in (np.arange(5) % 2 == 0, np.zeros(5, dtype=bool)):
            found = _hidden_folds(rows, np.zeros((5, 1), dtype=bool), named)[:, 0]
            assert found.tolist() == (named & likely).tolist()


def curved(h: float) -> float:
    return 0.2 + 0.5 * h - 0.3 * h * h


def joint_of(
    monkeypatch: pytest.MonkeyPatch,
    branches: Callable[[float], list[tuple[float, float]]],
    **more: Any,
) -> Any:
    """A joint whose rows at h are (value, what is positive where it is real)."""

    def at(joint: object, T: object, held: NDArray[np.float64]) -> Rows:
        found = np.array([branches(h) for h in held])
        return Rows(held, found[:, :, :1], found[:, :, 1] > 0.0, found[:, :, 1:])

    monkeypatch.setattr(branch_tracks, "rows_at", at)
    return SimpleNamespace(arm=ARM, **{"guarded": True, "margins_tell": True, **more})


def test_smooth_rows_need_no_more_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    for guarded, count in ((True, 65), (False, 513)):
        joint = joint_of(monkeypatch, lambda h: [(curved(h), 1.0)], guarded=guarded)
        tracks = tracked(joint, np.eye(4), -1.0, 1.0, True)
        assert len(tracks.rows.held) == count and (tracks.links == 0).all()
        assert tracks.least == pytest.approx(2e-5)
        assert tracks.inside.all() and tracks.rows.held[0] == -1.0 and tracks.rows.held[-1] == 1.0


def test_a_quick_turn_a_fold_and_a_limit_are_closed_in_on(monkeypatch: pytest.MonkeyPatch) -> None:
    quick = joint_of(monkeypatch, lambda h: [(0.3 * math.tanh(400.0 * (h - 0.123)), 1.0)])
    held = tracked(quick, np.eye(4), -1.0, 1.0, False).rows.held
    widths = np.diff(held)
    assert widths[np.abs(held[:-1] - 0.123) < 3e-3].max() < 4e-3 and 65 < len(held) < 130

    def folding(h: float) -> list[tuple[float, float]]:
        lift = math.sqrt(max(0.4 - h, 0.0))
        return [(0.5 + 0.2 * lift, 0.4 - h), (0.5 - 0.2 * lift, 0.4 - h)]

    tracks = tracked(joint_of(monkeypatch, folding), np.eye(4), -1.0, 1.0, True)
    held, real = tracks.rows.held, tracks.rows.real
    at = int((held <= 0.4).sum()) - 1
    assert held[at + 1] - held[at] <= 2e-3 and real[: at + 1].all() and not real[at + 1 :].any()
    assert (tracks.links[:at] == [0, 1]).all() and (tracks.links[at:] == -1).all()

    def leaving(h: float) -> list[tuple[float, float]]:
        return [(3.0 + 1e-9 + 0.5 * (h - 0.31), 1.0)]

    tracks = tracked(joint_of(monkeypatch, leaving), np.eye(4), -1.0, 1.0, True)
    assert len(tracks.rows.held) == 65  # one crossing of one limit: nothing to halve
    np.testing.assert_array_equal(tracks.inside[:, 0], tracks.rows.held <= 0.31)
    np.testing.assert_allclose(tracks.off[-1, 0], 0.5 * 0.69, atol=1e-9)


def test_rows_that_come_and_go_without_end_are_not_looked_at_without_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As rounding leaves them where an elbow is stretched at every value of the held joint."""

    def straying(h: float) -> list[tuple[float, float]]:
        return [(curved(h), math.sin(1e7 * h)), (curved(h) + 0.01, math.cos(2.7e7 * h))]

    tracks = tracked(joint_of(monkeypatch, straying), np.eye(4), -1.0, 1.0, True)
    held = tracks.rows.held
    assert 1000 < len(held) < 1300 and tracks.least == pytest.approx(2e-3)
    monkeypatch.setattr(branch_tracks, "_FINE", 1000)
    more = tracked(joint_of(monkeypatch, straying), np.eye(4), -1.0, 1.0, True).rows.held
    assert len(more) > 2.0 * len(held)


def test_a_row_that_may_touch_a_limit_twice_is_looked_at_closely(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def touching(h: float) -> list[tuple[float, float]]:
        return [(3.0 + 1e-5 - 2.0 * (h - 0.317) ** 2, 1.0)]

    tracks = tracked(joint_of(monkeypatch, touching), np.eye(4), -1.0, 1.0, True)
    outside = np.flatnonzero(~tracks.inside[:, 0])
    ends = 0.317 - math.sqrt(5e-6), 0.317 + math.sqrt(5e-6)
    held = tracks.rows.held
    assert len(outside) and ends[0] <= held[outside[0]] and held[outside[-1]] <= ends[1]
    assert len(held) < 130


def test_a_row_that_comes_to_a_limit_is_inside_and_crosses_it_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    exact = SimpleNamespace(
        most=1, moving=(0,), lower=np.array([-1.0]), upper=np.array([1.0]), period=ARM.period,
        policy=SimpleNamespace(limit_tolerance=0.0), rounded=False,
    )  # fmt: skip
    linked = np.ones((1, 1), dtype=bool)
    for start, change in ((0.5, 0.5), (1.0, -0.5), (-1.0, 0.5), (1.0, 0.5)):
        q, way, off = (np.full((1, 1, 1), x) for x in (start, change, 0.0))
        dead, count = _limit_crossings(exact, q, way, off, linked, True)
        assert not dead[0, 0] and count[0, 0] == 1
    joint = joint_of(monkeypatch, lambda h: [(0.5 + 0.5 * h, 1.0)])
    joint.arm = exact
    tracks = tracked(joint, np.eye(4), -1.0, 1.0, True)
    assert tracks.off[-1, 0] == 0.0 and tracks.inside.all() and len(tracks.rows.held) == 65


def test_rows_that_each_of_two_margins_takes_from_one_end_may_be_between() -> None:
    zero: Callable[[float], float] = lambda h: 0.0  # noqa: E731
    rows = rows_of([zero], real=np.zeros((6, 1), dtype=bool))
    folds = np.array([[[h - 0.2, 0.22 - h]] for h in HELD])
    none, nowhere = np.zeros((5, 1), dtype=bool), np.zeros(5, dtype=bool)
    found = _hidden_folds(Rows(HELD, rows.q, rows.real, folds), none, nowhere)
    assert np.flatnonzero(found[:, 0]).tolist() == [1]


def test_margins_are_bounded_by_second_differences_between_samples_that_are_not_even() -> None:
    """Of a parabola by its bend over a cell, c w^2 / 4, four times as much."""
    zero: Callable[[float], float] = lambda h: 0.0  # noqa: E731
    rng, width = np.random.default_rng(2), np.diff(HELD)
    none, nowhere = np.zeros((5, 1), dtype=bool), np.zeros(5, dtype=bool)
    flagged = 0
    for c, a, e in zip(
        *rng.uniform([[0.5], [0.0], [1e-4]], [[9.0], [0.7], [0.1]], (3, 60)), strict=True
    ):
        f = c * (HELD - a) ** 2 + e
        found = _hidden_folds(rows_of([zero], folds=f[:, None]), none, nowhere)[:, 0]
        bound = _SAFETY * c * width**2 / 4.0
        np.testing.assert_array_equal(found, np.minimum(f[:-1], f[1:]) < bound)
        flagged += int(found.sum())
    assert 30 < flagged < 270
