"""Near a singularity: the root on a side, the direction that keeps its sense, what others leave."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.rounded_arms import FOLDED, meeting_shoulder
from tests.support.solving import emitted

from ikgen.kinematics.modified_dh import to_dh
from ikgen.runtime.python.arm_newton import linearized
from ikgen.runtime.python.fold_pair import Reduced, _root, _still, correct, generic


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
