"""What is made of rows of poses that leave joints free, and of those that poses beside have."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.chains import translation
from tests.support.given_rows import NONE, given_arm, given_rows

from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.singular.meeting_rows import Led
from ikgen.runtime.python.solving import doubtful_rows
from ikgen.runtime.python.solving.asked_poses import Answer, Asked
from ikgen.runtime.python.solving.closed_form_rows import all_rows
from ikgen.runtime.python.solving.doubtful_poses import _goes_on, placed_rows
from ikgen.runtime.python.solving.doubtful_rows import unplaced_rows

Array = NDArray[np.float64]
ROW = np.array([0.3, -0.7, 0.9, 0.4, 1.1, -0.2])
OTHER = np.array([1.3, 0.7, -0.9, 1.4, -1.1, 2.2])
OFF = np.array([1e-3, -2e-3, 1e-3, 5e-4, -1e-3, 2e-3])


def pose_of(arm: Arm, row: Array = ROW) -> Array:
    return forward(arm.chain, row[None])


def not_there(*_: Any) -> Any:
    raise AssertionError


def test_rows_are_marked_that_the_closed_form_has_as_of_a_continuum() -> None:
    """And not what it marks, but has not."""
    third = OTHER + 0.5
    arm = given_arm(given_rows(np.array([ROW, OTHER, third]), valid="xx.", singular=".xx"))
    for kept in (
        unplaced_rows(arm, pose_of(arm), NONE)[0],
        placed_rows(arm, Asked(pose_of(arm), None, NONE), True)[0].rows,
    ):
        flags = {round(row[0], 6): flag for row, flag in kept}
        assert flags[0.3] is False and flags[1.3] is True and 1.8 not in flags


def test_rows_that_poses_beside_have_count() -> None:
    plain = given_arm(not_there)
    pose = pose_of(plain)

    def beside(T: Array, near: Array, held: Array) -> Any:
        q, valid, *flags = given_rows(ROW[None] + OFF)(T, near, held)
        return q, valid & (np.abs(T - pose).max(axis=(1, 2)) > 1e-9)[:, None], *flags

    policy = replace(plain.policy, beside_reach=plain.policy.anywhere)
    arm = given_arm(beside, beside=translation(1e-3, 0.0, 0.0)[None], policy=policy)
    for kept in (
        unplaced_rows(arm, pose, NONE)[0],
        placed_rows(arm, Asked(pose, None, NONE), True)[0].rows,
    ):
        assert len(kept) == 1 and kept[0][1] is False
        np.testing.assert_allclose(kept[0][0], ROW, atol=1e-9)


def test_where_a_free_joint_leads_nowhere_other_values_are_tried() -> None:
    """One after the other, till one leads somewhere."""
    step = given_arm(not_there).policy.try_step
    tries = given_arm(not_there).policy.tries
    asked: list[list[float]] = []

    for wanted in (1, 2, tries - 1):

        def branches(T: Array, near: Array, held: Array, wanted: int = wanted) -> Any:
            asked.append(near[:, 0].tolist())
            q, valid, *_ = given_rows(OTHER[None])(T, near, held)
            led = np.abs(near[:, :1] - wanted * step) < 1e-9
            return q, valid & led, valid, ~valid, ~valid

        arm = given_arm(branches)
        far = translation(0.0, 0.0, 50.0)[None]  # where no Newton step leads anywhere
        (answer,) = placed_rows(arm, Asked(far, None, NONE), True)
        assert [row for row, _ in answer.rows] == [tuple(OTHER.tolist())] and answer.real
    assert asked[0] == [0.0]
    assert np.allclose(asked[1], step * np.arange(1, tries))


def test_a_divisor_that_nearly_vanishes_is_given_other_directions() -> None:
    """By poses beside, which leave the joint free too; further values are the pose's own."""
    motion, asked = translation(1e-3, 0.0, 0.0), []
    far = translation(0.0, 0.0, 50.0)[None]

    def branches(T: Array, near: Array, held: Array) -> Any:
        asked.append(T)
        at = (np.abs(T - far).max(axis=(1, 2)) < 1e-9)[:, None]
        q, *_ = given_rows(OTHER[None])(T, near, held)
        return q, np.zeros_like(at), at, ~at, np.zeros_like(at)

    arm = given_arm(branches, beside=motion[None])
    (answer,) = placed_rows(arm, Asked(far, None, NONE), True)
    assert not answer.rows
    later = next(T for T in asked if len(T) == arm.policy.tries - 1)
    np.testing.assert_allclose(later[:1], far @ motion)
    np.testing.assert_allclose(later[1:], np.repeat(far, len(later) - 1, axis=0))


