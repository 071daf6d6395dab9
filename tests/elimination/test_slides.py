"""Six joints of which some slide: complete and exact for every mix, at special poses too."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.multi_start import apart, searched

from ikgen.elimination import EliminationPlan, choose_plan
from ikgen.elimination.elimination_table import finder
from ikgen.elimination.loop_frames import forward, jacobian
from ikgen.elimination.plan import eliminations
from ikgen.elimination.routine import Plan, six_joints_batch
from ikgen.runtime.python.elimination.general_6r import one_axis_each
from ikgen.runtime.python.rows.solution_rows import distinct_rows

Array = NDArray[np.float64]
Turning = tuple[bool, ...]
MOST = {1: 16, 2: 8, 3: 2}
MIXES = ["RRRPRR", "PRRRRR", "RPRRRR", "RRPPRR", "RPRPRR", "PRRPRR", "RPRPRP", "RPPRPR"]


def turning_of(kinds: str) -> Turning:
    """Which joints turn."""
    return tuple(kind == "R" for kind in kinds)


def general_frames(seed: int) -> Array:
    """Seven transforms of random modified DH constants."""
    rng = np.random.default_rng(seed)
    alpha, a, d = rng.uniform(-1.5, 1.5, 6), rng.uniform(-0.6, 0.6, 6), rng.uniform(-0.6, 0.6, 6)
    return dh_frames(alpha.tolist(), a.tolist(), d.tolist())


def dh_frames(
    alpha: list[float], a: list[float], d: list[float], theta: Sequence[float] = (0.0,) * 6
) -> Array:
    """Seven transforms of modified DH constants."""
    frames = [np.eye(4) for _ in range(7)]
    for i in range(6):
        c, s = math.cos(alpha[i]), math.sin(alpha[i])
        frames[i] = frames[i] @ np.array(
            [[1, 0, 0, a[i]], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]]
        )
        c, s = math.cos(theta[i]), math.sin(theta[i])
        frames[i + 1] = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, d[i]], [0, 0, 0, 1]])
    return np.array(frames)


def solver(plan: EliminationPlan) -> Plan:
    """What is embedded of a plan."""
    find = finder(plan.turning, both=plan.both)
    return Plan(plan.length, plan.eliminations, plan.turning, find)


def regular(frames: Array, turning: Turning, drawn: Array) -> Array:
    """Those of configurations (n, 6) at which the arm can move every way."""
    slopes = [jacobian(frames, q, turning) for q in drawn]
    return drawn[np.linalg.svd(np.array(slopes), compute_uv=False)[:, -1] > 2e-3]


def configurations(frames: Array, turning: Turning, count: int, seed: int = 5) -> Array:
    """Random regular configurations (count, 6)."""
    reach = np.where(turning, np.pi, 1.0)
    drawn = np.random.default_rng(seed).uniform(-reach, reach, (3 * count, 6))
    return regular(frames, turning, drawn)[:count]


def missing(found: list[Array], wanted: Array, turning: Turning) -> int:
    """How many of wanted (n, 6) are not among the solutions of their poses."""
    pairs = zip(found, wanted, strict=True)
    return sum(not (apart(rows, q, turning) < 1e-5).any() for rows, q in pairs)


def assert_closed(frames: Array, turning: Turning, found: list[Array], poses: Array) -> None:
    for rows, pose in zip(found, poses, strict=True):
        for row in rows:
            assert np.abs(forward(frames, row, turning) - pose).max() < 1e-9


@pytest.mark.parametrize("kinds", MIXES)
def test_every_mix_is_complete_and_exact(kinds: str) -> None:
    turning, frames = turning_of(kinds), general_frames(seed=3)
    plan = choose_plan(frames, turning, probes=8)
    q = configurations(frames, turning, 60)
    poses = np.array([forward(frames, row, turning) for row in q])
    found = six_joints_batch(frames, solver(plan), poses)
    assert plan.usable
    assert missing(found, q, turning) == 0
    assert_closed(frames, turning, found, poses)
    assert max(len(rows) for rows in found) <= MOST[kinds.count("P")]


@pytest.mark.parametrize("kinds", ["RRRPRR", "RPRPRR", "PRRPRR", "RPRPRP"])
def test_as_many_solutions_as_a_multi_start_search_finds(kinds: str) -> None:
    turning, frames = turning_of(kinds), general_frames(seed=4)
    plan = choose_plan(frames, turning, probes=8)
    for k, row in enumerate(configurations(frames, turning, 3, seed=8)):
        pose = forward(frames, row, turning)
        found = six_joints_batch(frames, solver(plan), pose[None])[0]
        axes = one_axis_each(turning)
        for other in searched(frames, axes, turning, plan.length, pose, seed=k):
            assert apart(found, other, turning).min() < 1e-4


@pytest.mark.parametrize("kinds", ["RRRPRR", "RRRPRP"])
def test_every_elimination_finds_the_same(kinds: str) -> None:
    """Whichever joint the loop begins at, reversed and swapped or not."""
    turning, frames = turning_of(kinds), general_frames(seed=5)
    q = configurations(frames, turning, 12)
    poses = np.array([forward(frames, row, turning) for row in q])
    counts = []
    for one in eliminations(turning):
        plan = Plan(1.0, (one,), turning, finder(turning))
        found = six_joints_batch(frames, plan, poses)
        assert missing(found, q, turning) == 0
        counts.append([len(rows) for rows in found])
    assert len(counts) == (8 if kinds.count("P") == 1 else 4)
    assert all(count == counts[0] for count in counts)


def surgical() -> tuple[Turning, Array]:
    """Two axes that meet, a slide, and a wrist whose axes miss each other by a few millimetres."""
    h = 0.5 * math.pi
    alpha, a = [0.0, h, h, 0.0, -h, -h], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0091]
    return turning_of("RRPRRR"), dh_frames(alpha, a, [0.0, 0.0, -0.43, 0.38, 0.0, 0.0])


def test_small_wrist_offset() -> None:
    turning, frames = surgical()
    plan = choose_plan(frames, turning)
    q = configurations(frames, turning, 80)
    poses = np.array([forward(frames, row, turning) for row in q])
    found = six_joints_batch(frames, solver(plan), poses)
    assert plan.usable
    assert missing(found, q, turning) == 0
    assert_closed(frames, turning, found, poses)


H = 0.5 * math.pi
RIGHT_ANGLES = {
    "RRRRRP": ([0, H, -H, -H, H, -H], [0, 0.33, 0.41, 0, 0.97, 0], [0, 0.53, 0, 0.51, 0, 0]),
    "RRPRRP": ([0, H, 0, -H, H, -H], [0, 0.72, 0, 0, 0.25, 0.26], [0.47, 0, 0, 0, 0, 0]),
}
"""Twists, lengths and offsets of tables that rules leave open."""


@pytest.mark.parametrize("kinds", RIGHT_ANGLES)
def test_right_angles_and_poses_at_multiples_of_them(kinds: str) -> None:
    turning, frames = turning_of(kinds), dh_frames(*RIGHT_ANGLES[kinds])
    plan = choose_plan(frames, turning)
    rng = np.random.default_rng(2)
    step = rng.integers(-2, 3, (400, 6)) * np.where(turning, 0.5 * H, 0.25)
    q = regular(frames, turning, step)[:60]
    poses = np.array([forward(frames, row, turning) for row in q])
    found = six_joints_batch(frames, solver(plan), poses)
    assert plan.usable and len(q) > 20
    assert missing(found, q, turning) == 0
    assert_closed(frames, turning, found, poses)


WITHOUT_RANK = {
    "RRPRRR": ([0, H, H, H, H, H], [0, 0.124, 0.091, 0, 0.099, 0], [0, 0.012, 0, 0, 0, 0], 2),
    "RPRRRR": ([0, H, H, H, H, 0], [0, 0.035, 0, 0, 0, 0.14], [0, 0, 0, 0.294, 0, 0], 1),
    "RRRRPR": ([0, H, H, H, H, H], [0, 0, 0.901, 0, 0, 0.756], [0, 0, 0, 0, 0, 0.83], 4),
}
"""The same, the slide turned by a right angle: by half angles of one angle M is singular everywhere."""


def without_rank(kinds: str) -> tuple[Turning, Array]:
    """One of those."""
    alpha, a, d, slide = WITHOUT_RANK[kinds]
    theta = [H if i == slide else 0.0 for i in range(6)]
    return turning_of(kinds), dh_frames(alpha, a, d, theta)


@pytest.mark.parametrize("kinds", WITHOUT_RANK)
def test_right_angles_that_leave_half_angles_of_one_angle_without_rank(kinds: str) -> None:
    turning, frames = without_rank(kinds)
    plan = choose_plan(frames, turning)
    rng = np.random.default_rng(2)
    step = rng.integers(-2, 3, (400, 6)) * np.where(turning, H, 0.25)
    special = regular(frames, turning, step)[:40]
    q = np.concatenate([configurations(frames, turning, 60), special])
    poses = np.array([forward(frames, row, turning) for row in q])
    found = six_joints_batch(frames, solver(plan), poses)
    assert plan.both and plan.recall == 1.0 and len(special) > 20
    assert missing(found, q, turning) == 0
    assert_closed(frames, turning, found, poses)
    assert all(len(rows) % 2 == 0 for rows in found)
    for k, pose in enumerate(poses[:3]):
        axes = one_axis_each(turning)
        for other in searched(frames, axes, turning, plan.length, pose, seed=k):
            assert apart(found[k], other, turning).min() < 1e-4


def test_half_angles_of_one_angle_are_enough_elsewhere() -> None:
    turning, frames = turning_of("RRRPRR"), general_frames(seed=3)
    assert not choose_plan(frames, turning, probes=4).both


def test_unreachable_and_distant_poses_have_no_solution() -> None:
    general = turning_of("RRRPRR"), general_frames(seed=3)
    for turning, frames in (general, without_rank("RPRRRR")):
        plan = choose_plan(frames, turning, probes=4)
        assert_nothing(frames, plan)


def assert_nothing(frames: Array, plan: EliminationPlan) -> None:
    for nonsense in (np.full((4, 4), np.nan), np.zeros((4, 4)), np.full((4, 4), 1e200)):
        assert len(six_joints_batch(frames, solver(plan), nonsense[None])[0]) == 0


def test_slides_that_differ_by_a_turn_are_two() -> None:
    turning = turning_of("RRRPRR")
    rows = np.zeros((3, 6))
    rows[1, 3] = rows[2, 0] = 2.0 * np.pi
    assert len(distinct_rows(rows, np.zeros(len(rows), dtype=np.intp), turning, 1e-6)[0]) == 2
