"""What becomes of rows that the closed form gives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from tests.support.chains import translation
from tests.support.given_rows import NONE, given_arm, given_rows

from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.solving.closed_form_rows import careful_rows, rows_beside

ROW = np.array([0.3, -0.7, 0.9, 0.4, 1.1, -0.2])
OFF = np.array([1e-3, -2e-3, 1e-3, 5e-4, -1e-3, 2e-3])


def test_rough_rows_are_refined_and_others_left_as_they_are() -> None:
    told = np.array([ROW + OFF, ROW + OFF, ROW + 1.0, ROW - OFF])
    arm = given_arm(given_rows(told, valid="xx.x", rough="x..."))
    T = forward(arm.chain, ROW[None])
    q, valid, doubt = careful_rows(arm, T, NONE, None)
    np.testing.assert_allclose(q[0, 0], ROW, atol=1e-9)
    np.testing.assert_array_equal(q[0, 1:], told[1:])
    assert valid.tolist() == [[True, True, False, True]] and not doubt.any()


def test_rough_rows_that_lead_nowhere_or_to_the_same_are_no_rows() -> None:
    told = np.array([ROW + OFF, ROW - OFF])
    arm = given_arm(given_rows(told, rough="xx"))
    T = forward(arm.chain, ROW[None])
    _, valid, _ = careful_rows(arm, T, NONE, None)
    assert valid.tolist() == [[True, False]]
    _, valid, _ = careful_rows(arm, translation(9.0, 0.0, 0.0)[None] @ T, NONE, None)
    assert not valid.any()


def test_poses_beside_are_solved_one_after_the_other() -> None:
    """Here by a closed form that gives the pose's position."""
    beside = np.array([translation(0.1, 0.0, 0.0), translation(0.0, 0.2, 0.0)])

    def branches(T, near, held):  # type: ignore[no-untyped-def]
        rows = np.repeat(T[:, None, :3, 3], 2, axis=1)
        q = np.concatenate([rows, np.broadcast_to(near[:, None, 3:], rows.shape)], axis=2)
        valid = np.tile([True, False], (len(T), 1))
        return q, valid, valid | True, valid, valid | True

    arm = given_arm(branches, beside=beside)
    T = np.array([translation(1.0, 2.0, 3.0), translation(4.0, 5.0, 6.0)])
    near = np.array([[0.0] * 3 + [7.0] * 3, [0.0] * 3 + [8.0] * 3])
    q, valid, marked, doubt = rows_beside(arm, T, near, np.zeros((2, 0)))
    assert valid.tolist() == marked.tolist() == doubt.tolist() == [[True, False] * 2] * 2
    np.testing.assert_allclose(
        q[:, ::2],
        [
            [[1.1, 2, 3, 7, 7, 7], [1, 2.2, 3, 7, 7, 7]],
            [[4.1, 5, 6, 8, 8, 8], [4, 5.2, 6, 8, 8, 8]],
        ],
    )


def test_rows_of_poses_beside_count_where_they_always_do() -> None:
    told = ROW[None] + OFF
    policy = given_arm(None).policy
    pose = forward(given_arm(None).chain, ROW[None])

    def elsewhere(T, near, held):  # type: ignore[no-untyped-def]
        """Rows at any pose but that one."""
        q, valid, *flags = given_rows(told)(T, near, held)
        return q, valid & (np.abs(T - pose).max(axis=(1, 2)) > 1e-9)[:, None], *flags

    for reach, found in ((policy.anywhere, True), (0.0, False)):
        arm = given_arm(
            elsewhere, beside=np.array([translation(1e-3, 0.0, 0.0)]),
            policy=replace(policy, beside_reach=reach),
        )  # fmt: skip
        q, valid, _ = careful_rows(arm, pose, NONE, None)
        assert valid.any() == found
        if found:
            np.testing.assert_allclose(q[valid], [ROW], atol=1e-9)
