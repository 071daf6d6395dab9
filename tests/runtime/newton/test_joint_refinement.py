"""Newton steps of all rows at once in Python, and what they leave to others."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.cpp_modules import solver_module
from tests.support.given_rows import given_arm
from tests.support.held_arms import imported
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.runtime.python.arm.chain_kinematics import forward as arm_forward
from ikgen.runtime.python.newton import joint_refinement
from ikgen.runtime.python.newton.joint_refinement import refine_few, refine_together
from ikgen.runtime.python.newton.lane_newton import begins, ends
from ikgen.runtime.python.rows.solution_rows import sorted_rows
from ikgen.runtime.python.solving.pose_solving import solve_pose

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def doosan(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    module = solver_module("doosan_m1013")
    assert module.rounded and len(module.beside) == 6
    return import_text(emit_module(module), tmp_path_factory.mktemp("doosan"))


def apart(a: Array, b: Array) -> Array:
    return np.abs(np.remainder(a - b + math.pi, 2 * math.pi) - math.pi).max(axis=-1)


def steps(module: ModuleType, q: Array, T: Array) -> tuple[Array, Array, Array]:
    return module._ARM.together(module._ARM, q, np.broadcast_to(T, (len(q), 4, 4)))


def test_rows_close_and_none_is_lost(doosan: ModuleType) -> None:
    q = np.random.default_rng(6).uniform(-3, 3, (60, 6))
    T = doosan.forward(q)
    rows, count, _ = doosan.solve_batch(T, limits=False)
    careful = replace(doosan._ARM, together=None)
    for at, pose, many, n in zip(q, T, rows, count, strict=True):
        found = doosan.solve(pose, limits=False).q
        assert np.abs(doosan.forward(found) - pose).max() < 1e-11
        assert apart(found, at).min() < 1e-9
        assert n == len(found)
        assert all(apart(found, row).min() < 1e-9 for row in many[:n])
        before = solve_pose(careful, pose, None, None, False).q
        assert all(apart(found, row).min() < 1e-6 for row in before)


def test_a_row_near_a_solution_arrives(doosan: ModuleType) -> None:
    q = np.array([0.3, 0.4, 1.2, 0.2, 0.9, -0.4])
    for count in (5, 3000):
        starts = q + 1e-4 * np.random.default_rng(6).normal(size=(count, 6))
        done, arrived, missed = steps(doosan, starts, doosan.forward(q))
        assert arrived.all() and not missed.any() and np.abs(done - q).max() < 1e-12


def test_rows_far_from_their_solution_take_more_steps(doosan: ModuleType) -> None:
    q = np.array([0.3, 0.4, 1.2, 0.2, 0.9, -0.4])
    for count in (5, 100):
        starts = q + 0.01 * np.random.default_rng(6).normal(size=(count, 6))
        done, arrived, _ = steps(doosan, starts, doosan.forward(q))
        assert arrived.any() and np.abs(done[arrived] - q).max() < 1e-12


def test_rows_beside_folds_or_far_away_are_in_doubt(doosan: ModuleType) -> None:
    folded = np.array([0.3, 0.4, 1.2, 0.2, 1e-3, -0.4])
    regular = np.array([0.3, 0.4, 1.2, 0.2, 0.9, -0.4])
    for count in (1, 100):
        beside = folded + 0.02 * np.eye(6)[[3] * count]
        _, arrived, missed = steps(doosan, beside, doosan.forward(folded))
        assert not arrived.any() and not missed.any()
        away = np.tile(regular + 0.3, (count, 1))
        left, arrived, _ = steps(doosan, away, doosan.forward(regular))
        assert not arrived.any() and (left == away).all()


def test_a_long_first_step_beside_one_singularity_alone_leaves_no_doubt(doosan: ModuleType) -> None:
    one = np.array([0.3, 0.4, 1.2, 0.2, 0.02, -0.4])
    both = np.array([-1.58145, -0.729103, 1.57079, 1.519, -0.00454182, -2.91468])
    for count in (1, 100):
        for q, turn, alone in ((one, 0.045, True), (both, 0.03, False)):
            start = q + turn * (np.eye(6)[[3] * count] - np.eye(6)[[5] * count])
            done, arrived, missed = steps(doosan, start, doosan.forward(q))
            assert arrived.all() == arrived.any() == alone and not missed.any()
            assert np.abs(done - q).max() < 1e-9


def test_steps_near_singularities_end_at_the_round_off_that_these_enlarge(
    doosan: ModuleType,
) -> None:
    rng = np.random.default_rng(5)
    q = rng.uniform(-2.0, 2.0, (300, 6))
    q[:, 4] = rng.choice([-1, 1], 300) * 10.0 ** rng.uniform(-3.5, -2.5, 300)
    starts, T = q + 1e-5 * rng.normal(size=q.shape), doosan.forward(q)
    found = np.concatenate(
        [steps(doosan, starts[i : i + 60], T[i : i + 60])[1] for i in range(0, 300, 60)]
    )
    assert found.mean() > 0.95


def test_a_long_step_is_no_round_off_however_small_the_error() -> None:
    policy = given_arm(None).policy
    size, worst, pivot = (
        np.array([1e-9, 1e-9, 1e-5]),
        np.array([1e-15, 1e-12, 1e-15]),
        np.full(3, 1e-3),
    )
    before = np.full(3, 1e-9)
    assert begins(policy, size, worst, before, pivot, False)[0].tolist() == [True, False, False]
    near, done = ends(policy, before, size, worst, size, pivot)
    assert near.tolist() == done.tolist() == [True, False, False]


def test_a_least_error_above_zero_is_no_solution(doosan: ModuleType) -> None:
    q = np.array([0.3, 0.4, 1.2, 0.2, 0.9, -0.4])
    held = replace(doosan._ARM, moving=(0, 1, 2, 4, 5))
    held = replace(held, free=(3,))
    for count in (1, 100):
        start = q + 1e-4 * np.eye(6)[[3] * count]
        T = np.tile(doosan.forward(q), (count, 1, 1))
        _, arrived, missed = refine_together(doosan._LANES, held, start, T)
        assert missed.all() and not arrived.any()


def test_rows_at_arm_angles_are_refined_a_part_at_a_time(tmp_path: Path) -> None:
    module = imported("rounded_arm_angle", tmp_path)
    q = np.random.default_rng(7).uniform(module.LOWER, module.UPPER, (3000, 7))
    T, held = module.forward(q), module.arm_angle(q)[:, None]
    sizes: list[int] = []

    class Seen:
        def errors(self, rows: Array, aim: Array) -> tuple[Array, Array]:
            sizes.append(len(rows))
            error, slope = module._ANGLE.errors(rows, aim)
            return np.asarray(error), np.asarray(slope)

    arm = replace(module._ARM, angle=Seen())
    done, arrived, _ = arm.together(arm, q + 1e-6, module._ANGLE.aims(T, held))
    assert max(sizes) < 2000
    assert arrived.mean() > 0.9 and apart(done, q)[arrived].max() < 1e-8


def test_of_few_rows_those_that_start_too_far_off_are_given_back_as_they_were() -> None:
    """Though some of them would arrive: what they arrive at may be another's."""
    arm = given_arm(None)
    row = np.array([0.3, -0.7, 0.9, 0.4, 1.1, -0.2])
    off = np.array([1e-3, 0.01, 0.06, 0.1, 0.2])[:, None] * np.array(
        [1.0, -1.0, 1.0, 1.0, -1.0, 1.0]
    )
    T = np.tile(arm_forward(arm.chain, row), (len(off), 1, 1))
    q, arrived, missed, _ = refine_few(arm, row + off, T)
    assert arrived.tolist() == [True, True, False, False, False] and not missed.any()
    np.testing.assert_allclose(q[:2], [row, row], atol=1e-9)
    np.testing.assert_array_equal(q[2:], (row + off)[2:])


