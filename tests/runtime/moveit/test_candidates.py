"""Rows that the MoveIt plugin offers, and values of held joints that it tries, for a hand-written arm."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.moveit_group_program import compiled_beside_group
from tests.support.routines import feed

Array = NDArray[np.float64]

CODE = r"""
#include <cstdio>
#include <cstdlib>
#include "ikgen_moveit/candidates.hpp"
#include "ikgen_moveit/free_sequence.hpp"
using namespace ikgen_moveit;
void read(double* x, int n) {
  for (int i = 0; i < n; ++i)
    if (std::scanf("%lf", x + i) != 1) std::exit(1);
}
int main() {
  double kind, x[10];
  read(&kind, 1);
  if (kind == 0.0) {  // position, seed, reach, lower limits, upper limits
    read(x, 10);
    Query query{Eigen::Isometry3d::Identity(), {x[2], x[3]}, {x[4], x[5]}, {{x[6], x[7]}, {x[8], x[9]}}};
    query.pose.translation() << x[0], x[1], 0.0;
    for (const Joints& q : candidates(query, {3.0, 40.0})) std::printf("%.17g %.17g\n", q[0], q[1]);
    return 0;
  }
  if (kind == 3.0) {  // a window, the turn, the step, how many intervals, then these
    struct Interval { double low, high; } next;
    std::vector<Interval> intervals;
    read(x, 6);
    for (int i = 0; i < static_cast<int>(x[5]); ++i) {
      read(&next.low, 1), read(&next.high, 1);
      intervals.push_back(next);
    }
    const Window window = {x[0], x[1], x[2]};
    for (const double one : interval_values(intervals, window, x[3], x[4])) std::printf("%.17g\n", one);
    return 0;
  }
  read(x, 8);  // two windows, the resolution, how many
  const Windows windows = {{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}}};
  FreeSequence sequence(windows, x[6]);
  std::vector<FreeValues> found = grid(windows, x[6]);
  if (kind == 1.0) found.clear();
  for (int i = 0; i < static_cast<int>(x[7]); ++i) found.push_back(sequence.next());
  for (const FreeValues& one : found) std::printf("%.17g %.17g\n", one[0], one[1]);
}
"""
ROWS, SEQUENCE, GRID, INTERVALS = 0.0, 1.0, 2.0, 3.0


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled_beside_group(CODE, tmp_path_factory.mktemp("candidates"))


def candidates(
    program: Path,
    seed: tuple[float, float],
    *,
    reach: tuple[float, float] = (math.inf, math.inf),
    lower: tuple[float, float] = (-10.0, -10.0),
    upper: tuple[float, float] = (10.0, 10.0),
) -> list[list[float]]:
    """Rows at the position (0.5, -0.25): as the solver gives them, (0.5, 1), (1.5, 3.04), (-0.25, 1.5),
    (0.5, 1.25), (6.5, -1) and (0.5, 1 + 4 (s - 0.5)) with the seed's first value s."""
    return feed(program, [ROWS, 0.5, -0.25, *seed, *reach, *lower, *upper])


def test_rows_come_by_what_the_joints_move_in_all(program: Path) -> None:
    found = candidates(program, (0.5, 1.1))
    assert found == [[0.5, 1.0], [0.5, 1.0], [0.5, 1.25], [-0.25, 1.5], [1.5, 3.04], [6.5, -1.0]]


def test_limits_and_reach_leave_rows_out_by_round_off_none(program: Path) -> None:
    bounded = candidates(program, (0.5, 1.1), lower=(0.5, -10.0), upper=(2.0, 1.25 - 0.9e-9))
    assert bounded == [[0.5, 1.0], [0.5, 1.0], [0.5, 1.25 - 0.9e-9]]
    assert len(candidates(program, (0.5, 1.1), upper=(2.0, 1.25 - 1.1e-9), lower=(0.5, -9.0))) == 2
    near = candidates(program, (0.5, 1.1), reach=(0.0, 0.15 - 0.9e-9))
    assert near == [[0.5, 1.0], [0.5, 1.0], [0.5, 1.25]]
    assert len(candidates(program, (0.5, 1.1), reach=(0.0, 0.15 - 1.1e-9))) == 2


def test_turning_joints_come_inside_by_the_fewest_turns(program: Path) -> None:
    """The second joint is a slide here: no turn is its period."""
    turn = 2.0 * math.pi
    for lower, upper, expected in (
        (-1.0, 2.0, 6.5 - turn), (6.6, 20.0, 6.5 + turn), (-20.0, 0.1, 6.5 - 2.0 * turn), (7.0, 12.0, None),
    ):  # fmt: skip
        found = candidates(program, (0.5, 1.1), lower=(lower, -1.0), upper=(upper, -0.5))
        assert found == ([] if expected is None else [[pytest.approx(expected, abs=1e-14), -1.0]])
    assert candidates(program, (0.5, 1.1), lower=(-9.0, 2.0), upper=(9.0, 2.9)) == []


