"""Where intervals of a held joint end, and in how many rounds that is found."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.held import branch_ends
from ikgen.runtime.python.held.branch_ends import BranchEnd, _interpolated, branch_end, find_ends
from ikgen.runtime.python.held.held_joint import Rows


@pytest.mark.parametrize("count", [2, 3, 4])
def test_a_zero_of_values_of_an_inverse_polynomial_is_found(count: int) -> None:
    """x is a polynomial of the value, of as many terms as there are values."""
    terms = [0.7, -0.4, 0.11, 0.05][:count]
    known = [(sum(t * y**k for k, t in enumerate(terms)), y) for y in (-1.3, 0.4, 2.1, 0.9)[:count]]
    assert _interpolated(known) == pytest.approx(0.7, abs=1e-12)


def test_values_that_are_alike_tell_nothing() -> None:
    assert _interpolated([(0.1, 0.5), (0.2, 0.5)]) == math.inf
    assert _interpolated([(0.3, 0.5)]) == 0.3


Function = Callable[[float], float]


@dataclass
class Branches:
    """In place of an arm with a held joint h: rows of one joint, each (value, how far outside its limits,
    what is positive where it is real), as functions of h."""

    rows: list[tuple[Function, Function, Function]]
    guarded: bool = True
    rounds: int = 0
    tolerance: float = 0.25
    rounded: bool = False

    @property
    def margins_tell(self) -> bool:
        return self.guarded

    @property
    def arm(self) -> Any:
        return SimpleNamespace(
            period=(0.0,),
            policy=SimpleNamespace(limit_tolerance=self.tolerance),
            rounded=self.rounded,
        )

    def at(self, _: object, T: object, held: NDArray[np.float64]) -> Rows:
        self.rounds += 1
        self.held = held
        q, _, folds = (np.array([[row[k](h) for row in self.rows] for h in held]) for k in range(3))
        return Rows(held, q[:, :, None], folds > 0.0, folds[:, :, None])

    def outside(self, *_: object) -> NDArray[np.float64]:
        return np.array([[off(h) for _, off, _ in self.rows] for h in self.held])


def found(
    branches: Branches, monkeypatch: pytest.MonkeyPatch, *ends: BranchEnd
) -> tuple[BranchEnd, ...]:
    monkeypatch.setattr(branch_ends, "rows_at", branches.at)
    monkeypatch.setattr(branch_ends, "outside", branches.outside)
    find_ends(branches, np.eye(4), list(ends), True)  # type: ignore[arg-type]
    for end in ends:
        assert 0.0 < abs(end.outer - end.inner) <= 1e-10
    return ends


def limit(branches: Branches, inner: float, outer: float, lane: int = 0) -> BranchEnd:
    """Where the limits end a row, as the samples on both sides tell it."""
    value, off, _ = branches.rows[lane]
    known = [(h, off(h) - branches.tolerance) for h in (outer, inner)]
    return BranchEnd(inner, outer, np.array([value(inner)]), lane, known, False, branches.guarded)


@pytest.mark.parametrize(("inner", "outer"), [(0.0, 0.8), (2.2, 1.1)])
def test_the_end_at_a_limit_is_found_from_either_side(
    inner: float, outer: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the row is the tolerance outside."""
    off: Function = lambda h: math.sin(2.0 * h) - 0.1  # noqa: E731
    branches = Branches(
        [(lambda h: 4.0 + h, lambda h: -1.0, lambda h: 1.0), (math.cos, off, lambda h: 1.0)]
    )
    (end,) = found(branches, monkeypatch, limit(branches, inner, outer, 1))
    root = 0.5 * math.asin(0.35)
    root = root if inner < 1.0 else 0.5 * math.pi - root
    assert end.inner == pytest.approx(root, abs=1e-10) and off(end.inner) <= 0.25 < off(end.outer)
    assert end.lane == 1 and end.q[0] == math.cos(end.inner)
    assert branches.rounds <= 7


def test_many_ends_are_found_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bent: Function = lambda h: math.expm1(12.0 * (h - 0.4))  # noqa: E731
    steep: Function = lambda h: 1e5 * (h - 0.7)  # noqa: E731
    row: Function = lambda h: 0.5 * h  # noqa: E731
    branches = Branches(
        [(row, bent, lambda h: 1.0), (lambda h: 9.0 + row(h), steep, lambda h: 1.0)], tolerance=0.0
    )
    ends = limit(branches, 0.0, 1.0), limit(branches, 0.0, 1.0, 1)
    found(branches, monkeypatch, *ends)
    assert [end.inner for end in ends] == pytest.approx([0.4, 0.7], abs=1e-10)
    assert branches.rounds <= 35


