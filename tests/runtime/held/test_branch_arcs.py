"""Folds and limits on the curve of a planar arm whose first joint is held, against its closed form."""

from __future__ import annotations

from math import atan2, cos, hypot, inf, pi, sin
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.plane_task import Plane

from ikgen.runtime.python.arm.chain_kinematics import chain_of, forward
from ikgen.runtime.python.held.arm_angle import ArmAngle
from ikgen.runtime.python.held.branch_arcs import Arcs, Points
from ikgen.runtime.python.held.branch_ends import BranchEnd, follow_ends

Array = NDArray[np.float64]
LENGTHS = (0.5, 0.4, 0.3)
POINT = (0.9, 0.35)


def planar(lower: tuple[float, ...] = (-pi,) * 3, upper: tuple[float, ...] = (pi,) * 3) -> Any:
    frames = np.tile(np.eye(4), (4, 1, 1))
    frames[1:, 0, 3] = LENGTHS
    chain = chain_of(frames, tuple((j, True, 1.0, 0.0) for j in range(3)), 3)
    policy = SimpleNamespace(limit_tolerance=1e-9)
    return SimpleNamespace(
        chain=chain, task=Plane, policy=policy, lower=lower, upper=upper, moving=(1, 2), free=(0,),
        angle=None, rounded=False, period=(2.0 * pi,) * 3,
    )  # fmt: skip


def aim() -> Array:
    T = np.eye(4)
    T[:2, 3] = POINT
    return T


def row(held: float, side: float) -> Array:
    """Of the elbow on this side."""
    x, y = POINT[0] - LENGTHS[0] * cos(held), POINT[1] - LENGTHS[0] * sin(held)
    _, a, b = LENGTHS
    elbow = side * np.arccos((x * x + y * y - a * a - b * b) / (2.0 * a * b))
    shoulder = atan2(y, x) - held - atan2(b * sin(elbow), a + b * cos(elbow))
    return np.array([held, shoulder - 2.0 * pi * round(shoulder / (2.0 * pi)), elbow])


def turn_back(side: float) -> float:
    """The values of the held joint at which the others are stretched."""
    far, (base, a, b) = hypot(*POINT), LENGTHS
    half = np.arccos((far * far + base * base - (a + b) ** 2) / (2.0 * far * base))
    return float(atan2(POINT[1], POINT[0]) + side * half)


def arcs(arm: Any, *ends: tuple[Array, Array]) -> Arcs:
    q, there = (np.array([pair[k] for pair in ends]) for k in range(2))
    return Arcs(arm, aim(), True, q, q[:, 0].copy(), there, there[:, 0].copy())


def test_the_fold_between_two_rows_is_where_the_held_value_turns_back() -> None:
    """At either end of the range, near it and far from it."""
    sense = np.array([1.0, -1.0, 1.0, -1.0])
    starts = [turn_back(s) - s * off for s, off in zip(sense, (0.02, 0.02, 0.5, 1e-7), strict=True)]
    curves = arcs(planar(), *((row(h, 1.0), row(h, -1.0)) for h in starts))
    at, good = curves.folds(sense)
    assert good.all()
    folds = [turn_back(s) for s in sense]
    assert np.abs(at.held - folds).max() < 1e-10 and (sense * (folds - at.held) > -1e-13).all()
    assert np.abs(at.q[:, 2]).max() < 1e-4 and (at.q[:, 0] == at.held).all()
    assert np.abs(forward(planar().chain, at.q)[:, :2, 3] - POINT).max() < 1e-12


def test_there_is_no_fold_on_the_other_side_nor_between_rows_of_one_branch() -> None:
    high, low = (turn_back(s) for s in (1.0, -1.0))
    middle = 0.5 * (high + low)
    pair, beside = (
        (row(high - 0.02, s) for s in (1.0, -1.0)),
        (row(middle, 1.0), row(middle + 0.1, 1.0)),
    )
    curves = arcs(planar(), tuple(pair), beside)  # type: ignore[arg-type]
    assert not curves.folds(np.array([-1.0, 1.0]))[1].any()


