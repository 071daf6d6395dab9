"""Intervals of a held joint against a grid of its values, and the best rows against random values."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.held_arms import held_limits, held_of, imported, on_limits

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]


@pytest.fixture(scope="module", params=["shoulder_elbow_wrist", "franka_fr3", "arm_angle"])
def arm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return imported(request.param, tmp_path_factory.mktemp("arm"))


def poses(arm: ModuleType, count: int, seed: int) -> list[Array]:
    rng = np.random.default_rng(seed)
    return [arm.forward(rng.uniform(arm.LOWER, arm.UPPER)) for _ in range(count)]


def rows_on(arm: ModuleType, pose: Array, held: Array) -> tuple[Array, Array]:
    q, count, _ = arm.solve_batch(np.broadcast_to(pose, (len(held), 4, 4)), free=held[:, None])
    return q, count


def test_intervals_are_those_of_a_grid(arm: ModuleType) -> None:
    low, high = held_limits(arm)
    held = np.arange(low, high, 1e-3)
    seen = 0
    for pose in poses(arm, 12, 3):
        found = arm.self_motion(pose)
        said = np.zeros(len(held), dtype=int)
        beside = np.zeros(len(held), dtype=bool)
        for one in found:
            assert low <= one.low < one.high <= high
            said += (one.low <= held) & (held <= one.high)
            beside |= (np.abs(held - one.low) < 1e-6) | (np.abs(held - one.high) < 1e-6)
        count = rows_on(arm, pose, held)[1]
        wrong = (said != count) & ~beside
        assert not (wrong[1:] & wrong[:-1]).any()  # what is wider than a step of the grid
        assert not (said > count)[~beside].any()
        seen += len(found)
    assert seen > 24


def test_a_branch_goes_on_all_over_its_interval_and_no_farther(arm: ModuleType) -> None:
    checked = 0
    for pose in poses(arm, 6, 4):
        for one in arm.self_motion(pose):
            held = np.linspace(one.low, one.high, 9)
            assert (rows_on(arm, pose, held)[1] > 0).all()
            for value in held[1:-1]:
                assert f"branch {one.branch}" in arm.solve(pose, free=value).branch
            checked += 1
        for one in arm.self_motion(pose, limits=False):
            assert one.low < one.high
    assert checked > 10


def test_curves_that_cross_keep_their_names(tmp_path: Path) -> None:
    """With the wrist straight its axis stays where it is while the forearm turns: rows of two branches meet
    where they go on as each other's."""
    arm = imported("held_forearm", tmp_path)
    rng, low, high = np.random.default_rng(6), *held_limits(arm)
    held = np.linspace(low, high, 60)[1:-1]
    for _ in range(3):
        q = rng.uniform(arm.LOWER, arm.UPPER)
        q[5] = 0.0
        pose, found = arm.forward(q), arm.self_motion(arm.forward(q))
        for value in held:
            names = {f"branch {one.branch}" for one in found if one.low <= value <= one.high}
            assert names == set(arm.solve(pose, free=value).branch)


def test_no_limits_give_no_less(arm: ModuleType) -> None:
    for pose in poses(arm, 4, 5):
        inside = sum(one.high - one.low for one in arm.self_motion(pose))
        assert sum(one.high - one.low for one in arm.self_motion(pose, limits=False)) > inside


def test_poses_without_intervals(arm: ModuleType) -> None:
    far = np.eye(4)
    far[0, 3] = 9.0
    assert arm.self_motion(far) == ()
    assert arm.search(far).status is arm.Status.UNREACHABLE
    (name,) = arm.FREE_JOINTS
    assert name in arm.search(far).reason
    assert f"{name} = 0.25 held" in arm.solve(far, free=[0.25]).reason
    assert arm.self_motion(np.full((4, 4), np.nan)) == ()
    assert arm.search(np.zeros((4, 4))).status is arm.Status.INVALID
    with pytest.raises(ValueError, match="shape"):
        arm.self_motion(np.eye(3))
    with pytest.raises(ValueError, match="prefer"):
        arm.search(far, prefer="best")


def test_poses_at_which_a_joint_stays_on_its_limit_or_the_arm_is_stretched(
    arm: ModuleType,
) -> None:
    """Where branches meet, or touch a limit, all over the range."""
    for row in on_limits(arm):
        found = arm.self_motion(arm.forward(row))
        value = held_of(arm, row)
        assert any(one.low - 1e-4 <= value <= one.high + 1e-4 for one in found)


