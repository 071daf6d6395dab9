"""Which rows are better: the costs by name, and the turns that rows are put on for them."""

from __future__ import annotations

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.elimination.routine import runtime_policy
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arm.chain_kinematics import chain_of, jacobian
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arm.whole_pose import PoseTask
from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.rows.row_preference import preference_costs, preference_of

Array = NDArray[np.float64]
LOWER = (-pi, -1.0, -inf, 0.2, -2.0, -inf)
UPPER = (pi, 3.0, inf, 0.6, 2.0, inf)
SIZE = 2.0


def arm() -> Arm:
    """Three turning joints, a slide, a turning joint, and a held one that turns without limits."""
    rng, frames = np.random.default_rng(8), np.tile(np.eye(4), (7, 1, 1))
    frames[:, :3, :3] = np.linalg.qr(rng.normal(size=(7, 3, 3)))[0]
    frames[:, :3, 0] *= np.linalg.det(frames[:, :3, :3])[:, None]
    frames[:, :3, 3] = rng.uniform(-0.5, 0.5, (7, 3))
    motions = tuple((j, j != 3, 1.0, 0.0) for j in range(6))
    return Arm(
        chain=chain_of(frames, motions, 6), task=PoseTask(SIZE), policy=runtime_policy(SolvePolicy()),
        lower=LOWER, upper=UPPER, free=(5,), free_joints=("held",), free_defaults=(0.0,), most=8,
        branches=lambda T, q0, held: ([], False),
        branches_batch=lambda T, q0, held: (T, T > 0.0, T > 0.0, T > 0.0, T > 0.0),
        beside=np.empty((0, 4, 4)), period=(*(WHOLE_TURN,) * 3, 0.0, WHOLE_TURN, WHOLE_TURN),
        moving=(0, 1, 2, 3, 4), together=None, branch_kind="number", elbow_end=0, around=None,
    )  # fmt: skip


SEED = (0.5, 2.5, -7.0, 0.3, 1.0, 9.0)


def test_near_takes_the_seed_and_weighs_all_joints_alike() -> None:
    assert preference_of(arm(), "near", SEED) == ("near", SEED, (1.0,) * 6)


@pytest.mark.parametrize("prefer", ["near", "centre", "dexterous"])
def test_without_a_seed_rows_are_wanted_in_the_middle_of_the_limits(prefer: str) -> None:
    name, middle, weights = preference_of(arm(), prefer, None)
    assert name == prefer
    assert middle == pytest.approx((0.0, 1.0, 0.0, 0.4, 0.0, 0.0))
    halves = np.array([pi, 2.0, inf, 0.2, 2.0, inf])
    assert weights == pytest.approx(1.0 / halves**2)


@pytest.mark.parametrize("prefer", ["centre", "dexterous"])
def test_joints_without_a_middle_are_wanted_near_the_seed(prefer: str) -> None:
    _, middle, weights = preference_of(arm(), prefer, SEED)
    assert middle == pytest.approx((0.0, 1.0, -7.0, 0.4, 0.0, 9.0)) and weights[2] == 0.0


def test_limits_that_leave_one_value_weigh_what_is_finite() -> None:
    fixed = replace(arm(), lower=(0.5, *LOWER[1:]), upper=(0.5, *UPPER[1:]))
    _, middle, weights = preference_of(fixed, "centre", None)
    assert middle[0] == 0.5 and weights[0] == pytest.approx(1e12)


def test_other_words_are_refused() -> None:
    with pytest.raises(ValueError, match="prefer is 'far'"):
        preference_of(arm(), "far", None)
    with pytest.raises(ValueError, match="seed has shape"):
        preference_of(arm(), "near", (0.0,) * 5)


def rows() -> Array:
    q = np.random.default_rng(2).uniform(-pi, pi, (4, 3, 6))
    q[..., 3] = np.random.default_rng(3).uniform(0.1, 0.7, (4, 3))
    return q


@pytest.mark.parametrize("limits", [True, False])
def test_rows_come_on_the_turns_next_to_what_is_wanted(limits: bool) -> None:
    one, q = arm(), rows()
    before = q.copy()
    out, cost, inside = preference_costs(one, preference_of(one, "near", SEED), q, limits)
    np.testing.assert_array_equal(q, before)
    turns = (out - q) / (2.0 * pi)
    turning = [0, 1, 2, 4, 5]
    np.testing.assert_allclose(
        turns[inside][:, turning], np.round(turns[inside][:, turning]), atol=1e-9
    )
    assert (
        np.abs(out[..., [2, 5]] - np.array(SEED)[[2, 5]]).max() <= pi + 1e-9
    )  # nothing stops them
    np.testing.assert_allclose(cost, ((out - np.array(SEED)) ** 2).sum(axis=2))
    slide = (q[..., 3] >= 0.2) & (q[..., 3] <= 0.6)
    assert not limits or not inside[~slide].any()
    assert inside.any() and (inside.all() == (not limits))


def test_the_middle_counts_in_halves_of_the_range() -> None:
    one = arm()
    wanted = preference_of(one, "centre", None)
    q = np.array([[[1.0, 2.0, 3.0, 0.5, -1.0, 2.0]]])
    _, cost, inside = preference_costs(one, wanted, q, True)
    assert inside.all()
    assert cost[0, 0] == pytest.approx((1.0 / pi) ** 2 + 0.25 + 0.25 + 0.25)


def test_dexterous_is_the_least_singular_value() -> None:
    one, q = arm(), rows()
    _, cost, _ = preference_costs(one, preference_of(one, "dexterous", None), q, False)
    J = jacobian(one.chain, q.reshape(-1, 6))
    least = np.linalg.svd(J, compute_uv=False)[:, -1].reshape(4, 3)
    np.testing.assert_allclose(cost, -least, atol=1e-12)