def test_there_is_none_where_the_curve_has_no_direction() -> None:
    """Of an arm stretched along its aim, whose joints all move it one way, to the last digit."""
    q, there = np.zeros((1, 3)), np.array([[0.1, 0.1, 0.5]])
    T = forward(planar().chain, q)[0]
    curve = Arcs(planar(), T, True, q, q[:, 0].copy(), there, there[:, 0].copy())
    assert not curve.folds(np.ones(1))[1].any()


def test_rows_that_touch_are_at_their_fold() -> None:
    q = row(turn_back(1.0) - 1e-15, 1.0)
    at, good = arcs(planar(), (q, q)).folds(np.ones(1))
    assert good[0] and at.held[0] == q[0] and (at.q[0] == q).all()


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("before", [1e-6, 0.01, 0.3])
def test_the_limit_on_the_way_to_a_fold_is_found(sense: float, before: float) -> None:
    fold = turn_back(sense)
    cut, start = fold - sense * before, fold - sense * 0.4
    limit = float(row(cut, 1.0)[2])
    arm = planar((-pi, -inf, limit), (pi, inf, 3.0))  # the elbow straightens towards the fold
    curves = arcs(arm, (row(start, 1.0), row(start, -1.0)))
    back, good = curves.folds(np.array([sense]))
    assert good[0] and back.off[0] > 0.0 > curves.start.off[0]
    at, good = curves.limits(curves.start, back)
    bent = float(row(cut, 1.0)[2] - row(cut + sense * 1e-9, 1.0)[2])
    assert good[0] and abs(at.held[0] - cut) < 1e-10 + 1e-9 / bent * 1e-9  # the tolerance of limits
    assert -1e-7 < at.off[0] <= 0.0


def test_a_limit_between_two_rows_of_a_branch_is_found() -> None:
    middle = 0.5 * (turn_back(1.0) + turn_back(-1.0))
    cut = middle + 0.04
    q, there = row(middle, -1.0), row(middle + 0.1, -1.0)
    limit = float(row(cut, -1.0)[1])
    low, high = sorted((limit, limit + np.sign(q[1] - limit) * 2.0))
    arm = planar((-pi, low, -pi), (pi, high, pi))
    curves = arcs(arm, (q, there))
    at, good = curves.limits(curves.start, curves.end)
    assert good[0] and abs(at.held[0] - cut) < 1e-8 and at.off[0] <= 0.0


def test_ends_that_are_not_on_their_curve_are_left() -> None:
    """A fold beyond the bracket; one in it, and the limit before it."""
    high = turn_back(1.0)
    q, other = row(high - 0.3, 1.0), row(high - 0.3, -1.0)
    joint: Any = SimpleNamespace(arm=planar())
    near, far = (
        BranchEnd(q[0], x, q, 0, [], True, False, other, q[0]) for x in (high - 0.1, high + 0.1)
    )
    follow_ends(joint, aim(), [near, far], True)
    assert (near.inner, near.outer) == (q[0], high - 0.1)
    assert far.inner == pytest.approx(high, abs=1e-10) and far.outer - far.inner == pytest.approx(
        1e-10, rel=1e-4
    )
    joint.arm.rounded = True  # rows may be missed beside a fold: as far again beyond is right
    follow_ends(joint, aim(), [near], True)
    assert near.inner == pytest.approx(high, abs=1e-10)
    joint.arm = planar((-pi, -inf, 0.5), (pi, inf, 3.0))
    end = BranchEnd(q[0], high + 0.1, q, 0, [], True, False, other, q[0])
    follow_ends(joint, aim(), [end], True)
    assert end.inner < high - 1e-3 and end.q[2] == pytest.approx(0.5, abs=2e-9)