def cost(arm: ModuleType, prefer: str, q: Array, seed: Array) -> Array:
    if prefer == "near":
        return np.asarray(np.linalg.norm(q - seed, axis=1))
    if prefer == "centre":
        middle, half = 0.5 * (arm.LOWER + arm.UPPER), 0.5 * (arm.UPPER - arm.LOWER)
        return np.asarray((((q - middle) / half) ** 2).sum(axis=1))
    J = np.array([arm.jacobian(row) for row in q])
    return np.asarray(-np.linalg.svd(J, compute_uv=False)[:, -1])


@pytest.mark.parametrize("prefer", ["near", "centre", "dexterous"])
def test_no_random_value_is_better_than_the_search(arm: ModuleType, prefer: str) -> None:
    rng = np.random.default_rng(6)
    for pose in poses(arm, 3, 7):
        seed = rng.uniform(arm.LOWER, arm.UPPER)
        found = arm.search(pose, seed=seed, prefer=prefer)
        costs = cost(arm, prefer, found.q, seed)
        assert (np.diff(costs) > -1e-9).all()
        assert np.abs(arm.forward(found.q) - pose).max() < 1e-9
        assert ((found.q >= arm.LOWER) & (found.q <= arm.UPPER)).all()
        held = rng.uniform(*held_limits(arm), 2000)
        rows = rows_on(arm, pose, held)[0].reshape(-1, arm.DOF)
        rows = rows[~np.isnan(rows[:, 0])]
        assert costs[0] <= cost(arm, prefer, rows, seed).min() + 1e-9


def test_a_seed_without_free_values_holds_its_own(arm: ModuleType) -> None:
    rng = np.random.default_rng(8)
    rounding = 1e-9 if arm.FREE_JOINTS == ("arm_angle",) else 0.0
    for _ in range(5):
        q = rng.uniform(arm.LOWER, arm.UPPER)
        pose = arm.forward(q)
        found = arm.solve(pose, seed=q)
        assert np.abs(found.q[0] - q).max() < 1e-6
        assert (np.abs(held_of(arm, found.q) - held_of(arm, q)) <= rounding).all()
        batch, _, _ = arm.solve_batch(pose[None], seed=q)
        assert np.abs(batch[0, 0] - q).max() < 1e-6
        rows = arm.solve(pose, seed=q, free=[0.25]).q
        assert (np.abs(held_of(arm, rows) - 0.25) <= rounding).all()


def test_several_held_joints_are_searched_on_a_grid(tmp_path: Path) -> None:
    arm = imported("torso", tmp_path)
    rng = np.random.default_rng(9)
    held = [arm.JOINT_NAMES.index(name) for name in arm.FREE_JOINTS]
    q = rng.uniform(arm.LOWER, arm.UPPER)
    pose, seed = arm.forward(q), rng.uniform(arm.LOWER, arm.UPPER)
    found = arm.search(pose, seed=seed)
    values = rng.uniform(arm.LOWER[held], arm.UPPER[held], (2000, 2))
    rows, _, _ = arm.solve_batch(np.broadcast_to(pose, (2000, 4, 4)), free=values)
    rows = rows.reshape(-1, arm.DOF)
    best = np.nanmin(np.linalg.norm(rows - seed, axis=1))
    assert np.linalg.norm(found.q[0] - seed) <= best + 1e-9
    assert not hasattr(arm, "self_motion")


def test_without_held_joints_rows_are_ordered(tmp_path: Path) -> None:
    arm = imported("ur5e", tmp_path)
    pose = arm.forward([0.3, -1.2, 1.1, -0.4, 0.9, 0.2])
    seed = np.array([0.1, -1.0, 1.0, 0.0, 1.0, 0.0])
    near = arm.search(pose, seed=seed)
    assert np.allclose(near.q, arm.solve(pose, seed=seed).q)
    best = arm.search(pose, prefer="dexterous").q
    least = [np.linalg.svd(arm.jacobian(row), compute_uv=False)[-1] for row in best]
    assert len(best) == len(near) and (np.diff(least) < 1e-12).all() and least[0] > least[-1]
