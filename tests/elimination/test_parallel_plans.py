"""The elimination about two parallel axes: chosen by geometry, complete, the same as the general one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.elimination.test_elimination import (
    apart,
    arm_frames,
    configurations,
    dh_frames,
    missing,
)
from tests.support.parallel_arms import (
    KINDS,
    exchanged,
    flipped,
    parallel_frames,
    rounded_frames,
)
from tests.support.six_turns import general_6r_batch

from ikgen.elimination import EliminationPlan, choose_plan, hold_joint
from ikgen.elimination.elimination_table import finder
from ikgen.elimination.loop_frames import forward
from ikgen.elimination.parallel_plans import (
    ParallelKind,
    ParallelPlan,
    choose_parallel,
    parallel_plans,
    settled_share,
    with_parallel,
)
from ikgen.elimination.routine import Plan, six_joints_batch
from ikgen.runtime.python.elimination.parallel_links import MEETING, PLAIN, UPRIGHT

Array = NDArray[np.float64]
CHAINS = {
    **{f"kind {kind}": parallel_frames(kind) for kind in KINDS},
    **{f"kind {kind}, base and tip exchanged": exchanged(parallel_frames(kind)) for kind in KINDS},
    "antiparallel": flipped(parallel_frames(MEETING)),
    "antiparallel, upright": flipped(parallel_frames(UPRIGHT)),
    "rounded": rounded_frames(PLAIN),
    "rounded, upright": rounded_frames(UPRIGHT),
}


def way(plan: EliminationPlan) -> Plan:
    """How emitted modules solve the arm."""
    general = Plan(plan.length, plan.eliminations, plan.turning, finder(plan.turning))
    return with_parallel(general, plan.parallel)


@pytest.mark.parametrize("name", CHAINS)
def test_solutions_are_those_of_the_general_elimination(name: str) -> None:
    frames = CHAINS[name]
    plan, q = choose_plan(frames), configurations(frames, 80)
    assert plan.parallel is not None
    poses = np.array([forward(frames, row) for row in q])
    found = six_joints_batch(frames, way(plan), poses)
    others = general_6r_batch(frames, plan.length, plan.eliminations, poses)
    assert missing(found, q) == 0
    for rows, reference, pose in zip(found, others, poses, strict=True):
        assert len(rows) == len(reference)
        for row in rows:
            assert np.abs(forward(frames, row) - pose).max() < 1e-9
            assert apart(reference, row).min() < 1e-6


@pytest.mark.parametrize("off", [0.0, 1e-7, 1e-5])
def test_two_solutions_in_a_fourfold_root_are_found(off: float) -> None:
    """With right angles they meet two complex roots where the first and the fifth angle are 0."""
    h = 0.5 * np.pi
    alpha, a = [0.0, -h, -h, 0.0, -h, h], [0.0, 0.85, 0.82, 0.53, 0.62, 0.63]
    frames = dh_frames(alpha, a, [0.0, 0.78, 0.0, 0.0, 0.35, 0.9])
    hidden = replace(choose_plan(frames), parallel=ParallelPlan((1, 0), ParallelKind.UPRIGHT, 0.0))
    q = np.random.default_rng(7).uniform(-np.pi, np.pi, (300, 6))
    q[:, [0, 4]] = off
    poses = np.array([forward(frames, row) for row in q])
    assert missing(six_joints_batch(frames, way(hidden), poses), q) == 0


@pytest.mark.parametrize("name", CHAINS)
def test_most_poses_need_no_other_elimination(name: str) -> None:
    frames = CHAINS[name]
    plan = choose_parallel(frames[None])
    assert plan is not None
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (200, 6))
    poses = np.array([forward(frames, row) for row in q])
    assert settled_share(frames, 1.0, plan, poses) > 0.7


def test_the_kind_of_the_least_degree_is_taken() -> None:
    for kind in KINDS:
        plans = parallel_plans(parallel_frames(kind)[None])
        assert {p.elimination for p in plans} == {(0, 0, kind), (3, 1, kind)}
        assert all(p.deviation < 1e-12 and p.bounded for p in plans)
        plans = parallel_plans(exchanged(parallel_frames(kind))[None])
        assert {p.elimination for p in plans} == {(2, 0, kind), (5, 1, kind)}


def test_rounded_right_angles_are_taken_for_right_ones() -> None:
    assert 7e-6 < parallel_plans(rounded_frames(PLAIN)[None])[0].deviation < 8e-6
    assert parallel_plans(rounded_frames(PLAIN)[None])[0].bounded
    assert not parallel_plans(rounded_frames(UPRIGHT)[None])[0].bounded


def test_other_chains_have_none() -> None:
    assert choose_parallel(arm_frames("random 1")[None]) is None
    offset = parallel_frames(UPRIGHT)
    offset[2, 2, 3] += 0.03  # an offset between links that do not meet the parallel axes
    assert choose_parallel(offset[None]) is None
    tilted = parallel_frames(PLAIN)
    tilted[2, :3, :3] = tilted[2, :3, :3] @ arm_frames("random 1")[1, :3, :3]
    assert choose_parallel(tilted[None]) is None
    assert choose_parallel(np.array([parallel_frames(PLAIN), tilted])) is None


def test_poses_with_the_neighbours_parallel_are_handed_on() -> None:
    """Axes 1 and 4 parallel: the parallel axes' direction does not follow from theirs."""
    frames = parallel_frames(PLAIN)
    plan = choose_plan(frames)
    assert plan.parallel is not None
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (20, 6))
    q[:, 2] = -q[:, 1]
    poses = np.array([forward(frames, row) for row in q])
    found = six_joints_batch(frames, way(plan), poses)
    assert missing(found, q) == 0


def test_unreachable_poses_and_nonsense_have_no_solution() -> None:
    frames = parallel_frames(MEETING)
    plan = choose_plan(frames)
    far = forward(frames, np.zeros(6))
    far[:3, 3] += 100.0
    poses = np.array([far, np.full((4, 4), np.nan), np.zeros((4, 4)), np.full((4, 4), 1e200)])
    assert [len(rows) for rows in six_joints_batch(frames, way(plan), poses)] == [0, 0, 0, 0]


def test_held_joint_of_an_arm_with_seven() -> None:
    """The axes stay parallel whatever the held joint's value."""
    frames = np.concatenate([parallel_frames(UPRIGHT)[:6], arm_frames("random 2")[5:]])
    family = np.array([hold_joint(frames, 5, v) for v in (0.4, -1.1, 2.2)])
    plan = choose_plan(family, probes=12)
    assert plan.parallel is not None and plan.parallel.kind is ParallelKind.UPRIGHT
    held = hold_joint(frames, 5, 1.7)
    q = configurations(held, 40)
    poses = np.array([forward(held, row) for row in q])
    assert missing(six_joints_batch(held, way(plan), poses), q) == 0