@pytest.mark.parametrize("rounded", [False, True])
def test_other_values_are_tried_till_a_row_of_the_continuum_is_there(rounded: bool) -> None:
    """Of a rounded arm, till the closed form led to one."""
    arm = given_arm(not_there, together=not_there if rounded else None)
    asked = Asked(pose_of(arm), None, NONE)

    def goes_on(rows: list[tuple[Array, bool]], free: bool, led: bool) -> bool:
        kept = [(tuple(row.tolist()), flag) for row, flag in rows]
        answer = Answer()
        told = _goes_on(arm, asked, 0, (kept, free, led), [], False, answer)
        assert len(answer.rows) == len(rows) and answer.real is bool(rows)
        return told

    regular, singular = (ROW, False), (OTHER, True)
    for rows in ([], [regular], [singular], [regular, singular]):
        for led in (False, True):
            assert not goes_on(rows, False, led)
            enough = led if rounded else any(flag for _, flag in rows)
            assert goes_on(rows, True, led) is not (len(rows) > 0 and enough)


def test_rows_behind_a_free_joint_are_refined_though_they_miss() -> None:
    def together(arm: Arm, q: Array, T: Array) -> Any:
        none = np.zeros(len(q), dtype=bool)
        return q, none, ~none

    told = given_rows(ROW[None] + OFF, valid=".", singular="x", rough="x")
    for rounded in (False, True):
        arm = given_arm(told, together=together if rounded else None)
        pose = pose_of(arm)
        kept = unplaced_rows(arm, pose, NONE)[0]
        for row, _ in kept:
            np.testing.assert_allclose(forward(arm.chain, row), pose[0], atol=1e-9)
        assert any(np.abs(np.array(row) - ROW).max() < 1e-6 for row, _ in kept)


def test_poses_beside_are_left_alone_where_rows_are_regular() -> None:
    """Unless they always count."""
    plain = given_arm(not_there)
    pose, asked = pose_of(plain), []

    def rows(T: Array, near: Array, held: Array) -> Any:
        asked.append(float(np.abs(T - pose).max()))
        return given_rows(np.array([ROW + OFF]), rough="x")(T, near, held)

    for reach in (0.0, plain.policy.anywhere):
        arm = given_arm(
            rows,
            beside=translation(1e-3, 0.0, 0.0)[None],
            policy=replace(plain.policy, beside_reach=reach),
        )
        asked.clear()
        assert len(unplaced_rows(arm, pose, NONE)[0]) == 1
        assert (max(asked) > 1e-9) == (reach > 0.0)


@pytest.mark.parametrize("inside", [True, False])
def test_what_a_seed_leads_to_counts_where_no_other_row_is_inside(inside: bool) -> None:
    arm = given_arm(given_rows(ROW[None]), lower=(-1.5,) * 6, upper=(1.5,) * 6)
    T = pose_of(arm)
    if not inside:  # what the closed form says is the row is out of the limits
        arm = replace(arm, branches_batch=given_rows(np.array([[0.3, -0.7, 0.9, 0.4, 2.9, -0.2]])))
    (answer,) = placed_rows(arm, Asked(T, ROW[None] + 0.01, NONE), True)
    assert len(answer.rows) == 1 and answer.real
    np.testing.assert_allclose(answer.rows[0][0], ROW, atol=1e-9)


