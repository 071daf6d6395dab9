"""Rows on the right turns and without repetitions: floats and arrays follow the same rule."""

from __future__ import annotations

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.elimination.routine import runtime_policy
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arm.chain_kinematics import chain_of
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arm.whole_pose import PoseTask
from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.rows.row_placement import (
    apart,
    distinct,
    in_order,
    is_new,
    place_rows,
    place_rows_batch,
    rows_at_limits,
)

Array = NDArray[np.float64]


def arm() -> Arm:
    """Three turning joints, a slide, and a held joint that turns."""
    frames = np.tile(np.eye(4), (6, 1, 1))
    motions = tuple((j, j != 3, 1.0, 0.0) for j in range(5))
    return Arm(
        chain=chain_of(frames, motions, 5),
        task=PoseTask(1.0),
        policy=runtime_policy(SolvePolicy()),
        lower=(-pi, -4.0, -inf, 0.0, -inf),
        upper=(pi, 7.0, inf, 1.0, inf),
        free=(4,),
        free_joints=("held",),
        free_defaults=(0.0,),
        most=8,
        branches=lambda T, q0, held: ([], False),
        branches_batch=lambda T, q0, held: (T, T > 0.0, T > 0.0, T > 0.0, T > 0.0),
        beside=np.empty((0, 4, 4)),
        period=(WHOLE_TURN, WHOLE_TURN, WHOLE_TURN, 0.0, WHOLE_TURN),
        moving=(0, 1, 2, 3),
        together=None,
        branch_kind="number",
        elbow_end=0,
        around=None,
    )


def rows(n: int) -> Array:
    """Rows (n, 1, 5) about, on and beyond the limits."""
    rng = np.random.default_rng(11)
    q = rng.uniform(-4.0, 4.0, (n, 1, 5))
    q[:, 0, 3] = rng.uniform(-0.5, 1.5, n)
    edges = np.array([-pi, pi, pi + 1e-10, 7.0 - 2.0 * pi, -4.0 - 1e-10, 1.0 + 1e-10])
    q[::3, 0, 0], q[::3, 0, 1] = (
        rng.choice(edges[:3], len(q[::3])),
        rng.choice(edges[3:5], len(q[::3])),
    )
    q[::7, 0, 3] = edges[5]
    return q


@pytest.mark.parametrize("limits", [True, False])
@pytest.mark.parametrize("seed", [None, (2.0, 6.5, -20.0, 0.5, 9.0)])
def test_floats_and_arrays_agree(limits: bool, seed: tuple[float, ...] | None) -> None:
    q = rows(400)
    near = None if seed is None else np.tile(np.array(seed), (len(q), 1))
    together, inside, _ = place_rows_batch(arm(), q.copy(), near, limits)
    kept = 0
    for row, placed, fits in zip(q[:, 0].tolist(), together[:, 0], inside[:, 0], strict=True):
        found = place_rows(arm(), [(tuple(row), True)], seed, limits)
        assert bool(found) == fits
        if found:
            kept += 1
            assert np.abs(np.array(found[0][0]) - placed).max() < 1e-14
    assert kept == 400 if not limits else 100 < kept < 400


def test_rows_lie_on_the_limits_that_they_barely_miss() -> None:
    ((row, flag),) = place_rows(arm(), [((0.0, 0.0, 0.0, 1.0 + 1e-10, 0.0), True)], None, True)
    assert row[3] == 1.0 and flag
    assert not place_rows(arm(), [((0.0, 0.0, 0.0, 1.0 + 5e-9, 0.0), True)], None, True)


def test_turns_nearest_to_the_seed_inside_the_limits() -> None:
    row = ((0.0, 0.5, 0.5, 0.5, 0.5), False)
    ((placed, _),) = place_rows(arm(), [row], (0.0, 30.0, 30.0, 0.0, 30.0), True)
    assert placed == pytest.approx((0.0, 0.5 + 2.0 * pi, 0.5 + 10.0 * pi, 0.5, 0.5))


def test_repetitions() -> None:
    base = np.array([0.1, 3.0, -1.0, 0.5, 0.0])
    unit = np.eye(5)
    turned = base + 2.0 * pi * unit[0] + 5e-7 * unit[2]
    other, slid = base + 2e-6 * unit[1], base + 2.0 * pi * unit[3]
    q = np.array([[base, turned, other, slid, base]])
    valid = np.array([[True, True, True, True, False]])
    assert distinct(arm(), q, valid).tolist() == [[True, False, True, True, False]]
    kept = [(tuple(base.tolist()), False)]
    new = [is_new(arm(), tuple(row.tolist()), kept) for row in (turned, other, slid)]
    assert new == [False, True, True]


def test_a_repetition_of_what_is_none_is_kept() -> None:
    q = np.zeros((1, 2, 5))
    assert distinct(arm(), q, np.array([[False, True]])).tolist() == [[False, True]]


def test_long_slides_are_compared_relative_to_their_length() -> None:
    one, policy = arm(), runtime_policy(SolvePolicy())
    q = np.zeros((1, 4, 5))
    q[0, :, 3] = 0.5, 0.5 + 2.0 * policy.coincident, 50.0, 50.0 + 20.0 * policy.coincident
    assert distinct(one, q, np.ones((1, 4), dtype=bool)).tolist() == [[True, True, True, False]]
    kept = [(tuple(row), False) for row in q[0].tolist()]
    assert [is_new(one, kept[k][0], kept[k - 1 : k]) for k in (1, 3)] == [True, False]


