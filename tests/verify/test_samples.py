"""Sets of configurations, and what the search and the descent make of them, on the six-axis arm."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.fake_arms import six_axis_oracle
from tests.support.task_spaces import TASK_SPACES

from ikgen.verify.arm import ArmUnderTest, _sampled_range, arm_under_test
from ikgen.verify.reach import _improve, farthest_configuration
from ikgen.verify.sampling import (
    _NEAR,
    _at_limits,
    _boundary,
    _near,
    _special,
    generator,
    sample_sets,
)
from ikgen.verify.screws import ScrewChain
from ikgen.verify.search import converge, find_solutions
from ikgen.verify.singularities import (
    SINGULAR_SIGMA,
    _descend,
    on_continuum,
    singular_configurations,
)

Array = NDArray[np.float64]
WRIST = np.array([0.3, 0.4, 1.0, 0.5, 0.0, 0.7])  # axes 4 and 6 in line
REGULAR = np.array([0.3, 0.4, 1.0, 0.5, 0.9, 0.7])


@pytest.fixture(scope="module")
def arm() -> ArmUnderTest:
    oracle = six_axis_oracle()
    return arm_under_test(oracle, TASK_SPACES["pose"], (oracle.lower, oracle.upper), ())


def within(arm: ArmUnderTest, low: Array | float, high: Array | float) -> ArmUnderTest:
    """The arm with other limits."""
    lower, upper = (np.zeros(arm.dof) + bound for bound in (low, high))
    return replace(
        arm, lower=lower, upper=upper, low=np.maximum(lower, -np.pi), high=np.minimum(upper, np.pi)
    )


def test_poses_near_singular_ones_are_as_near_as_told(arm: ArmUnderTest) -> None:
    rng = np.random.default_rng(0)
    assert _near(arm, np.empty((0, 6)), 8, rng).shape == (0, 6)
    singular = WRIST + np.array([np.zeros(6), [0.1, 0, 0, 0, 0, 0]])
    q = _near(arm, singular, 64, rng)
    assert 50 < len(q) <= 64 and arm.sigma(q).min() > SINGULAR_SIGMA and arm.within(q).all()
    off = np.abs(q[:, None] - singular).max(axis=2).min(axis=1)
    assert off.max() < 5.0 * max(_NEAR) and off.min() < 5.0 * min(_NEAR)
    first = np.abs(q[:, 0] - singular[0, 0]) < 0.05
    assert 0.3 < first.mean() < 0.7  # each of them in turn


def test_configurations_at_limits_have_one_joint_there_at_least(arm: ArmUnderTest) -> None:
    q = _at_limits(arm, 200, np.random.default_rng(0))
    at = (q == arm.lower) | (q == arm.upper)
    assert len(q) == 200 and at.any(axis=1).all() and not at[:, 3].any()
    assert 1.2 < at.sum(axis=1).mean() < 3.5 and arm.within(q).all()
    assert (q == arm.lower).any() and (q == arm.upper).any()
    endless = within(arm, -2e3, 2e3)
    assert _at_limits(endless, 5, np.random.default_rng(0)).shape == (0, 6)
    just = within(arm, -1e3, 1e3)
    assert len(_at_limits(just, 5, np.random.default_rng(0))) == 5


def test_special_values_may_be_the_limits_themselves(arm: ArmUnderTest) -> None:
    q = _special(within(arm, 0.0, np.pi / 2), 300, np.random.default_rng(0))
    assert not q[0].any() and (q >= 0.0).all() and (q <= np.pi / 2).all()
    for value in (0.0, np.pi / 2):
        assert (np.abs(q - value) == 0.0).any(axis=0).all()
    ends = _special(within(arm, -np.pi, -np.pi / 2), 300, np.random.default_rng(0))
    for value in (-np.pi, -np.pi / 2):
        assert (ends == value).any(axis=0).all()
    assert (ends[0] == -np.pi / 2).all()  # the first that the limits allow


def test_the_boundary_is_next_to_the_farthest_configuration(arm: ArmUnderTest) -> None:
    q = _boundary(arm, 30, np.random.default_rng(0))
    tips = np.linalg.norm(arm.oracle.forward(q)[:, :3, 3], axis=1)
    assert 10 < len(q) <= 30 and arm.within(q).all()
    assert tips.max() <= 1.4 + 1e-9 and tips.min() > 1.39
    turning = replace(arm, task=TASK_SPACES["rotation"])
    assert _boundary(turning, 30, np.random.default_rng(0)).shape == (0, 6)


def test_sets_are_as_large_as_the_samples_ask(arm: ArmUnderTest) -> None:
    for samples, some, few in ((40, 16, 12), (400, 50, 20)):
        sets = sample_sets(arm, samples, 3)
        count = {label: len(sample) for label, sample in sets.items()}
        assert count["random"] == samples and count["special"] == 2 * some
        assert count["at limits"] == some and count["outside limits"] <= some
        assert count["singular"] <= 2 * few and 0 < count["near singular"] <= 2 * few
        for label, sample in sets.items():
            assert sample.label == label
            np.testing.assert_array_equal(sample.sigma, arm.sigma(sample.q))
    again = generator(3, "random").random(4), generator(3, "special").random(4)
    assert not np.array_equal(*again) and np.array_equal(again[0], generator(3, "random").random(4))


def test_free_joints_stay_inside_their_limits_in_sets_outside(arm: ArmUnderTest) -> None:
    held = replace(within(arm, -0.5, 0.5), free=(0, 2), active=(1, 3, 4, 5))
    q = sample_sets(held, 16, 0)["outside limits"].q
    assert len(q) and (np.abs(q[:, [0, 2]]) <= 0.5).all() and not held.within(q).any()


def test_solutions_outside_of_the_limits_are_found(arm: ArmUnderTest) -> None:
    narrow = within(arm, REGULAR - 1e-3, REGULAR + 1e-3)
    poses = arm.oracle.forward(REGULAR[None])
    rng = np.random.default_rng(0)
    (found,) = find_solutions(narrow, poses, REGULAR[None], 80, rng)
    assert len(found) > 20 and (narrow.distance(found, REGULAR) > 0.1).mean() > 0.5
    T = arm.oracle.forward(found)
    assert np.abs(T - poses).max() < 1e-9


def test_newton_stops_where_the_iterations_end(arm: ArmUnderTest) -> None:
    target = arm.oracle.forward(REGULAR[None])
    start = REGULAR[None] + 0.2
    q, done = converge(arm, start, target)
    assert done.all() and np.abs(arm.oracle.forward(q) - target).max() < 1e-9
    once, not_yet = converge(arm, start, target, iterations=1)
    assert not not_yet.any() and 0.0 < np.abs(once - start).max() <= 0.6 + 1e-12
    there, at_once = converge(arm, REGULAR[None], target, iterations=1)
    assert at_once.all() and np.array_equal(there, REGULAR[None])


def test_a_step_of_the_descent_goes_to_the_nearest_singularity(arm: ArmUnderTest) -> None:
    q = WRIST + np.array([[0, 0, 0, 0, 3e-3, 0], [0, 0, 0, 0, -2e-3, 0]])
    before = arm.sigma(q)
    after = _descend(arm, q)
    assert before.min() > 1e-4 and arm.sigma(after).max() < 1e-5
    assert np.abs(after - q).max() < 5e-3
    found = singular_configurations(arm, 6, np.random.default_rng(0))
    assert (
        0 < len(found) <= 6 and arm.sigma(found).max() < SINGULAR_SIGMA and arm.within(found).all()
    )
    still = replace(arm, free=tuple(range(6)), active=())
    assert singular_configurations(still, 6, np.random.default_rng(0)).shape == (0, 6)


def test_a_joint_is_set_to_where_the_tip_is_farthest(arm: ArmUnderTest) -> None:
    q = np.random.default_rng(4).uniform(-2.0, 2.0, (5, 6))
    for joint in range(6):
        best = _improve(arm, q, joint)
        assert np.array_equal(np.delete(best, joint, axis=1), np.delete(q, joint, axis=1))
        tried = np.repeat(q[:, None], 400, axis=1)
        tried[:, :, joint] = np.linspace(-np.pi, np.pi, 400)
        far = np.linalg.norm(arm.oracle.forward(tried.reshape(-1, 6))[:, :3, 3], axis=1)
        found = np.linalg.norm(arm.oracle.forward(best)[:, :3, 3], axis=1)
        assert (found >= far.reshape(5, -1).max(axis=1) - 1e-12).all()


def test_the_reach_is_sought_from_anywhere() -> None:
    oracle, asked = six_axis_oracle(), []

    class Asked(ArmUnderTest):
        def uniform(self, rng: np.random.Generator, n: int, *, limits: bool = True) -> Array:
            asked.append(limits)
            return super().uniform(rng, n, limits=limits)

    plain = arm_under_test(oracle, TASK_SPACES["pose"], (oracle.lower, oracle.upper), ())
    arm = Asked(*(getattr(plain, name) for name in ArmUnderTest.__dataclass_fields__))
    q = farthest_configuration(arm, np.random.default_rng(0))
    assert q is not None and asked == [False]
    assert np.linalg.norm(oracle.forward(q)[:3, 3]) == pytest.approx(
        0.4 + 0.5 + 0.4 + 0.1, abs=1e-9
    )


def test_slides_without_limits_are_sampled_a_metre_to_each_side() -> None:
    period = np.array([np.inf, np.inf, np.inf, 2 * np.pi, 2 * np.pi, 2 * np.pi])
    lower = np.array([-np.inf, -0.2, -2e3, -np.inf, 1.0, 2.0])
    upper = np.array([np.inf, 0.7, 2e3, np.inf, 2.0, 9.0])
    low, high = _sampled_range(lower, upper, period)
    assert low == pytest.approx([-1.0, -0.2, -1.0, -np.pi, 1.0, 2.0])
    assert high == pytest.approx([1.0, 0.7, 1.0, np.pi, 2.0, 2.0 + 2 * np.pi])
    wide = _sampled_range(-1e3 * np.ones(6), 1e3 * np.ones(6), period)  # as far as limits go
    assert wide[0][:3] == pytest.approx([-1e3] * 3) and wide[1][:3] == pytest.approx([1e3] * 3)


def test_an_arm_angle_that_is_held_is_one_more_row(arm: ArmUnderTest) -> None:
    q = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 6))
    line, off = np.arange(18.0).reshape(3, 6), np.array([0.1, 0.2, 0.3])
    asked: list[Array] = []

    class Angle:
        upper = 0.5

        def errors(self, q: Array, aims: Array) -> tuple[Array, Array]:
            asked.append(aims)
            return off, line

        def of_rows(self, q: Array, poses: Array) -> Array:
            return q[:, 0]

        def aims(self, poses: Array, held: Array) -> Array:
            return np.concatenate([poses[:, :, 0], held], axis=1)

    held = replace(arm, angle=Angle(), held=("j2", "arm_angle"), free=(1,), active=(0, 2, 3, 4, 5))
    T, J = held.scaled_jacobian(q)
    plain = arm.scaled_jacobian(q)[1][:, :, [0, 2, 3, 4, 5]]
    np.testing.assert_allclose(J[:, :6], plain)
    np.testing.assert_allclose(J[:, 6], line[:, [0, 2, 3, 4, 5]] * 0.5 / arm.length)
    np.testing.assert_allclose(asked[0][:, 4], q[:, 0])
    aims = T.copy()
    held.scaled_jacobian(q, aims)
    assert asked[1] is aims
    np.testing.assert_allclose(held.residual(q, T, T)[:, 6], off * 0.5 / arm.length)
    np.testing.assert_array_equal(held.held_values(q, T), q[:, [1, 0]])
    assert arm.held_values(q, T) is None and arm.aims(q, T) is T


def test_ends_that_are_regular_are_no_continuum(
    arm: ArmUnderTest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor is one where the steps do not reach the pose, or come back, or all end at one place."""
    targets = arm.oracle.forward(WRIST[None])

    def told(end: Array, *, reached: bool = True, apart: bool = True) -> bool:
        count = itertools.count(1)

        def converge(
            _: ArmUnderTest, q: Array, aims: Array, *, enough: Array
        ) -> tuple[Array, NDArray[np.bool_]]:
            left = 1e-13 if len(q) == 1 else 1e-10  # then to both sides at once
            assert enough == pytest.approx(np.full(len(q), left), abs=0.0)
            one = end + (0.1 * next(count) * np.eye(6)[3] if apart else 0.0)
            return np.tile(one, (len(q), 1)), np.full(len(q), reached)

        monkeypatch.setattr("ikgen.verify.singularities.converge", converge)
        return bool(on_continuum(arm, WRIST[None], targets)[0])

    assert told(WRIST)
    assert not told(REGULAR) and not told(WRIST, reached=False)
    assert not told(WRIST, apart=False) and not told(WRIST + np.eye(6)[3], apart=False)
    slight = WRIST + 1e-3 * np.eye(6)[4]
    assert 1e-5 < arm.sigma(slight[None])[0] < 1e-2 and not told(slight)