@pytest.mark.parametrize("guarded", [True, False])
def test_a_row_that_jumps_away_is_no_longer_the_branch_s(
    guarded: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    row: Function = lambda h: h if h < 0.6 else 5.0  # noqa: E731
    branches = Branches([(row, lambda h: -1.0, lambda h: 1.0)], guarded)
    (end,) = found(branches, monkeypatch, limit(branches, 0.0, 1.0))
    assert end.inner == pytest.approx(0.6, abs=1e-10) and end.inner < 0.6 <= end.outer
    assert branches.rounds <= 36


def folding(h: float) -> float:
    """What is positive where two rows are real."""
    return 0.5 - math.sinh(0.4 * h)


FOLD = math.asinh(0.5) / 0.4


def pair(guarded: bool, off: Function = lambda h: -1.0) -> Branches:
    """Two rows that meet at the fold; beyond it their real parts go on."""
    lift: Function = lambda h: 0.3 * math.sqrt(max(FOLD - h, 0.0)) * (1.0 + h * h)  # noqa: E731
    rows = [(lambda h, s=s: 0.4 + s * lift(h), off, folding) for s in (1.0, -1.0)]
    return Branches(rows, guarded)  # type: ignore[arg-type]


def fold(branches: Branches) -> BranchEnd:
    value, _, margin = branches.rows[0]
    known = [(h, -margin(h)) for h in (2.0, -0.5, 0.5)] if branches.guarded else []
    return BranchEnd(0.5, 2.0, np.array([value(0.5)]), 0, known, True, branches.guarded)


@pytest.mark.parametrize(("guarded", "rounds"), [(True, 7), (False, 35)])
def test_a_fold_is_found_by_what_is_positive_before_it_or_by_halving(
    guarded: bool, rounds: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    branches = pair(guarded)
    (end,) = found(branches, monkeypatch, fold(branches))
    assert end.inner == pytest.approx(FOLD, abs=1e-10) and folding(end.inner) > 0 >= folding(
        end.outer
    )
    assert branches.rounds <= rounds


@pytest.mark.parametrize("guarded", [True, False])
def test_a_limit_may_come_before_the_fold(guarded: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    off: Function = lambda h: math.exp(h) - 2.0  # noqa: E731
    branches = pair(guarded, off)
    (end,) = found(branches, monkeypatch, fold(branches))
    assert end.inner == pytest.approx(math.log(2.25), abs=1e-10) and not end.at_fold
    assert off(end.inner) <= 0.25 < off(end.outer) and branches.rounds <= 14


@pytest.mark.parametrize("ends", [True, False])
def test_a_row_may_move_as_far_as_it_likes_before_its_fold(
    ends: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where its lane has none beyond: where that has one, it is another branch's."""
    row: Function = lambda h: 9.0 * math.sqrt(abs(FOLD - h))  # noqa: E731
    branches = Branches([(row, lambda h: -1.0, folding if ends else lambda h: 1.0)])
    held, off = [0.0, FOLD - 0.1, FOLD + 0.4], [[0], [-1]]
    joint: Any = SimpleNamespace(arm=branches.arm, margins_tell=True, guarded=True)
    end = branch_end(joint, tracks_of(branches, held, off), np.array(off), (1, 0), (2, -1))
    found(branches, monkeypatch, end)
    assert (end.inner == pytest.approx(FOLD, abs=1e-10)) == ends


def tracks_of(branches: Branches, held: list[float], links: list[list[int]]) -> Any:
    rows = branches.at(None, None, np.array(held))
    off = branches.outside() - branches.tolerance
    return SimpleNamespace(rows=rows, links=np.array(links), off=off)


def test_what_is_known_of_an_end_is_of_the_samples_around_it() -> None:
    """A limit: how far the row is outside; a fold: what is positive before it."""
    held, on = [0.0, 0.5, 1.0, 1.5], [[0, 1], [0, 1], [0, 1]]
    branches = pair(guarded=True, off=lambda h: h - 0.6)
    tracks, before = tracks_of(branches, held, on), np.array(on)
    joint: Any = SimpleNamespace(arm=branches.arm, margins_tell=True, guarded=True)
    end = branch_end(joint, tracks, before, (1, 0), (2, 0))
    assert (end.inner, end.outer, end.lane, end.there) == (0.5, 1.0, 0, None)
    assert not end.at_fold and end.stays
    assert not branch_end(joint, tracks, before, (1, 0), (2, 1)).stays  # another lane goes on
    assert end.known == [(h, pytest.approx(h - 0.85)) for h in (1.5, 0.0, 1.0, 0.5)]
    back = branch_end(joint, tracks, before, (2, 0), (1, 0))
    assert [h for h, _ in back.known] == [0.0, 1.5, 0.5, 1.0] and back.outer == 0.5

    end = branch_end(joint, tracks, before, (2, 1), (3, -1))
    assert end.at_fold and end.there is None and end.q[0] == branches.rows[1][0](1.0)
    assert end.known == [(h, pytest.approx(-folding(h))) for h in (0.5, 1.5, 1.0)]


def test_where_margins_do_not_tell_an_end_is_on_the_way_to_another_row() -> None:
    """At a limit to the branch's own row beyond, at a fold to the nearest that ends there too."""
    held, on = [0.0, 0.5, 1.0], [[0, 1, 2, 3], [-1, -1, 2, -1]]
    branches = pair(guarded=False)
    rows = [(lambda h, x=x: x + 0.01 * h, lambda h: -1.0, lambda h: 1.0) for x in (0.75, 0.9)]
    branches.rows += rows  # type: ignore[arg-type]
    tracks, before = tracks_of(branches, held, on), np.array(on)
    joint: Any = SimpleNamespace(arm=branches.arm, margins_tell=False, guarded=False)
    q = tracks.rows.q[:, :, 0]
    end = branch_end(joint, tracks, before, (0, 2), (1, 2))
    assert end.there is not None and end.then == 0.5 and not end.at_fold and end.known == []
    assert end.there[0] == q[1, 2]
    end = branch_end(joint, tracks, before, (1, 0), (2, -1))
    assert end.there is not None and end.then == 0.5 and end.at_fold
    assert abs(q[1, 2] - q[1, 0]) < abs(q[1, 3] - q[1, 0]) < abs(q[1, 1] - q[1, 0])
    assert end.there[0] == q[1, 3]  # the nearest goes on
    alone = np.array([[0, 1, 2, 3], [-1, 1, 2, 3]])
    tracks.links = alone
    assert branch_end(joint, tracks, alone, (1, 0), (2, -1)).there is None
    joint.arm.rounded = True  # the one that it meets may be found farther
    end = branch_end(joint, tracks, alone, (1, 0), (2, -1))
    assert end.there is not None and end.there[0] == q[1, 2]
