"""Newton's method in stages: which rows go on."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.given_rows import given_arm

from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.newton import refinement
from ikgen.runtime.python.newton.refinement import errors_and_slopes, newton, refine

Array = NDArray[np.float64]
ARM = given_arm(None)
ROWS = np.array([[0.3, -0.7, 0.9, 0.4, 1.1, -0.2], [1.2, 0.4, -0.8, -0.5, 0.6, 2.0]])
MOVING = range(6)


def test_rows_that_are_promising_and_not_fine_go_on() -> None:
    policy = replace(ARM.policy, refinement=((1, 1e-12, 0.1), (20, 0.0, 0.0)))
    T, off = forward(ARM.chain, ROWS), np.array([[0.02], [0.03]])
    once = newton(ARM.chain, ARM.task, MOVING, ROWS + off, T, 1, policy)[1]
    assert (once > 1e-8).all() and (once < 0.1).all()
    q, error, before, _ = refine(ARM.chain, ARM.task, MOVING, ROWS + off, T, policy)
    assert error.max() < 1e-12 and np.abs(q - ROWS).max() < 1e-10
    start = np.abs(ARM.task.error(forward(ARM.chain, ROWS + off), T)).max(axis=1)
    assert (before >= start - 1e-12).all()
    for refinement_of in (((1, 1e-12, 1e-9), (20, 0.0, 0.0)), ((1, 0.09, 0.1), (20, 0.0, 0.0))):
        stopped = replace(policy, refinement=refinement_of)
        left = refine(ARM.chain, ARM.task, MOVING, ROWS + off, T, stopped)[1]
        np.testing.assert_array_equal(left, once)


def test_steps_end_where_rows_converged_or_stall() -> None:
    T = forward(ARM.chain, ROWS)
    q, error, before, slope = newton(ARM.chain, ARM.task, MOVING, ROWS, T, 9, ARM.policy)
    np.testing.assert_array_equal(q, ROWS)
    assert error.max() < 1e-14 and (before == error).all() and slope.shape == (2, 6, 6)
    beyond = T.copy()
    beyond[1, :3, 3] *= 9.0
    _, error, _, _ = newton(ARM.chain, ARM.task, MOVING, ROWS + 0.01, beyond, 40, ARM.policy)
    assert error[0] < 1e-12 and error[1] > 0.1


def test_the_smallest_singular_value_is_bounded_by_the_inverse() -> None:
    slope = np.random.default_rng(2).normal(size=(200, 6, 6))
    least = refinement.least_singular(slope)
    np.testing.assert_allclose(least, np.linalg.norm(np.linalg.inv(slope), 2, axis=(1, 2)) ** -1.0)
    for bound in (0.01, 0.1, 0.5):
        told = refinement.steeper(slope, bound)
        assert (least[told] > bound).all() and told[least > 6.0 * bound].all()


def test_steps_without_progress_are_borne_for_a_while(monkeypatch: pytest.MonkeyPatch) -> None:
    """So many of them as the policy has patience, counted anew after each that helps."""
    calls: list[int] = []
    errors: list[float] = []

    def slopes(chain: object, task: object, moving: object, q: Array, *_: object) -> object:
        calls.append(len(q))
        error = errors[min(len(calls), len(errors)) - 1]
        return np.full((len(q), 6), error), np.tile(np.eye(6), (len(q), 1, 1))

    monkeypatch.setattr(refinement, "errors_and_slopes", slopes)
    T = np.tile(np.eye(4), (2, 1, 1))
    for patience in (1, 2, 3, 5):
        policy = replace(ARM.policy, patience=patience, progress=0.5)
        for told, first in (([1.0], 1), ([1.0, 0.9, 0.4, 0.3], 3 if patience > 1 else 1)):
            calls.clear()
            errors[:] = told
            newton(ARM.chain, ARM.task, MOVING, ROWS, T, 40, policy)
            assert len(calls) == first + patience


def test_derivatives_are_in_the_order_of_the_joints_that_are_asked_for() -> None:
    arm = given_arm(None)
    q, order = np.array([[0.3, -0.7, 0.9, 0.4, 1.1, -0.2]]), [1, 2, 4, 5, 3, 0]
    T = forward(arm.chain, q)
    _, plain = errors_and_slopes(arm.chain, arm.task, range(6), q, T, None)
    _, turned = errors_and_slopes(arm.chain, arm.task, order, q, T, None)
    np.testing.assert_array_equal(turned, plain[:, :, order])
