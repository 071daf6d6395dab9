"""How far rows are outside the limits, on whatever turn, and which joints have limits to speak of."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np

from ikgen.runtime.python.arm.limit_margins import bounded_joints, offsets, outside
from ikgen.runtime.python.arrays.angles import WHOLE_TURN

INF = math.inf
ARM = SimpleNamespace(
    moving=(0, 1, 2, 3, 5),
    lower=np.array([-1.0, -4.0, 0.2, -INF, -1.0, -INF]),
    upper=np.array([3.0, 4.0, INF, INF, 1.0, 0.5]),
    period=(WHOLE_TURN, WHOLE_TURN, 0.0, 0.0, WHOLE_TURN, 0.0),
)
"""A turning joint with limits, one with more than a turn, a slide bounded below, one without limits, a
joint that is held, a slide bounded above."""


def test_joints_that_are_bounded() -> None:
    assert [(j, period > 0.0) for j, _, _, period in bounded_joints(ARM)] == [
        (0, True), (2, False), (5, False)
    ]  # fmt: skip
    (_, middle, half, _), (_, low, wide, _), (_, high, large, _) = bounded_joints(ARM)
    assert (middle, half) == (1.0, 2.0)
    np.testing.assert_allclose([low - wide, low + wide], [0.2, 1e6], atol=1e-9)
    np.testing.assert_allclose([high - large, high + large], [-1e6, 0.5], atol=1e-9)


def test_a_turn_is_nothing_to_a_joint_that_turns() -> None:
    x = np.array([1.5, 1.5 + 4.0 * math.pi, 1.0 - math.pi + 0.1])
    np.testing.assert_allclose(offsets(x, 1.0, math.tau), [0.5, 0.5, -math.pi + 0.1])
    np.testing.assert_allclose(offsets(x, 1.0, 0.0), x - 1.0)


def test_the_most_that_a_row_is_outside() -> None:
    inside = [1.0, 9.0, 0.7, 99.0, 9.0, 0.0]
    rows = np.array([inside, inside, inside, inside])
    rows[1, 0] = 3.25 - 2.0 * math.pi
    rows[2, 2] = -0.1
    rows[3, 5] = 0.75
    np.testing.assert_allclose(outside(ARM, rows, True), [-0.5, 0.25, 0.3, 0.25], atol=1e-9)
    assert (outside(ARM, rows[None], False) == -INF).all()
