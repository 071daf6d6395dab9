"""The universal 6R solver on real and random arms: complete and exact."""

from __future__ import annotations

import math

import numpy as np
import pytest
from benchmarks.collection import load_arms
from numpy.typing import NDArray
from tests.support.arms import arm_chain
from tests.support.multi_start import apart, searched
from tests.support.six_turns import general_6r, general_6r_batch

from ikgen.elimination import (
    EliminationPlan,
    choose_plan,
    held_frames,
    hold_joint,
)
from ikgen.elimination.loop_frames import forward, jacobian
from ikgen.kinematics.modified_dh import to_dh
from ikgen.runtime.python.elimination.general_6r import one_axis_each

Array = NDArray[np.float64]
ARMS = {a["name"]: a for a in load_arms()}
NAMES = [
    *("bravo7", "icub_left_leg", "fanuc_crx10ia", "kinova_j2n6s300", "xarm6", "niryo_ned2"),
    *("mecharm270_pi", "schunk_lwa4p", "abb_irb2400", "kuka_kr6r900sixx", "i2rt_yam", "ur5e"),
    *("valkyrie_left_leg", "Issue4", "KawasakiRS05L", "random 1", "random 2"),
]


def dh_frames(alpha: list[float], a: list[float], d: list[float]) -> Array:
    """Seven transforms of modified DH constants."""
    frames = [np.eye(4) for _ in range(7)]
    for i in range(6):
        c, s = math.cos(alpha[i]), math.sin(alpha[i])
        twist = np.array([[1, 0, 0, a[i]], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])
        frames[i] = frames[i] @ twist
        frames[i + 1][2, 3] = d[i]
    return np.array(frames)


def arm_frames(name: str) -> Array:
    """The frames of an arm of the collection, of IKBT's two open ones, or of a random arm."""
    h = 0.5 * math.pi
    if name == "Issue4":
        d = [0.112891, 0.0, 0.0, 0.4615, 0.029, 0.418]
        return dh_frames([0, -h, 0, h, h, -h], [0, 0.12893, 0.8382, 0.064, 0, 0], d)
    if name == "KawasakiRS05L":
        return dh_frames([0, h, 0, -h, -h, h], [0, 105, 330, 80, 0, 0], [0, 0, 0, 0, 410.0, 0])
    if name == "equal links":  # of a snake: some equations depend on each other at all poses
        return dh_frames([0, h, -h, h, -h, h], [0.06] * 6, [0] * 6)
    if name.startswith("random"):
        rng = np.random.default_rng(int(name.split()[1]))
        alpha, a, d = rng.uniform(-1.5, 1.5, 6), rng.uniform(-1, 1, 6), rng.uniform(-1, 1, 6)
        return dh_frames(alpha.tolist(), a.tolist(), d.tolist())
    if not ARMS:
        pytest.skip("the collection of arms is not on this machine")
    return held_frames(to_dh(arm_chain(ARMS[name])))


def configurations(frames: Array, n: int, seed: int = 5) -> Array:
    """Random regular configurations (n, 6)."""
    rng = np.random.default_rng(seed)
    rows: list[Array] = []
    while len(rows) < n:
        q = rng.uniform(-math.pi, math.pi, frames.shape[0] - 1)
        if np.linalg.svd(jacobian(frames, q), compute_uv=False)[-1] > 1e-3:
            rows.append(q)
    return np.array(rows)


def missing(found: list[Array], wanted: Array) -> int:
    """How many of wanted (n, 6) are not among the solutions of their poses."""
    return sum(not (apart(rows, q) < 1e-5).any() for rows, q in zip(found, wanted, strict=True))


@pytest.fixture(scope="module", params=NAMES)
def arm(request: pytest.FixtureRequest) -> tuple[EliminationPlan, Array, Array]:
    """A plan, regular configurations, and their poses."""
    frames = arm_frames(request.param)
    q = configurations(frames, 60)
    return choose_plan(frames), q, np.array([forward(frames, row) for row in q])


def test_every_generating_configuration_is_found(arm: tuple[EliminationPlan, Array, Array]) -> None:
    plan, q, poses = arm
    found = general_6r_batch(plan.frames, plan.length, plan.eliminations, poses)
    assert plan.usable
    assert missing(found, q) == 0
    for rows, T in zip(found, poses, strict=True):
        assert len(rows) % 2 == 0 and len(rows) <= 16
        for row in rows:
            error = forward(plan.frames, row) - T
            assert np.abs(error[:3, :3]).max() < 1e-9
            assert np.abs(error[:3, 3]).max() < 1e-9 * plan.length


@pytest.mark.parametrize("name", ["random 3", "Issue4", "fanuc_crx10ia"])
def test_no_more_solutions_than_a_multi_start_search_finds(name: str) -> None:
    frames = arm_frames(name)
    plan = choose_plan(frames)
    turning = (True,) * 6
    for k, row in enumerate(configurations(frames, 4, seed=8)):
        T = forward(frames, row)
        found = general_6r(plan.frames, plan.length, plan.eliminations, T)
        for other in searched(frames, one_axis_each(turning), turning, plan.length, T, seed=k):
            assert apart(found, other).min() < 1e-5


def test_unreachable_pose_has_no_solution() -> None:
    frames = arm_frames("random 1")
    plan = choose_plan(frames)
    T = forward(frames, np.zeros(6))
    T[:3, 3] += 100.0
    assert general_6r(plan.frames, plan.length, plan.eliminations, T).shape == (0, 6)
    for nonsense in (np.full((4, 4), np.nan), np.zeros((4, 4)), np.full((4, 4), 1e200)):
        assert len(general_6r(plan.frames, plan.length, plan.eliminations, nonsense)) == 0


def test_seven_joints_with_one_held() -> None:
    """One plan for all values of the held joint, the frames merged for each."""
    frames = np.concatenate([arm_frames("random 1")[:6], arm_frames("random 2")[5:]])
    values = np.linspace(-2.0, 2.0, 6)
    plan = choose_plan(np.array([hold_joint(frames, 2, v) for v in values]))
    for value in (-1.3, 0.4, 2.5):
        held = hold_joint(frames, 2, value)
        q = configurations(held, 40)
        poses = np.array([forward(held, row) for row in q])
        assert missing(general_6r_batch(held, plan.length, plan.eliminations, poses), q) == 0
    full = np.insert(q[0], 2, value)
    assert np.allclose(forward(frames, full), poses[0])


def test_an_arm_that_is_singular_everywhere_has_no_usable_plan() -> None:
    frames = arm_frames("random 1").copy()
    frames[3] = np.eye(4)  # joints 3 and 4 on one line
    assert not choose_plan(frames).usable


def test_wrong_shapes() -> None:
    with pytest.raises(ValueError, match="six joints"):
        choose_plan(np.zeros((6, 4, 4)))


def test_random_arms() -> None:
    lost = 0
    for seed in range(10, 20):
        frames = arm_frames(f"random {seed}")
        plan, q = choose_plan(frames, probes=12), configurations(frames, 50)
        poses = np.array([forward(frames, row) for row in q])
        found = general_6r_batch(plan.frames, plan.length, plan.eliminations, poses)
        lost += missing(found, q)
    assert lost == 0