def test_the_slope_of_what_an_elbow_misses_by_the_arm_angle() -> None:
    rng = np.random.default_rng(3)
    frames = np.tile(np.eye(4), (4, 1, 1))
    for k in range(1, 4):
        frames[k, :3, :3], frames[k, :3, 3] = (
            np.linalg.qr(rng.normal(size=(3, 3)))[0],
            rng.normal(size=3),
        )
    elbow = chain_of(frames, tuple((j, True, 1.0, 0.0) for j in range(3)), 3)
    angle = ArmAngle(elbow, np.eye(4), np.array([0.0, 0.0, 0.1]), 0.7)
    T = np.tile(np.eye(4), (5, 1, 1))
    T[:, :3, 3] = rng.normal(size=(5, 3))
    q, held = rng.normal(size=(5, 7)), rng.normal(size=(5, 1))
    beside = [angle.errors(q, angle.aims(T, held + by))[0] % 1.0 for by in (1e-6, -1e-6)]
    slope = (beside[0] - beside[1] + 0.5) % 1.0 - 0.5  # what is beyond the line counts 1 more
    np.testing.assert_allclose(angle.turned(q, angle.aims(T, held)), -slope / 2e-6, atol=1e-8)


class Given(Arcs):
    """A curve whose points at shares of the way are given: how far out, and how fast the held value rises,
    where that is as far along as the share, times `length`."""

    def __init__(self, off: Any, rise: Any, length: float = 1.0) -> None:
        self.found = 0
        self._function, self._stretch = (off, rise), length
        self._length = np.array([length])
        self.start, self.end = self.at(np.zeros(1)), self.at(np.ones(1))

    def at(self, share: Array) -> Points:
        off, rise = (np.array([f(x) for x in share]) for f in self._function)
        held = self._stretch * share
        return Points(share, held, held[:, None], off, rise[:, None])

    def _find(self, share: Array, near: Points) -> tuple[Points, Any]:
        self.found += 1
        return self.at(share), np.ones(1, dtype=bool)


@pytest.mark.parametrize("power", [1, 3, 9])
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_sign_is_found_however_bent_the_function_is(power: int, mirrored: bool) -> None:
    """False position alone leaves one end where it is, and creeps."""

    def rise(share: float) -> float:
        return float(0.01 - share**power if not mirrored else (1.0 - share) ** power - 0.01)

    root = 0.01 ** (1.0 / power)
    curve = Given(lambda share: -1.0, rise)
    at, good = curve.folds(np.ones(1))
    assert good[0] and abs(at.share[0] - (1.0 - root if mirrored else root)) < 1e-4
    assert rise(float(at.share[0])) ** 2 < 1e-10


@pytest.mark.parametrize("slope", [1e-4, 1.0, 1e4])
@pytest.mark.parametrize("length", [1.0, 0.01])
def test_the_last_point_inside_is_as_near_to_the_limit_as_values_are_told_apart(
    slope: float, length: float
) -> None:
    curve = Given(lambda share: slope * (share - 0.37), lambda share: 1.0, length)
    at, good = curve.limits(curve.start, curve.end)
    assert good[0] and at.off[0] <= 0.0
    assert 0.0 <= 0.37 * length - at.held[0] < 1e-10
    assert curve.found < 6  # a straight line's is met at once


def test_what_a_neighbour_foretells_is_corrected_by_no_more_than_a_radian(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    curves = arcs(planar(), (row(0.1, 1.0), row(0.2, 1.0)))
    start = curves.start
    for joint, size, way in ((1, 0.4, 0.8), (1, 3.0, 0.0), (2, 0.4, 0.8), (2, 3.0, 0.0)):
        step = size * np.eye(3)[joint - 1][None], np.ones((1, 3))
        monkeypatch.setattr(curves, "_step", lambda share, q, held, step=step: step)
        found, good = curves._find(start.share, start)
        assert not good[0] and found.q[0, joint] - start.q[0, joint] == pytest.approx(way)


def test_rows_are_off_by_how_far_they_are_outside_the_tolerance_of_limits() -> None:
    q = row(0.3, 1.0)
    low, high = (tuple(x + by for x in q) for by in (-0.5, 0.2))
    arm = planar(low, high)
    for tolerance in (0.0, 1e-9, 0.05):
        arm.policy.limit_tolerance = tolerance
        assert arcs(arm, (q, q)).start.off[0] == pytest.approx(-0.2 - tolerance, abs=1e-12)
