"""Lines and circles through a wrist singularity, by a shoulder singularity, into a limit, out of reach."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.held_arms import imported, lift_scara
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def ur5e(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return imported("ur5e", tmp_path_factory.mktemp("ur5e"))


@pytest.fixture(scope="module")
def redundant(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return imported("shoulder_elbow_wrist", tmp_path_factory.mktemp("srs"))


def line(pose: Array, way: Array, count: int) -> Array:
    poses = np.repeat(pose[None], count, axis=0)
    poses[:, :3, 3] += np.linspace(0.0, 1.0, count)[:, None] * way
    return poses


def circle(pose: Array, radius: float, count: int) -> Array:
    poses, turn = np.repeat(pose[None], count, axis=0), np.linspace(0.0, 2.0 * np.pi, count)
    poses[:, 1, 3] += radius * np.sin(turn)
    poses[:, 2, 3] += radius * (1.0 - np.cos(turn))
    return poses


def along(arm: ModuleType, rows: Array) -> Array:
    """Poses of a motion."""
    return np.asarray(arm.forward(rows))


def check(arm: ModuleType, path: object, poses: Array) -> Array:
    q = path.q[: path.reached]  # type: ignore[attr-defined]
    assert np.isnan(path.q[path.reached :]).all()  # type: ignore[attr-defined]
    assert np.abs(arm.forward(q) - poses[: len(q)]).max() < 1e-9
    assert ((q >= arm.LOWER) & (q <= arm.UPPER)).all()
    return np.asarray(q)


def test_a_motion_through_the_wrist_singularity_comes_back(ur5e: ModuleType) -> None:
    start, end = (np.array([0.3, -1.2, 1.4, -0.8, s, 0.2]) for s in (0.4, -0.4))
    for count in (40, 41):  # past it, and onto it
        motion = start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)
        poses = along(ur5e, motion)
        path = ur5e.follow(poses, start=start)
        q = check(ur5e, path, poses)
        assert path.status is ur5e.Status.OK and path.reached == count
        off = np.abs(q - motion).max(axis=1)
        assert off[~path.singular].max() < 1e-6
        assert off.max() < 0.02  # the row at the singularity itself is one of many
        assert path.singular.sum() == 1 and path.singular[20]


@pytest.mark.long
def test_a_coarse_step_beside_a_singularity_stays_on_the_branch(ur5e: ModuleType) -> None:
    """Where rows of both branches are near where the Jacobian leads; in one step as in ten."""
    random = np.random.default_rng(0)
    beside = 0
    for _ in range(16):
        start = np.array([0.0, -1.2, 0.0, -0.8, 0.0, 0.2]) + random.uniform(-0.3, 0.3, 6)
        way = np.outer(np.linspace(0.0, 1.0, 21), random.uniform(-0.2, 0.2, 6))
        poses = along(ur5e, start + way)
        fine, coarse = (ur5e.follow(some, start=start) for some in (poses, poses[::10]))
        for path in (fine, coarse):
            sign = np.sign(np.linalg.det(ur5e.jacobian(path.q[: path.reached])))
            after = np.flatnonzero(np.diff(sign)) + 1
            assert (path.singular[after - 1] | path.singular[after]).all()
        crossed = bool(fine.singular.any() or coarse.singular.any())
        if not crossed and fine.reached == 21 and coarse.reached == 3:
            assert np.abs(fine.q[-1] - coarse.q[-1]).max() < 1e-6
        beside += crossed
    assert 0 < beside < 16


def test_a_coarse_motion_past_the_wrist_singularity_goes_on_as_it_was(ur5e: ModuleType) -> None:
    """Poses half-way between two are beside it, on the side where the wrist would have to turn around."""
    start = np.array([0.2, -0.9, 1.1, 0.3, 0.6, -0.4])
    motion = start + np.linspace(0.0, 1.0, 20)[:, None] * np.array([1.0, 0.3, -0.5, 0.2, -1.2, 0.4])
    poses = along(ur5e, motion)
    path = ur5e.follow(poses, start=start)
    q = check(ur5e, path, poses)
    assert path.status is ur5e.Status.OK
    assert np.abs(q - motion).max() < 1e-6
    assert path.singular.any() and not path.singular[:8].any()


@pytest.mark.parametrize("step", [0.1, 0.2, 0.4])
def test_regular_motions_are_followed_however_far_apart_the_poses_are(
    ur5e: ModuleType, redundant: ModuleType, step: float
) -> None:
    rng = np.random.default_rng(8)
    for arm in (ur5e, redundant):
        seen = 0
        while seen < 25:
            start = rng.uniform(np.maximum(arm.LOWER, -2.5), np.minimum(arm.UPPER, 2.5))
            end = start + rng.uniform(-step, step, arm.DOF)
            rows = start + np.linspace(0.0, 1.0, 9)[:, None] * (end - start)
            least = min(np.linalg.svd(arm.jacobian(q), compute_uv=False)[-1] for q in rows)
            if least < 0.05 or not ((rows > arm.LOWER) & (rows < arm.UPPER)).all():
                continue
            seen += 1
            poses = along(arm, np.array([start, end]))
            path = arm.follow(poses, start=start)
            q = check(arm, path, poses)
            assert path.status is arm.Status.OK
            assert not path.singular.any()
            if not arm.FREE_JOINTS:
                assert np.abs(q[1] - end).max() < 1e-6


def test_whole_turns_are_unwound(ur5e: ModuleType) -> None:
    start = np.array([2.5, -1.2, 1.4, -0.8, 1.0, -4.0])
    motion = np.repeat(start[None], 60, axis=0)
    motion[:, 0] += np.linspace(0.0, 2.5, 60)
    motion[:, 5] += np.linspace(0.0, 8.0, 60)
    path = ur5e.follow(along(ur5e, motion), start=start)
    assert path.status is ur5e.Status.OK
    assert np.abs(path.q - motion).max() < 1e-6


def test_a_line_near_the_shoulder_singularity_stays_on_its_branch(ur5e: ModuleType) -> None:
    start = np.array([0.0, -1.0, 1.6, -2.2, -1.57, 0.0])
    pose = ur5e.forward(start)
    poses = line(pose, np.array([-2.0 * pose[0, 3], -1.2 * pose[1, 3], 0.0]), 200)
    path = ur5e.follow(poses, start=start)
    q = check(ur5e, path, poses)
    assert path.reached > 50
    elbow = np.sign(q[:, 2])
    assert (elbow == elbow[0]).all()  # the elbow's branch is kept
    assert np.abs(np.diff(q, axis=0)).max() < 2.0


def test_the_elbow_meets_its_limit(redundant: ModuleType) -> None:
    start = np.array([0.2, 0.6, 0.1, 1.2, 0.2, 0.7, 0.1])
    poses = line(redundant.forward(start), np.array([-0.6, 0.0, -0.7]), 120)
    path = redundant.follow(poses, start=start)
    q = check(redundant, path, poses)
    assert path.status is redundant.Status.LIMITS
    assert 20 < path.reached < 120
    free = redundant.follow(poses, start=start, limits=False)
    assert free.reached > path.reached
    elbow = redundant.JOINT_NAMES.index("elbow")
    assert q[-1, elbow] > 1.9  # of 2.1


def test_held_joints_move_to_keep_the_branch(redundant: ModuleType) -> None:
    start = np.array([0.2, 0.7, 0.1, 1.2, 0.2, 0.8, 0.1])
    poses = circle(redundant.forward(start), 0.12, 120)
    path = redundant.follow(poses, start=start)
    q = check(redundant, path, poses)
    assert path.status is redundant.Status.OK
    assert np.abs(np.diff(q, axis=0)).max() < 0.2
    held = redundant.JOINT_NAMES.index(redundant.FREE_JOINTS[0])
    assert np.ptp(q[:, held]) > 1e-3


def test_out_of_reach_and_bad_poses(redundant: ModuleType) -> None:
    start = np.array([0.2, 0.9, 0.1, 1.2, 0.2, 0.7, 0.1])
    poses = line(redundant.forward(start), np.array([2.0, 0.0, 0.0]), 60)
    path = redundant.follow(poses, start=start, limits=False)
    assert path.status is redundant.Status.UNREACHABLE and 0 < path.reached < 60
    there = redundant.search(poses[path.reached + 1], limits=False)
    assert there.status is redundant.Status.UNREACHABLE
    poses = line(redundant.forward(start), np.array([0.02, 0.0, 0.0]), 9)
    poses[5, 0, 0] = np.nan
    path = redundant.follow(poses, start=start)
    assert path.status is redundant.Status.INVALID and path.reached == 5
    with pytest.raises(ValueError, match="start"):
        redundant.follow(poses, start=[0.0])
    with pytest.raises(ValueError, match="shape"):
        redundant.follow(np.zeros((3, 2)), start=start)


def test_a_start_elsewhere_leads_to_the_nearest_row(redundant: ModuleType) -> None:
    start = np.array([0.2, 0.9, 0.1, 1.2, 0.2, 0.7, 0.1])
    pose = redundant.forward(start)
    path = redundant.follow(pose[None], start=start + 0.4)
    nearest = redundant.search(pose, seed=start + 0.4).q[0]
    assert path.reached == 1 and np.abs(path.q[0] - nearest).max() < 1e-9


@pytest.mark.parametrize("count", [60, 200, 501])
def test_a_stretched_elbow_is_passed_with_joints_held(
    redundant: ModuleType, tmp_path: Path, count: int
) -> None:
    """The rows on both sides meet there; the arm is singular there and nowhere else."""
    scara = import_text(emit_module(lift_scara(tmp_path)), tmp_path)
    share = np.linspace(0.0, 1.0, count)[:, None]
    for arm, start, end in (
        (scara, [0.27, 0.91, -0.42, 0.09, 0.98], [0.48, -0.06, 0.57, 0.07, 0.52]),
        (scara, [0.2, 0.9, -0.4, 0.19, 0.2], [0.5, 0.3, 0.4, 0.02, 0.5]),
        (redundant, [0.2, 0.6, 0.1, -0.3, 0.2, 0.7, 0.1], [0.5, 0.3, 0.4, 0.4, 0.3, 0.9, 0.4]),
        (redundant, [-0.9, 0.8, 0.7, 0.2, 0.9, -0.7, 0.3], [-0.4, 1.1, 0.3, -0.5, 0.6, -1.0, 0.7]),
    ):
        motion = np.array(start) + share * (np.array(end) - np.array(start))
        poses = along(arm, motion)
        path = arm.follow(poses, start=start)
        assert path.status is arm.Status.OK
        entries = np.s_[:, :3, [0, 3]] if arm is scara else np.s_[:]
        assert np.abs(arm.forward(path.q)[entries] - poses[entries]).max() < 1e-9
        stretched = np.abs(path.q[:, arm.JOINT_NAMES.index("elbow")]) < 2.0 / count
        assert not path.singular[~stretched].any()