WINDOWS = [-1.0, 0.5, 2.0, 0.0, 0.0, 0.4]


def test_values_begin_with_the_seeds_and_fill_the_windows_at_the_resolution(program: Path) -> None:
    """3 x 0.4 at a resolution of 0.1 are 120 cells."""
    found = np.array(feed(program, [SEQUENCE, *WINDOWS, 0.1, 1200.0]))
    assert found[0].tolist() == [0.5, 0.0]
    low, start, high = np.reshape(WINDOWS, (2, 3)).T
    assert (found >= low).all() and (found <= high).all()
    share = np.abs((found - start) / np.where(found < start, start - low, high - start)).max(axis=1)
    steps = np.arange(120)
    assert (share[:120] <= np.sqrt(steps / 120) + 1e-12).all()  # ever further
    for count, cells in ((240, 4), (1200, 12)):
        part = (found[:count] - low) / (high - low)
        filled = np.unique(np.floor(cells * part).astype(int), axis=0)
        assert len(filled) == cells**2  # ever denser


def test_a_window_of_one_value_is_kept(program: Path) -> None:
    found = feed(program, [SEQUENCE, 1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.1, 50.0])
    assert {q for q, _ in found} == {1.0} and len({x for _, x in found}) == 50


def test_grids_are_multiples_of_the_resolution_from_the_seed(program: Path) -> None:
    found = feed(program, [GRID, *WINDOWS, 0.25, 0.0])
    first = [-1.0 + 0.25 * k for k in range(13)]
    assert found == [[x, y] for x in first for y in (0.0, 0.25)]
    assert feed(program, [GRID, *WINDOWS, 9.0, 0.0]) == [[0.5, 0.0]]


def interval_values(
    program: Path,
    window: tuple[float, float, float],
    *intervals: tuple[float, float],
    turn: float = 0.0,
    step: float = 0.25,
) -> list[float]:
    ends = [end for interval in intervals for end in interval]
    found = feed(program, [INTERVALS, *window, turn, step, len(intervals), *ends])
    return [value for (value,) in found]


def test_intervals_give_the_nearest_value_a_step_inside_then_middles_then_ends(
    program: Path,
) -> None:
    window = (-8.0, 1.0, 8.0)
    assert interval_values(program, window, (4.0, 6.0)) == [4.25, 5.0, 4.0, 6.0]
    assert interval_values(program, window, (-3.0, 7.0)) == [1.0, 2.0, -3.0, 7.0]
    assert interval_values(program, window, (4.0, 4.125)) == [4.0625, 4.0625, 4.0, 4.125]
    assert interval_values(program, window, (4.0, 4.0)) == [4.0] * 4
    several = interval_values(program, window, (4.0, 6.0), (-3.0, -1.0))
    assert several == [-1.25, 4.25, -2.0, 5.0, -3.0, -1.0, 4.0, 6.0]
    assert interval_values(program, window) == []


def test_of_intervals_only_what_the_window_has_counts(program: Path) -> None:
    window = (0.0, 1.0, 2.0)
    assert interval_values(program, window, (-5.0, -1.0), (2.1, 3.0)) == []
    assert interval_values(program, window, (1.5, 9.0)) == [1.75, 1.75, 1.5, 2.0]
    assert interval_values(program, window, (2.0 + 0.9e-9, 3.0))  # round-off leaves none out
    assert interval_values(program, window, (2.0 + 1.1e-9, 3.0)) == []
    endless = (-math.inf, 1.0, math.inf)
    assert interval_values(program, endless, (90.0, 92.0)) == [90.25, 91.0, 90.0, 92.0]


def test_intervals_stand_for_those_that_are_turns_away(program: Path) -> None:
    once = interval_values(program, (18.0, 20.0, 22.0), (-3.0, -2.0), turn=8.0)
    assert once == [21.25, 21.5, 21.0, 22.0]
    twice = interval_values(program, (10.0, 20.0, 26.0), (-3.0, -2.0), turn=8.0)
    assert twice == [21.25, 13.75, 21.5, 13.5, 21.0, 22.0, 13.0, 14.0]
    assert interval_values(program, (15.0, 17.0, 20.0), (-3.0, -2.0), turn=8.0) == []