@pytest.mark.parametrize("seed", range(3))
def test_screws_turn_and_slide_along_any_axis(seed: int) -> None:
    rng, h = np.random.default_rng(seed), 1e-6
    screws = rng.standard_normal((4, 6))
    screws[:, 3:] /= np.linalg.norm(screws[:, 3:], axis=1, keepdims=True)
    screws[2, 3:] = 0.0
    A, b = rng.standard_normal((4, 3)), rng.standard_normal(4)
    chain = ScrewChain(screws, np.eye(4), A, b)
    q = rng.standard_normal((5, 3))
    T, J = chain.forward_and_jacobian(q)
    np.testing.assert_allclose(T, chain.forward(q), atol=1e-14)
    R = T[:, :3, :3]
    np.testing.assert_allclose(R @ R.transpose(0, 2, 1), np.tile(np.eye(3), (5, 1, 1)), atol=1e-12)
    for k, step in enumerate(h * np.eye(3)):
        dT = (chain.forward(q + step) - chain.forward(q - step)) / (2 * h)
        spin = dT[:, :3, :3] @ R.transpose(0, 2, 1)
        numeric = [*dT[:, :3, 3].T, spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]]
        np.testing.assert_allclose(J[:, :, k], np.transpose(numeric), atol=1e-7)
