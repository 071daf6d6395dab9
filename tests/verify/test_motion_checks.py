"""Checks of paths, searches and intervals notice what is wrong with them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.fake_arms import six_axis_oracle
from tests.support.solving import FIXTURES

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request
from ikgen.tasks import find_task
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.motion_checks import (
    REGULAR_ON_PATH,
    check_self_motion,
    motion_checks,
    regular_motions,
)
from ikgen.verify.oracle import oracle_from_dh
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.sampling import generator
from ikgen.verify.task_space import task_space

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]


class Moving:
    """A runner of one that knows the motions; told to be wrong in some way."""

    moves = has_self_motion = True

    def __init__(self, arm: ArmUnderTest, ends: Array, wrong: str = "") -> None:
        self.arm, self.ends, self.wrong = arm, iter(ends), wrong

    def follow(self, poses: Array, start: Array) -> tuple[Array, str, NDArray[np.bool_]]:
        q = np.array([start, next(self.ends)])
        if self.wrong == "stops":
            q[1] = np.nan
        if self.wrong == "leaves the pose":
            q[1, 0] += 1e-7
        if self.wrong == "other branch":
            q[1, [3, 4, 5]] = q[1, 3] + np.pi, -q[1, 4], q[1, 5] + np.pi
        status = "SINGULAR" if self.wrong in ("stops", "wrong status") else "OK"
        return q, status, np.array([False, self.wrong == "across a singularity"])

    def search(self, pose: Array, seed: Array) -> Array:
        if self.wrong == "finds nothing":
            return np.empty((0, 6))
        if self.wrong == "finds it twice":
            return np.stack([seed, seed])
        return seed[None] + (2e-6 if self.wrong == "finds it nearly" else 0.0)

    def self_motion(self, pose: Array) -> Array:
        return np.array([[-4.0, -3.5], [-3.2, 3.2]])[: 1 if self.wrong == "too narrow" else 2]


def arm(held: tuple[str, ...] = ()) -> ArmUnderTest:
    free = np.full(6, np.inf)
    return arm_under_test(six_axis_oracle(), task_space(find_task("pose")), (-free, free), held)


def failures(a: ArmUnderTest, wrong: str) -> dict[str, tuple[int, int]]:
    motions = regular_motions(a, generator(0, "motions"))
    checks = motion_checks(a, Moving(a, motions.end, wrong), motions)
    found = [check() for check in checks.values()]
    assert all(bool(one.worst_case) == (one.failures > 0) for one in found)
    return {one.name: (one.failures, one.count) for one in found}


def test_motions_are_regular_and_inside_the_limits() -> None:
    a = replace(arm(), lower=np.full(6, -1.0), upper=np.full(6, 1.0))
    a = replace(a, low=a.lower, high=a.upper)
    motions = regular_motions(a, generator(3, "motions"))
    assert len(motions.start) == 15
    middle = 0.5 * (motions.start + motions.end)
    for q in (motions.start, middle, motions.end):
        assert (a.sigma(q) > REGULAR_ON_PATH).all() and a.within(q).all()
    moved = np.abs(motions.end - motions.start)
    assert 0.15 < moved.max() <= 0.2
    assert (np.abs(np.sign(motions.end - motions.start).mean(axis=0)) < 0.9).all()  # both ways
    assert np.array_equal(motions.poses[:, 1], a.oracle.forward(motions.end))


def test_limits_that_are_close_leave_room_for_motions() -> None:
    a = arm()
    lower, upper = np.full(6, -1.5), np.full(6, 1.5)
    lower[5], upper[5] = 0.3, 0.4
    a = replace(a, lower=lower, upper=upper, low=lower, high=upper)
    motions = regular_motions(a, generator(0, "motions"))
    assert len(motions.start)
    for q in (motions.start, motions.end):
        assert ((q[:, 5] >= 0.31) & (q[:, 5] <= 0.39)).all()


def test_intervals_that_meet_may_have_one_best_row() -> None:
    a = arm((six_axis_oracle().joint_names[0],))
    assert failures(a, "finds it twice")["search"] == (0, 3)


def test_what_is_right_passes() -> None:
    a = arm((six_axis_oracle().joint_names[0],))
    assert failures(a, "") == {"paths": (0, 15), "search": (0, 3), "self motion": (0, 3)}


@pytest.mark.parametrize(
    ("wrong", "check", "count"),
    [
        ("stops", "paths", 15),
        ("wrong status", "paths", 15),
        ("leaves the pose", "paths", 15),
        ("across a singularity", "paths", 15),
        ("other branch", "paths", 15),
        ("finds nothing", "search", 3),
        ("finds it nearly", "search", 3),
        ("finds it twice", "search", 3),
        ("too narrow", "self motion", 3),
    ],
)
def test_what_is_wrong_fails(wrong: str, check: str, count: int) -> None:
    a = arm()
    if check == "self motion":
        a = arm((six_axis_oracle().joint_names[0],))
    found = failures(a, wrong)
    assert found.pop(check) == (count, count)
    assert all(failed == 0 for failed, _ in found.values())


@pytest.mark.parametrize(
    ("low", "high", "failures"),
    [
        (0.0, 0.0, 0), (5e-7, 1.0, 0), (-1.0, -5e-7, 0), (2e-6, 1.0, 3), (-1.0, -2e-6, 3),
        (2.0, 3.0, 3), (-3.0, -2.0, 3),
    ],
)  # fmt: skip
def test_an_interval_holds_its_ends(low: float, high: float, failures: int) -> None:
    a = arm((six_axis_oracle().joint_names[0],))
    motions = regular_motions(a, generator(0, "motions"))
    ends = iter(motions.start[:, 0])

    class Around(Moving):
        def self_motion(self, pose: Array) -> Array:
            value = next(ends)
            return np.array([[value - 9.0, value - 8.0], [value + low, value + high]])

    found = check_self_motion(a, Around(a, motions.end), motions)
    assert (found.failures, found.count) == (failures, 3)
    assert ("motion #0" in found.worst_case) == (failures > 0)


def test_a_module_that_turns_the_wrong_way_between_poses_is_noticed(tmp_path: Path) -> None:
    module = derive(Request(FIXTURES / "ur5e.urdf")).module
    text = emit_module(module)
    failed = []
    for name, axis in (("right", "axis"), ("wrong", "-axis")):
        path = tmp_path / f"{name}_ik.py"
        path.write_text(text.replace("np.cross(np.eye(3), axis)", f"np.cross(np.eye(3), {axis})"))
        runner = PythonModule(path)
        limits = runner.constants.lower, runner.constants.upper
        a = arm_under_test(oracle_from_dh(module.dh), task_space(find_task("pose")), limits, ())
        checks = motion_checks(a, runner, regular_motions(a, generator(0, "motions")))
        failed.append(checks["paths"]().failures)
    assert failed[0] == 0 and failed[1] > 3


def test_what_follows_a_joint_moves_no_farther_than_a_joint() -> None:
    a = arm()
    A = np.array(a.screws.A)
    A[1, 0] = -4.0
    fast = replace(a, screws=replace(a.screws, A=A))
    assert fast.fastest.tolist() == [4.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    assert a.fastest.tolist() == [1.0] * 6
    motions = regular_motions(fast, generator(0, "motions"))
    moved = np.abs(motions.end - motions.start).max(axis=0)
    assert 0.03 < moved[0] <= 0.05 and (moved[1:] > 0.15).all()


def test_motions_between_narrow_limits_are_as_short_as_what_lies_beside_them_asks() -> None:
    """Half of a motion's square fits into a tenth of the limits of the joint that has least room."""
    a = arm()
    for width, longest in ((1e-2, (2.0 * 1e-3) ** 0.5), (1e-6, (2.0 * 1e-7) ** 0.5), (4.0, 0.2)):
        lower, upper = np.full(6, -1.5), np.full(6, 1.5)
        lower[4], upper[4] = 0.5 - 0.5 * width, 0.5 + 0.5 * width
        narrow = replace(a, lower=lower, upper=upper, low=lower, high=upper)
        motions = regular_motions(narrow, generator(0, "motions"))
        moved = np.abs(motions.end - motions.start).max(axis=0)
        assert len(motions.start) and 0.6 * longest < moved[:4].max() <= longest
