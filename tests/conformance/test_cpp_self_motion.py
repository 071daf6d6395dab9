"""Intervals, searches and paths of the C++ header are the Python module's."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import Both, in_both
from tests.support.held_arms import HELD, held_module, held_of, lift_scara, on_limits
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.sampled import sampled
from tests.support.solving import NO_COMPILER, solver_module

from ikgen.derivation.read import read
from ikgen.kinematics.rigid import rotation_about
from ikgen.records.request import Request

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

Array = NDArray[np.float64]

OFTEN = ("rounded_arm_angle",)


@pytest.fixture(scope="module", params=sampled(HELD, OFTEN))
def both(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Both:
    folder = tmp_path_factory.mktemp("both")
    return in_both(held_module(request.param, folder), folder)


def drawn(arm: ModuleType, rng: np.random.Generator) -> Array:
    return rng.uniform(np.maximum(arm.LOWER, -np.pi), np.minimum(arm.UPPER, np.pi))


def test_intervals(both: Both) -> None:
    arm, rng = both.arm, np.random.default_rng(1)
    if len(arm.FREE_JOINTS) != 1:
        assert not hasattr(arm, "self_motion")
        return
    for _ in range(8):
        pose = arm.forward(drawn(arm, rng))
        status, numbers = both.run(0, np.zeros(arm.DOF), pose[None])
        mine = np.array([[one.low, one.high, one.branch] for one in arm.self_motion(pose)])
        theirs = numbers.reshape(-1, 3)
        assert status == "OK"
        # an interval narrower than the cells that are looked at may be seen by one alone
        wide = [x[x[:, 1] - x[:, 0] > 1e-3] for x in (mine, theirs)]
        assert len(wide[0]) == len(wide[1])
        assert np.abs(wide[0][:, :2] - wide[1][:, :2]).max() < 1e-9
        assert np.array_equal(wide[0][:, 2], wide[1][:, 2])


@pytest.mark.long
def test_branches_that_come_near_each_other_end_where_each_does(tmp_path: Path) -> None:
    narrow = {"elbow": (-2.1, 0.1), "wrist_pitch": (-0.6, 0.6), "wrist_roll": (-0.4, 0.4)}
    path = tmp_path / "narrow.urdf"
    path.write_text(
        serial_urdf("narrow", [(*j[:4], narrow.get(j[0], j[4])) for j in SHOULDER_ELBOW_WRIST])
    )
    dh = read(Request(path, free={"shoulder_roll": None})).dh
    both = in_both(replace(solver_module(dh), name="narrow"), tmp_path, "0")
    for row in (
        (1.02924, 1.7831, -2.13867, 0.02822, -1.58641, -0.1504, -0.28535),
        (0.16952, 0.75965, 1.25799, -0.00999, 2.13671, -0.45608, -0.3702),
        (-0.19588, 1.00576, -0.51975, 0.02367, 1.91753, 0.39581, -0.17747),
    ):
        pose = both.arm.forward(np.array(row))
        _, numbers = both.run(0, np.zeros(7), pose[None])
        own = [(one.low, one.high) for one in both.arm.self_motion(pose)]
        for intervals in (numbers.reshape(-1, 3)[:, :2], np.array(own)):
            for sign, ends in zip((1.0, -1.0), intervals.T, strict=True):
                for end in ends[np.abs(ends) < 2.999]:
                    beside = [end + sign * by for by in (1e-6, -1e-6)]
                    inside, outside = (len(both.arm.solve(pose, free=[x])) for x in beside)
                    assert inside > outside


def test_poses_at_which_a_joint_stays_on_its_limit_or_the_arm_is_stretched(both: Both) -> None:
    arm = both.arm
    if len(arm.FREE_JOINTS) != 1:
        return
    for row in on_limits(arm):
        _, numbers = both.run(0, np.zeros(arm.DOF), arm.forward(row)[None])
        low, high, _ = numbers.reshape(-1, 3).T
        value = held_of(arm, row)
        assert ((low - 1e-4 <= value) & (value <= high + 1e-4)).any()


def regular(arm: ModuleType, rng: np.random.Generator) -> Array:
    """A configuration that a path can lead away from."""
    while True:
        q = drawn(arm, rng)
        if np.linalg.svd(arm.jacobian(q), compute_uv=False)[-1] > 0.05:
            return q


def cost(arm: ModuleType, mode: int, q: Array, seed: Array) -> float:
    if mode == 1:
        return float(np.linalg.norm(q - seed))
    if mode == 2:
        half = 0.5 * (arm.UPPER - arm.LOWER)
        return float(np.linalg.norm((q - 0.5 * (arm.LOWER + arm.UPPER)) / half))
    return -float(np.linalg.svd(arm.jacobian(q), compute_uv=False)[-1])


@pytest.mark.parametrize("mode", [1, 2, 3])
def test_searches(both: Both, mode: int) -> None:
    arm, rng = both.arm, np.random.default_rng(2)
    for _ in range(3 if len(arm.FREE_JOINTS) < 2 else 1):  # a grid takes a second
        pose, seed = arm.forward(drawn(arm, rng)), drawn(arm, rng)
        status, numbers = both.run(mode, seed, pose[None])
        found = arm.search(pose, seed=seed, prefer=("near", "centre", "dexterous")[mode - 1])
        rows = numbers.reshape(-1, arm.DOF)
        assert status == found.status.value == "OK"
        assert np.abs(arm.forward(rows) - pose).max() < 1e-9
        costs = [[cost(arm, mode, q, seed) for q in each] for each in (rows, found.q)]
        assert costs[0][0] == pytest.approx(costs[1][0], abs=1e-5)
        for each in costs:
            assert (np.diff(each) > -1e-9).all()
        if len(arm.FREE_JOINTS) > 1:  # of one, branches that meet may have one best row
            for each in (rows, found.q):
                gaps = np.abs(np.sin(0.5 * (each[:, None] - each))).max(axis=2)
                assert (gaps + np.eye(len(each))).min() > 4e-3


@pytest.mark.long
def test_the_best_row_may_be_at_an_end_on_a_limit_or_just_before_a_fold(tmp_path: Path) -> None:
    """Where joints are on a limit by a hair, and where slopes have no digits."""
    path = tmp_path / "rounded_wrist.urdf"
    text = serial_urdf("rounded_wrist", SHOULDER_ELBOW_WRIST)
    path.write_text(
        text.replace('xyz="0 0 0.35" rpy="0 0 0"', 'xyz="0.00002 0 0.35" rpy="0 0.0005 0.0003"')
    )
    dh = read(Request(path, free={"wrist_roll": None})).dh
    both = in_both(replace(solver_module(dh), name="rounded_wrist"), tmp_path, "01")
    arm, rng = both.arm, np.random.default_rng(11)
    at_end = 0
    for _ in range(20):
        pose, seed = arm.forward(drawn(arm, rng)), drawn(arm, rng)
        _, numbers = both.run(1, seed, pose[None])
        row = numbers[: arm.DOF]
        assert np.abs(arm.forward(row) - pose).max() < 1e-8
        held = held_of(arm, row)
        ends = both.run(0, seed, pose[None])[1].reshape(-1, 3)[:, :2]
        at_end += bool(np.abs(ends - held).min() < 1e-8)
        random = rng.uniform(arm.LOWER[-1], arm.UPPER[-1], 100)
        rows = arm.solve_batch(np.repeat(pose[None], 100, axis=0), free=random[:, None])[0]
        rows = rows.reshape(-1, arm.DOF)
        best = np.nanmin(np.linalg.norm(rows - seed, axis=1))
        assert cost(arm, 1, row, seed) < best + 1e-7
    assert at_end > 2


def test_searches_from_a_row_give_it_back(both: Both) -> None:
    arm, rng = both.arm, np.random.default_rng(5)
    if len(arm.FREE_JOINTS) != 1:
        return
    for _ in range(20):
        q = drawn(arm, rng)
        _, numbers = both.run(1, q, arm.forward(q)[None])
        assert np.abs(numbers[: arm.DOF] - q).max() < 1e-6


def test_seeds_hold_their_own_values(both: Both) -> None:
    arm, rng = both.arm, np.random.default_rng(3)
    for _ in range(4):
        q = drawn(arm, rng)
        pose = arm.forward(q)
        status, numbers = both.run(5, q, pose[None])
        found = arm.solve(pose, seed=q)
        rows = numbers.reshape(-1, arm.DOF)
        assert status == "OK" and rows.shape == found.q.shape
        assert np.abs(rows - found.q).max() < 1e-8
        assert np.abs(rows[0] - q).max() < 1e-6


def test_paths(both: Both) -> None:
    arm, rng = both.arm, np.random.default_rng(4)
    seen = 0
    for _ in range(2):
        q = regular(arm, rng)
        poses = np.repeat(arm.forward(q)[None], 15, axis=0)
        poses[:, :3, 3] += np.linspace(0.0, 0.15, 15)[:, None] * rng.normal(size=3) / 1.7
        axis = rng.normal(size=3)
        turns = rotation_about(axis / np.linalg.norm(axis), 0.03 * np.arange(15))
        poses[:, :3, :3] = turns @ poses[0, :3, :3]
        status, _, rows = both.follow(q, poses)
        path = arm.follow(poses, start=q)
        assert (status, len(rows)) == (path.status.value, path.reached)
        assert np.abs(rows - path.q[: path.reached]).max() < 1e-6
        seen += path.reached
    assert seen > 15


@pytest.mark.long
def test_paths_past_a_stretched_elbow(tmp_path: Path) -> None:
    """With a joint held, and more joints than freedoms: singular there and nowhere else."""
    both = in_both(lift_scara(tmp_path), tmp_path, "4")
    start, end = (
        np.array([0.27, 0.91, -0.42, 0.09, 0.98]),
        np.array([0.48, -0.06, 0.57, 0.07, 0.52]),
    )
    for count in (60, 200, 501):
        poses = both.arm.forward(start + np.linspace(0.0, 1.0, count)[:, None] * (end - start))
        status, flags, rows = both.follow(start, poses)
        assert status == "OK" and flags <= 2
        assert np.abs(rows - both.arm.follow(poses, start=start).q).max() < 1e-6
