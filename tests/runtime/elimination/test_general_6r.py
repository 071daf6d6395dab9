"""Which runs the six joints' rows are looked for in, until those found are all that is known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.given_rows import FRAMES, given_arm

from ikgen.runtime.python.elimination import general_6r
from ikgen.runtime.python.elimination.general_6r import Plan, six_joint_rows
from ikgen.runtime.python.elimination.six_joints import six_joints

Array = NDArray[np.float64]
ROWS = np.arange(24.0).reshape(4, 6) / 10.0
POLICY = given_arm(None).policy


def run(
    monkeypatch: pytest.MonkeyPatch,
    told: list[tuple[list[int], int, bool]],
    direct: int = 0,
    ways: int = 3,
    error: float = 0.0,
) -> tuple[Array, int]:
    """Rows of one pose, of runs that find some of `ROWS` each, say that there are so many, and whether
    those are all, the last of each run so far off; and how many runs that took."""
    calls = []

    def find(frames: Any, aims: Array, one: Any, turning: Any) -> Any:
        which, real, clear = told[len(calls)]
        calls.append(one)
        of = np.zeros(len(which), dtype=np.intp)
        return of, ROWS[which], np.full(len(aims), real), np.full(len(aims), clear)

    def refined(six: Any, plan: Any, pose: Any, T: Any, q: Array, policy: Any) -> Any:
        return q, np.where(np.arange(len(q)) < len(q) - 1, 0.0, error), np.zeros(len(q))

    monkeypatch.setattr(general_6r, "refined_rows", refined)
    plans = tuple((0, k, 0) for k in range(ways))
    ahead = tuple((find, (9, k, 0), 1e-7) for k in range(direct))
    plan = Plan(1.0, plans, (True,) * 6, find, ahead)
    motions = tuple((k, True, 1.0, 0.0) for k in range(6))
    pose, q, _ = six_joint_rows(
        six_joints(FRAMES, 1.0, motions, None), plan, np.eye(4)[None], POLICY
    )
    assert not pose.any()
    return q, len(calls)


def test_one_run_does_where_it_is_clear_and_finds_what_it_says(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    q, calls = run(monkeypatch, [([0, 1], 2, True)])
    assert calls == 1
    np.testing.assert_allclose(q, ROWS[:2], atol=1e-12)


def test_others_follow_until_they_find_all_that_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    two, four = ([0, 1], 2, True), ([0, 1, 2, 3], 4, True)
    assert run(monkeypatch, [([0, 1], 1, True), two])[1] == 2
    assert run(monkeypatch, [([0, 1], 2, True)][:1], ways=1)[1] == 1
    q, calls = run(monkeypatch, [([0, 1], 1, True), four, four])
    assert calls == 3
    np.testing.assert_allclose(q, ROWS, atol=1e-12)
    assert run(monkeypatch, [([0], 1, True), two, two])[1] == 3  # rows come in pairs


def test_roots_that_do_not_tell_ask_for_the_next_elimination(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of a crowd the pose displaced leads to the same again."""
    two, four = ([0, 1], 2, False), ([0, 1, 2, 3], 4, False)
    assert run(monkeypatch, [two, two, two])[1] == 3
    q, calls = run(monkeypatch, [two, two, four, four])
    assert calls == 4
    np.testing.assert_allclose(q, ROWS, atol=1e-12)


def test_more_roots_of_displaced_poses_ask_for_the_next_elimination(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    told = [([0, 1], 2, False), ([0, 1], 4, False)] + [([0, 1, 2, 3], 4, False)] * 2
    q, calls = run(monkeypatch, told)
    assert calls == 4
    np.testing.assert_allclose(q, ROWS, atol=1e-12)


def test_where_solutions_meet_the_next_elimination_settles_how_many_there_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    three = ([0, 1, 2], 2, False)
    assert run(monkeypatch, [three] * 13)[1] == 13
    monkeypatch.setattr(
        general_6r, "smallest_singular_values", lambda chain, task, moving, q: np.zeros(len(q))
    )
    q, calls = run(monkeypatch, [three] * 13)
    assert calls == 3
    np.testing.assert_allclose(q, ROWS[:3], atol=1e-12)


def test_what_a_later_elimination_says_there_is_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    told = [([0, 1], 2, False), ([0], 0, False), ([0, 1], 4, False)] + [
        ([0, 1, 2, 3], 4, False)
    ] * 2
    q, calls = run(monkeypatch, told)
    assert calls == 5
    np.testing.assert_allclose(q, ROWS, atol=1e-12)


def test_an_elimination_without_rank_confirms_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    lost, beside = ([0, 1], -1, True), ([0, 1], 2, False)
    q, calls = run(monkeypatch, [lost, beside, ([0, 1, 2, 3], 4, False), ([0, 1, 2, 3], 4, False)])
    assert calls == 4
    np.testing.assert_allclose(q, ROWS, atol=1e-12)
    nothing: tuple[list[int], int, bool] = ([], -1, True)
    assert run(monkeypatch, [nothing, ([], 0, True), ([0, 1], 2, True), ([0, 1], 2, True)])[1] == 4
    assert run(monkeypatch, [([], 0, True), ([], 0, True)])[1] == 2


def test_what_stalls_near_a_solution_asks_for_all_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    two = ([0, 1, 2], 2, False)
    assert run(monkeypatch, [two] * 9, error=1e-3)[1] == 3
    q, calls = run(monkeypatch, [two] * 13, error=1e-8)
    assert calls == 2 + 2 + 3 * 3
    np.testing.assert_allclose(q, ROWS[:2], atol=1e-12)


def test_what_a_direct_way_says_there_is_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    told = [([0, 1], 4, False), ([0, 1], 2, True)]
    q, calls = run(monkeypatch, told, direct=1)
    assert calls == 2
    np.testing.assert_allclose(q, ROWS[:2], atol=1e-12)


def test_roots_that_lead_to_nothing_leave_no_pose_without_solutions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    nothing: tuple[list[int], int, bool] = ([], 0, True)
    assert run(monkeypatch, [nothing, nothing], direct=1)[1] == 2
    q, calls = run(monkeypatch, [([], 16, True), nothing, ([0, 1], 2, True), ([0, 1], 2, True)], 1)
    assert calls == 4
    np.testing.assert_allclose(q, ROWS[:2], atol=1e-12)


def test_that_there_are_none_is_believed_of_another_elimination_that_tells_clearly(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A pose that is out of reach by little has neighbours within it, and one elimination's roots may come
    in crowds at all poses."""

    def told(*runs: tuple[int, bool]) -> list[tuple[list[int], int, bool]]:
        return [([], *one) for one in runs] + [([], 0, False)] * 10

    none, crowd, near = (0, True), (0, False), (2, True)
    assert run(monkeypatch, told(none, near, none))[1] == 3
    assert run(monkeypatch, told(crowd, crowd, none))[1] == 3
    assert run(monkeypatch, told(crowd, crowd, crowd, none))[1] == 4
    for unclear in ((none, near, crowd), (crowd, near, near), (crowd, crowd, crowd)):
        assert run(monkeypatch, told(*unclear))[1] == 1 + 1 + 2 + 3 * 3
