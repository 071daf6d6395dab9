"""Near a singularity: the root on a side, the direction that keeps its sense, what others leave."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.plane_task import Plane
from tests.support.rounded_arms import FOLDED, meeting_shoulder
from tests.support.solving import emitted

from ikgen.elimination.routine import runtime_policy
from ikgen.kinematics.modified_dh import to_dh
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arm.chain_kinematics import chain_of
from ikgen.runtime.python.newton.arm_newton import linearized
from ikgen.runtime.python.singular.fold_pair import (
    Reduced,
    _oriented,
    _Others,
    _root,
    _step,
    _still,
    approach,
    correct,
    generic,
)

Array = NDArray[np.float64]


def root(side: float, rest: float, bend: float, flow: float) -> float:
    one = [np.array([[x]]) for x in (rest, bend, flow)]
    return float(_root(np.array([side]), *one)[0])


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("bend", [2.0, -3.0])
@pytest.mark.parametrize("flow", [0.0, 1e-3, -1e-3, 0.2, -0.2])
def test_the_root_is_that_on_its_side_of_the_least(side: float, bend: float, flow: float) -> None:
    """`flow x + bend x^2 / 2 = rest` has two, beside -flow / bend."""
    rest = 0.01 * np.sign(bend)
    x = root(side, rest, bend, flow)
    assert flow * x + 0.5 * bend * x * x == pytest.approx(rest, abs=1e-14)
    assert (root(-side, rest, bend, flow) - x) * side < 0.0 or flow == 0.0
    assert root(-side, rest, bend, flow) != pytest.approx(x)


@pytest.mark.parametrize("flow", [0.0, 1e-6, -1e-6, 0.01])
def test_where_there_is_no_root_both_sides_go_to_the_least_error(flow: float) -> None:
    """With `flow` next to nothing the root formula would leap as far as it may."""
    for side in (1.0, -1.0):
        for bend in (2.0, -3.0):
            assert root(side, -0.01 * np.sign(bend), bend, flow) == pytest.approx(-flow / bend)


def test_a_straight_line_has_none_and_none_is_far() -> None:
    for side in (1.0, -1.0):
        assert root(side, 0.01, 0.0, 0.3) == 0.0  # straight: the other joints have done it all
        assert abs(root(side, 1.0, 1e-9, 0.0)) == pytest.approx(0.3)


def test_what_is_left_keeps_its_sense_however_far_its_direction_turns() -> None:
    rng = np.random.default_rng(6)
    u, s, vt = np.linalg.svd(rng.normal(size=(6, 6)))
    across = (u[:, :5] * s[:5]) @ vt[:5]
    out = _oriented(u[None, :, 5], _Others(vt[5:], u[None, :, 5], across[None], across[None]))
    for angle in np.linspace(0.1, 3.1, 7):  # the whole error space turns, out with it
        turn = np.eye(6)
        turn[np.ix_([0, 5], [0, 5])] = [
            [np.cos(angle), -np.sin(angle)],
            [np.sin(angle), np.cos(angle)],
        ]
        V = (turn @ across)[None]
        for guess in (1.0, -1.0):
            there = _oriented(guess * out @ turn.T, _Others(vt[5:], out, V, V))
            np.testing.assert_allclose(there, out @ turn.T, atol=1e-12)
    taller = np.concatenate([across, across[:1]])[None]
    given = rng.normal(size=(1, 7))
    np.testing.assert_array_equal(_oriented(given, _Others(vt[5:], given, taller, taller)), given)


def test_an_error_that_turned_little_keeps_its_sense_and_what_has_none_is_given_one(
    tmp_path: Path,
) -> None:
    """Beside a second singularity the orientation may change where the direction hardly turns."""
    module = emitted(to_dh(meeting_shoulder()), tmp_path)
    arm, q = module._ARM, np.array(FOLDED)
    T, nothing, unknown = module.forward(q), np.zeros(len(q)), 0.1 * generic(3, 6)
    at, _ = correct(arm, Reduced(q, generic(3, 6), unknown, nothing, nothing), T)
    other, _ = correct(arm, Reduced(q, generic(3, 6), -unknown, nothing, nothing), T)
    np.testing.assert_allclose(other.out, at.out, atol=1e-12)
    for _ in range(3):
        at, _ = correct(arm, at, T)
    for sense in (1.0, -1.0):
        there, _ = correct(arm, at._replace(out=sense * at.out), T)
        np.testing.assert_allclose(there.out, sense * at.out, atol=1e-6)


def test_the_direction_of_least_motion_keeps_its_sense() -> None:
    rng = np.random.default_rng(5)
    for _ in range(6):
        u, s, vt = np.linalg.svd(rng.normal(size=(6, 6)))
        slope = (u * np.array([*s[:-1], 1e-6])) @ vt
        for sense in (1.0, -1.0):
            start = sense * vt[-1] + 0.3 * rng.normal(size=6)
            found = _still(slope[None], start[None], 1e-12)[0]
            np.testing.assert_allclose(found, np.sign(start @ vt[-1]) * vt[-1], atol=1e-6)


def test_one_direction_of_the_error_is_left_and_grows_by_the_slope(tmp_path: Path) -> None:
    module = emitted(to_dh(meeting_shoulder()), tmp_path)
    arm, q = module._ARM, np.array(FOLDED)
    T = module.forward(q)

    def corrected(at: Reduced) -> Reduced:
        for _ in range(6):
            at, farthest = correct(arm, at, T)
        assert farthest.max() < 1e-12
        return at

    nothing = np.zeros(len(q))
    at = corrected(Reduced(q, generic(3, 6), generic(3, 6), nothing, nothing))
    for step in (0.3, 0.3, 1e-3):
        before, at = at, corrected(at._replace(q=at.q + step * at.still))
        error, slope = linearized(arm, at.q, T)
        np.testing.assert_allclose(error, at.left[:, None] * at.out, atol=1e-13)
        flow = np.einsum("kej,kj->ke", slope, at.still)
        np.testing.assert_allclose(-(flow * at.out).sum(axis=1), at.slope, atol=1e-12)
    assert np.abs(at.left).min() > 1e-8
    np.testing.assert_allclose((at.left - before.left) / step, before.slope, rtol=1e-2)


@pytest.mark.parametrize("off", [0.003, 1e-4])
def test_one_step_from_a_stretched_arm_goes_nearly_to_each_of_the_two_rows(off: float) -> None:
    """Of two links of 1 m, with the tip pulled back by so much; the elbow's angle is known."""
    frames = np.tile(np.eye(4), (3, 1, 1))
    frames[1:, 0, 3] = 1.0
    chain = chain_of(frames, ((0, True, 1.0, 0.0), (1, True, 1.0, 0.0)), 2)
    policy = runtime_policy(SolvePolicy())
    arm: Any = SimpleNamespace(
        chain=chain, task=Plane, policy=policy, moving=(0, 1), free=(), angle=None
    )
    T = np.tile(np.eye(4), (2, 1, 1))
    T[:, 0, 3] = 2.0 - off
    elbow = 2.0 * np.arccos(1.0 - 0.5 * off)
    q, side = np.zeros((2, 2)), np.array([1.0, -1.0])
    moved, still, x, _ = _step(arm, q, T, side, None)
    np.testing.assert_allclose(np.abs(moved[:, 1]), elbow, rtol=2e-2)
    assert moved[0, 1] * moved[1, 1] < 0.0 and x[0] * x[1] < 0.0
    np.testing.assert_allclose(np.abs(x), np.hypot(elbow, 0.5 * elbow), rtol=2e-2)
    assert np.abs(np.linalg.norm(still, axis=1) - 1.0).max() < 1e-12
    rows, lead = approach(arm, q, T, side)
    np.testing.assert_allclose(lead, np.abs(x), rtol=1e-12)
    np.testing.assert_allclose(np.abs(rows[:, 1]), elbow, rtol=1e-9)
    np.testing.assert_allclose(rows[:, 0], -0.5 * rows[:, 1], atol=1e-9)