def test_a_row_that_began_badly_does_not_arrive_with_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    arm = given_arm(None)
    row = np.array([0.3, -0.7, 0.9, 0.4, 1.1, -0.2])
    start = np.array([row + 0.01, row + 0.01])
    T = np.tile(arm_forward(arm.chain, row), (2, 1, 1))
    assert refine_few(arm, start, T)[1].tolist() == [True, True]
    monkeypatch.setattr(
        joint_refinement, "begins", lambda *_: np.array([[True, False], [False] * 2])
    )
    q, arrived, missed, _ = refine_few(arm, start, T)
    assert arrived.tolist() == [True, False] and not missed.any()
    np.testing.assert_array_equal(q[1], start[1])


@pytest.mark.parametrize("count", [1, 3, 4])
def test_rows_in_any_order_come_out_in_one(count: int) -> None:
    """Values that rounding tells apart alone are the same, and the next joint's tells."""
    rng = np.random.default_rng(3)
    q = rng.uniform(-0.9, 3.0, (8, 6))
    q[:, 0] = 0.5
    q[4:, 1] = q[3, 1]
    pose = np.repeat(np.arange(2), 4)[:, None] * np.ones(1)
    turning = (True,) * 6
    wanted = sorted_rows(q, pose[:, 0].astype(np.intp), turning)
    for half in (wanted[:4], wanted[4:]):
        assert [tuple(x) for x in half] == sorted(tuple(x) for x in half)
    for _ in range(count):
        order = np.concatenate([rng.permutation(4), 4 + rng.permutation(4)])
        noisy = q + 1e-13 * rng.uniform(-1.0, 1.0, q.shape)
        found = sorted_rows(noisy[order], pose[:, 0].astype(np.intp), turning)
        np.testing.assert_allclose(found, wanted, atol=1e-12)
