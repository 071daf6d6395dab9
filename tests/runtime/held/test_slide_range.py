"""Where a slide has to be for a pose, by the lengths of what it carries."""

from __future__ import annotations

from math import inf, pi, sqrt
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.support.chains import rotation, translation

from ikgen.runtime.python.arm.chain_kinematics import Motion, chain_of
from ikgen.runtime.python.held.slide_range import slide_range

TO_X = rotation([0.0, 1.0, 0.0], pi / 2)  # its z axis is x
BACK = np.linalg.inv(TO_X)
LEAN = rotation([0.0, 1.0, 0.0], pi / 4)  # its z axis between x and z


def arm(
    frames: list[Any], motions: list[Motion], lower: Any, upper: Any, position: bool = True
) -> Any:
    column = 3 if position else 2
    chain = chain_of(np.array(frames), tuple(motions), len(lower))
    return SimpleNamespace(
        chain=chain, lower=lower, upper=upper, task=SimpleNamespace(entries=((0, column),))
    )


def goal(x: float, y: float = 0.0, z: float = 0.0) -> Any:
    return translation(x, y, z)


def test_a_slide_carries_its_arm_as_near_as_the_lengths_reach() -> None:
    """Along x, from 0.2 on, an arm of 0.5 and 0.3 m behind two turns."""
    frames = [translation(0.2, 0.0, 0.0) @ TO_X, BACK, translation(0.0, 0.5, 0.0), goal(0.0, 0.3)]
    for scale, offset in ((1.0, 0.0), (2.0, 0.1), (-1.0, 0.4)):
        motions = [(0, False, scale, offset), (1, True, 1.0, 0.0), (2, True, 1.0, 0.0)]
        one = arm(frames, motions, (-5.0, -pi, -pi), (5.0, pi, pi))
        ends = sorted((1.7 - 0.2 - offset + far) / scale for far in (-0.8, 0.8))
        assert slide_range(one, goal(1.7, 0.1, 9.0), 0) == pytest.approx(tuple(ends))


def test_other_slides_add_their_travel_by_how_far_they_go_along() -> None:
    """Before the turn along x and z, then at 45 degrees, each with a travel of its own."""
    frames = [TO_X, BACK, LEAN, np.linalg.inv(LEAN), goal(0.4)]
    motions = [
        (0, False, 1.0, 0.0), (1, False, 1.0, 0.0), (2, False, 2.0, 0.1), (3, True, 1.0, 0.0),
    ]  # fmt: skip
    one = arm(frames, motions, (-9.0, -3.0, -0.2, -pi), (9.0, 7.0, 0.6, pi))
    low, high = (2.0 * x + 0.1 for x in (-0.2, 0.6))
    wanted = 1.0 - high / sqrt(2.0) - 0.4, 1.0 - low / sqrt(2.0) + 0.4
    assert slide_range(one, goal(1.0, 3.0, 0.0), 0) == pytest.approx(wanted)


def test_a_slide_behind_the_first_turn_counts_by_its_longest_travel() -> None:
    frames = [TO_X, BACK, goal(0.5), goal(0.0)]
    motions = [(0, False, 1.0, 0.0), (1, True, 1.0, 0.0), (2, False, 2.0, 0.1)]
    one = arm(frames, motions, (-9.0, -pi, -0.7), (9.0, pi, 0.3))
    assert slide_range(one, goal(2.0), 0) == pytest.approx((2.0 - 0.5 - 1.3, 2.0 + 0.5 + 1.3))
    assert slide_range(one, goal(2.0), 2) == (-inf, inf)  # it is turned


def test_slides_that_one_value_moves_add_their_ways() -> None:
    frames = [TO_X, BACK @ LEAN, np.linalg.inv(LEAN), goal(0.3)]
    motions = [(0, False, 1.0, 0.0), (0, False, 2.0, 0.5), (1, True, 1.0, 0.0)]
    one = arm(frames, motions, (-9.0, -pi), (9.0, pi))
    slope, start = 1.0 + sqrt(2.0), 0.5 / sqrt(2.0)
    wanted = (2.0 - start - 0.3) / slope, (2.0 - start + 0.3) / slope
    assert slide_range(one, goal(2.0), 0) == pytest.approx(wanted)
    opposite = [(0, False, 1.0, 0.0), (0, False, -1.0, 0.0), (1, True, 1.0, 0.0)]
    still = arm([TO_X, np.eye(4), BACK, goal(0.3)], opposite, (-9.0, -pi), (9.0, pi))
    assert slide_range(still, goal(2.0), 0) == (-inf, inf)


def test_a_task_without_a_position_bounds_nothing() -> None:
    motions = [(0, False, 1.0, 0.0), (1, True, 1.0, 0.0)]
    frames, ends = [TO_X, BACK, goal(0.5)], ((-9.0, -pi), (9.0, pi))
    assert slide_range(arm(frames, motions, *ends), goal(1.0), 0) == pytest.approx((0.5, 1.5))
    assert slide_range(arm(frames, motions, *ends, position=False), goal(1.0), 0) == (-inf, inf)