@pytest.mark.parametrize("joint", [0, 1, 3])
def test_rows_hardly_outside_are_told_apart(joint: int) -> None:
    one = replace(arm(), lower=(-1.0, -1.5, -inf, 0.0, -inf), upper=(2.0, 1.0, inf, 1.0, inf))
    reach = one.policy.limit_reach
    row = np.array([0.3, 0.2, 0.1, 0.5, 0.0])
    for bound, sign in ((one.lower[joint], -1.0), (one.upper[joint], 1.0)):
        for turn in (0.0, 2.0 * pi, -2.0 * pi) if joint != 3 else (0.0,):
            for beyond, kind in (
                (0.5 * one.policy.limit_tolerance, "inside"),
                (0.5 * reach, "close"),
                (1.5 * reach, "out"),
            ):
                row[joint] = bound + sign * beyond + turn
                inside, close = rows_at_limits(one, [(tuple(row), True)], None, True)
                assert (len(inside), len(close)) == (kind == "inside", kind == "close")
                for (was, flag), there in close:
                    assert (
                        was == tuple(row)
                        and flag
                        and there[joint] == pytest.approx(bound, abs=1e-15)
                    )
                _, fits, near = place_rows_batch(one, row[None, None].copy(), None, True)
                assert (fits.item(), near.item()) == (kind == "inside", kind == "close")
                assert rows_at_limits(one, [(tuple(row), True)], None, False)[1] == []
                assert not place_rows_batch(one, row[None, None].copy(), None, False)[2].any()


def test_a_row_put_on_a_limit_is_on_it_to_the_last_digit() -> None:
    """By that it is told that the joint is to stay there."""
    one = replace(arm(), lower=(0.0, -4.0, -inf, 0.0, -inf))
    for beyond in np.random.default_rng(3).uniform(2e-9, 1e-6, 200):
        for turned in (0.0, -2.0 * pi):
            row = (pi + beyond + turned, 0.0, 0.0, 0.5, 0.0)
            _, close = rows_at_limits(one, [(row, False)], None, True)
            assert close[0][1][0] == pi


def test_a_row_far_outside_of_another_limit_is_not_close() -> None:
    one = replace(arm(), lower=(-1.0, -1.5, -inf, 0.0, -inf), upper=(2.0, 1.0, inf, 1.0, inf))
    for row in ((2.0 + 1e-7, 0.0, 0.0, 1.5, 0.0), (3.0, 0.0, 0.0, 1.0 + 1e-7, 0.0)):
        assert rows_at_limits(one, [(row, True)], None, True) == ([], [])
        _, inside, close = place_rows_batch(one, np.array([[row]]), None, True)
        assert not inside.any() and not close.any()


def test_rows_are_apart_where_none_repeats_another() -> None:
    turning = replace(arm(), period=(WHOLE_TURN,) * 3)
    q = np.array([[0.1, 0.2, pi], [0.1, 0.2, 0.5], [0.3, 0.2, -pi]])
    assert apart(turning, q) and apart(turning, q[:1]) and apart(turning, q[:0])
    for repeated in (q[0] + 1e-7, q[0] - 2.0 * pi, q[2] + np.array([-0.2, 4.0 * pi, 0.0])):
        assert not apart(turning, np.vstack([q, repeated]))
        assert not is_new(turning, tuple(repeated), [(tuple(row), False) for row in q.tolist()])
    assert not apart(arm(), rows(2)[:, 0])


def test_rows_within_limits_and_half_turns_stay() -> None:
    """Those that need no turn are taken as they are; what is on an edge goes the long way."""
    inside = (0.5, -3.0, 1.0, 0.5, 9.0)
    for row in (inside, (pi, *inside[1:]), (-pi, *inside[1:])):
        placed, close = rows_at_limits(arm(), [(row, True)], None, True)
        assert placed == [((pi if row[0] == -pi else row[0], *inside[1:]), True)] and not close
    unlimited, _ = rows_at_limits(arm(), [((0.5, -3.0, 4.0, 7.0, 9.0), False)], None, False)
    assert unlimited == [((0.5, -3.0, 4.0 - 2.0 * pi, 7.0, 9.0), False)]


def test_rows_of_a_continuum_crowd_no_others_out() -> None:
    """Many alike, and as many as there are places far from each other; the seed's own is among them."""
    spread = [((0.3 * k, 1.0, 0.0, 0.5, 0.0), True) for k in range(9)]
    alike = [((-1.0 + 1e-3 * k, 0.0, 0.0, 0.5, 0.0), True) for k in range(9)]
    regular = [((2.0, 0.1 * k, 0.0, 0.5, 0.0), False) for k in range(3)]
    assert in_order(arm(), alike + regular, None) == alike[:4] + regular
    assert in_order(arm(), spread + regular, None) == spread[:5] + regular
    assert in_order(arm(), alike + spread + regular, None) == alike[:4] + spread[:1] + regular
    found = in_order(arm(), alike + regular, alike[8][0])
    assert found == alike[:4:-1] + regular
    many = [((2.0, 0.1 * k, 0.0, 0.5, 0.0), False) for k in range(8)]
    assert in_order(arm(), alike + many, None) == many