@pytest.mark.parametrize("free", [False, True])
def test_beside_a_singular_row_the_seeds_own_counts_where_no_joint_is_free(free: bool) -> None:
    arm = given_arm(not_there)
    asked = Asked(pose_of(arm), ROW[None], NONE)
    regular, singular = (tuple(ROW.tolist()), False), (tuple(OTHER.tolist()), True)
    for kept, wanted in (
        ([singular], [singular] if free else [singular, regular]),
        ([(singular[0], False)], [(singular[0], False)]),
    ):
        answer = Answer()
        _goes_on(arm, asked, 0, (list(kept), free, True), [regular], False, answer)
        assert sorted(answer.rows, key=lambda one: not one[1]) == wanted


def test_rows_are_singular_by_what_is_lost_there(monkeypatch: pytest.MonkeyPatch) -> None:
    """By more where the closed form says that they are of a continuum."""
    arm = given_arm(not_there)
    flat, continuum = arm.policy.singular_below, arm.policy.continuum_below
    assert 0.0 < flat < continuum
    sigma = np.array([0.5 * flat, 2.0 * flat, 2.0 * continuum] * 2)
    q = ROW + 0.2 * np.arange(6.0)[:, None]
    owner = np.array([0, 0, 0, 1, 1, 1])
    monkeypatch.setattr(doubtful_rows, "rows_nearby", lambda *_: Led(owner, q, sigma))
    starts: Any = SimpleNamespace(pose=np.array([1, 0]), marked=np.array([False, True]))
    leads: Any = SimpleNamespace(starts=starts)
    asked = Asked(np.tile(np.eye(4), (2, 1, 1)), None, np.zeros((2, 0)))
    marked, plain = doubtful_rows._meeting(arm, asked, leads)
    assert [flag for _, flag in plain] == [True, False, False]
    assert [flag for _, flag in marked] == [True, True, False]
    assert [row for row, _ in plain] == [tuple(row) for row in q[:3].tolist()]


def test_beside_regular_rows_steps_lead_on_from_those_that_miss_behind_a_free_joint() -> None:
    """Of each branch from the value whose pose is nearest, and inside the limits."""
    plain, far = given_arm(not_there), 0.9 * np.ones(6)

    def branches(T: Array, near: Array, held: Array) -> Any:
        q, *flags = given_rows(np.array([OTHER, ROW + OFF]), "x.", ".x")(T, near, held)
        q[:, 1] += np.where(np.abs(near[:, :1] - 3.0 * plain.policy.try_step) < 1e-9, 0.0, far)
        return q, *flags

    for lower, found in ((-2.0 * np.pi, True), (0.0, False)):
        arm = given_arm(branches, lower=(lower,) * 6)
        (answer,) = placed_rows(arm, Asked(pose_of(arm), None, NONE), True)
        there = [np.abs(np.array(row) - ROW).max() < 1e-6 for row, _ in answer.rows]
        assert any(there) == found and (not found or answer.real)


def test_rows_of_poses_beside_are_in_doubt_only_where_one_of_the_pose_is() -> None:
    motion = translation(1e-3, 0.0, 0.0)
    plain = given_arm(given_rows(ROW[None]))
    pose = pose_of(plain)

    def marks(own: str, beside: str) -> list[list[bool]]:
        def branches(T: Array, near: Array, held: Array) -> Any:
            at_pose = (np.abs(T - pose).max(axis=(1, 2)) < 1e-9)[:, None]
            q, valid, singular, rough, _ = given_rows(ROW[None], rough="x")(T, near, held)
            doubt = np.where(at_pose, own == "x", beside == "x")
            return q, valid, singular, rough, doubt

        policy = replace(plain.policy, beside_reach=plain.policy.anywhere)
        arm = given_arm(branches, beside=motion[None], policy=policy)
        asked = Asked(pose, None, NONE)
        closed = all_rows(arm, pose, None, NONE)
        starts = doubtful_rows._beside(arm, asked, np.zeros((1, 6)), np.array([0]), closed.own)
        return [(closed.own.singular | closed.own.doubt)[0].tolist(), starts.marked.tolist()]

    assert marks("x", "x") == [[True], [True]]
    assert marks("", "x") == [[False], [False]]
    assert marks("x", "") == [[True], [False]]
