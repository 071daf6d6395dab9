"""What is no pose, in a batch and where the arm shall come as near as it can."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from tests.support.chains import rotation, translation
from tests.support.given_rows import given_arm, given_rows

from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.solving import pose_solving
from ikgen.runtime.python.solving.asked_poses import Answer
from ikgen.runtime.python.solving.batch_solving import solve_poses
from ikgen.runtime.python.solving.pose_solving import _projected

ROW = np.array([0.3, -0.7, 0.9, 0.4, 1.1, -0.2])


def test_rotations_are_made_orthonormal_only_where_that_is_asked_for() -> None:
    arm = given_arm(given_rows(ROW[None]))
    T = np.repeat(forward(arm.chain, ROW[None]), 3, axis=0)
    T[1, :3, :3] *= 1.0 + 1e-3
    T[2, 0, 3] = inf
    q, number, status = solve_poses(arm, T, None, None, True)
    assert number.tolist() == [1, 0, 0] and status.tolist() == ["OK", "INVALID", "INVALID"]
    np.testing.assert_array_equal(q[0, 0], ROW)
    assert np.isnan(q[1:]).all() and np.isnan(q[0, 1:]).all()
    q, number, status = solve_poses(arm, T, None, None, True, orthonormalize=True)
    assert number.tolist() == [1, 1, 0] and status.tolist() == ["OK", "OK", "INVALID"]


@pytest.mark.parametrize("known", [False, True])
def test_the_row_of_the_nearest_pose_counts_where_the_closed_form_has_it_not(
    monkeypatch: pytest.MonkeyPatch, known: bool
) -> None:
    arm = given_arm(None)
    rows = [(tuple(ROW.tolist()), False)] if known else [(tuple((ROW + 0.5).tolist()), True)]
    seen = []

    def fitting(arm, asked, limits):  # type: ignore[no-untyped-def]
        seen.append(asked)
        return Answer(list(rows), True)

    monkeypatch.setattr(pose_solving, "_fitting", fitting)
    monkeypatch.setattr(pose_solving, "nearest_row", lambda *_: tuple(ROW.tolist()))
    far = (translation(9.0, 0.0, 0.0) @ rotation([0.0, 0.0, 1.0], 0.3)).tolist()
    none = Answer([], False)
    found = _projected(arm, (far, None, ()), True, none)
    assert found == (rows if known else [*rows, (tuple(ROW.tolist()), False)])
    np.testing.assert_allclose(seen[0][0], forward(arm.chain, ROW), atol=1e-15)
    full = [(tuple((ROW + 0.1 * k).tolist()), False) for k in range(1, 9)]
    rows = full
    assert _projected(arm, (far, None, ()), True, none) == full  # no more than the arm has
