"""Which of what Newton steps lead to are solutions of their own."""

from __future__ import annotations

from math import pi
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.plane_task import Plane

from ikgen.runtime.python.arm.chain_kinematics import chain_of, forward
from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.rows.row_placement import is_new
from ikgen.runtime.python.singular import meeting_rows
from ikgen.runtime.python.singular.meeting_rows import (
    Ends,
    Leads,
    Led,
    Starts,
    leads_of,
    repeats,
    rows_nearby,
    that_differ,
)

Array = NDArray[np.float64]
POLICY = SimpleNamespace(
    broken_reach=0.1, fold_reach=0.01, converged=1e-12, arrived=1e-9, exact=1e-10, coincident=1e-6,
    neighbouring=0.3, halfway=1e-9,
)  # fmt: skip


def leads_of_rows(q: list[float], source: list[int], sigma: list[float], marked: str = "") -> Leads:
    n = len(q)
    rows, flags = np.array(q)[:, None], np.array([c == "x" for c in marked.ljust(n, ".")])
    T = np.arange(n)[:, None, None] * np.ones((n, 4, 4))
    starts = Starts(rows, T, np.zeros(n, np.intp), flags, np.array(source), np.zeros(n, np.intp))
    none = Led(np.zeros(0, np.intp), rows[:0], np.zeros(0))
    return Leads(starts, Ends(rows, np.zeros(n), np.array(sigma)), none, np.zeros(n, dtype=bool))


def test_continua_are_followed_from_where_own_rows_near_singularities_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Not from where what is given does, what poses beside have, or what is regular."""
    seen: list[Any] = []
    sigmas = np.array([0.0, 0.0, 0.0, 0.02, 0.0, 0.0])

    def ends(arm: Any, q: Array, T: Array) -> Ends:
        return Ends(q + 100.0, np.zeros(len(q)), sigmas[q[:, 0].astype(int)])

    def around(arm: Any, q: Array, T: Array, lie: Any) -> Any:
        seen.append((q[:, 0].tolist(), T[:, 0, 0].tolist(), lie.tolist()))
        curve = np.array([False, True, True])
        return (
            curve,
            np.array([1, 2, 2]),
            np.array([[7.0], [8.0], [9.0]]),
            np.array([0.5, 0.6, 0.7]),
        )

    monkeypatch.setattr(meeting_rows, "ends_of", ends)
    arm: Any = SimpleNamespace(policy=POLICY, around=around, rounded=True)
    starts = leads_of_rows(
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], [-1, 0, 1, 0, 0, 0], [0.0] * 6, "....x."
    ).starts
    starts = starts._replace(lane=np.arange(6))
    known = np.zeros((1, 6), dtype=bool)
    found = leads_of(arm, starts, known, near=True)
    assert seen == [([101.0, 4.0, 105.0], [1.0, 4.0, 5.0], [True, False, True])]
    assert found.known.tolist() == [False] * 4 + [True] * 2
    assert known.tolist() == [[False] * 4 + [True, False]]
    assert found.around.owner.tolist() == [4, 5, 5]
    assert found.around.q[:, 0].tolist() == [7.0, 8.0, 9.0]
    assert found.around.sigma.tolist() == [0.5, 0.6, 0.7]
    assert found.starts.marked.tolist() == [False] * 4 + [True, False]
    plain = leads_of(arm, starts._replace(marked=starts.marked & False), known & False)
    assert len(seen) == 1 and not plain.known.any() and not len(plain.around.owner)


@pytest.mark.parametrize(
    ("ends", "sigma", "error", "lost"),
    [
        ((7.0, 7.0, 5.0), 1e-6, 0.0, [True, True, False]),
        ((7.0, 7.0 + 2.0 * pi, 5.0), 1e-6, 0.0, [True, True, False]),
        ((7.0, 6.0, 5.0), 1e-6, 0.0, [False] * 3),
        ((7.0, 7.0, 5.0), 1e-12, 0.0, [False] * 3),  # the pose is theirs all along
        ((7.0, 7.0, 5.0), 1e-6, 2e-10, [True] * 3),  # none is right to round-off
    ],
)
def test_marked_rows_that_come_to_one_solution_are_followed(
    ends: tuple[float, ...],
    sigma: float,
    error: float,
    lost: list[bool],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Where the arm is what was solved others are its own."""
    to = np.array(ends)[:, None]

    def led(arm: Any, q: Array, T: Array) -> Ends:
        some = q[:, 0].astype(int)
        return Ends(to[some], np.full(len(q), error), np.full(len(q), sigma))

    def around(arm: Any, q: Array, T: Array, lie: Any) -> Any:
        return np.ones(len(q), dtype=bool), np.arange(len(q)), q, np.full(len(q), sigma)

    monkeypatch.setattr(meeting_rows, "ends_of", led)
    starts = Starts(
        np.arange(3.0)[:, None], np.zeros((3, 4, 4)), np.zeros(3, np.intp), np.ones(3, dtype=bool),
        np.zeros(3, dtype=np.int64), np.arange(3),
    )  # fmt: skip
    arm: Any = SimpleNamespace(policy=POLICY, rounded=False, around=around, period=(WHOLE_TURN,))
    found = leads_of(arm, starts, np.zeros((1, 3), dtype=bool))
    assert found.known.tolist() == lost
    other = starts._replace(pose=np.array([0, 1, 1]))
    known = leads_of(arm, other, np.zeros((2, 3), dtype=bool)).known
    assert not known.any() or error > 0.0


def test_a_row_that_a_pose_beside_led_to_once_more_is_left_out() -> None:
    arm: Any = SimpleNamespace(policy=POLICY, period=(WHOLE_TURN,), beside=(0,))
    given = leads_of_rows([0.5, 1.5, 0.5 + 2.0 * pi, 2.5], [0, 0, 1, 2], [1.0, 2.0, 3.0, 4.0])
    found = rows_nearby(arm, given)
    assert found.owner.tolist() == [0, 1, 3] and found.sigma.tolist() == [1.0, 2.0, 4.0]
    assert found.q[:, 0].tolist() == [0.5, 1.5, 2.5]


def plane_arm(chain: Any, policy: Any) -> Any:
    """Of a chain whose joints all move, with what `repeats` reads of its policy."""
    moving = tuple(range(chain.dof))
    period = tuple(WHOLE_TURN if turning else 0.0 for _, turning, _, _ in chain.motions)
    return SimpleNamespace(
        policy=policy, chain=chain, period=period, task=Plane, moving=moving, angle=None
    )


def test_singular_rows_are_one_where_the_pose_is_theirs_between_them_too() -> None:
    """An elbow a little bent to either side: halfway it is stretched, and a quarter of that off."""
    frames = np.tile(np.eye(4), (3, 1, 1))
    frames[1:, 0, 3] = 0.5
    chain = chain_of(frames, ((0, True, 1.0, 0.0), (1, True, 1.0, 0.0)), 2)
    bend = 0.1
    rows = [(-0.5 * side * bend, side * bend) for side in (1.0, -1.0)]
    T = forward(chain, np.array(rows[0]))
    off = float(forward(chain, np.zeros(2))[0, 3] - T[0, 3])

    def told(halfway: float, singular: bool = True, alike: float = 0.3) -> bool:
        policy = SimpleNamespace(halfway=halfway, neighbouring=alike, arrived=0.0)
        arm = plane_arm(chain, policy)
        return repeats(arm, T, rows[0], [(rows[1], singular)])

    assert told(1.01 * off) and not told(0.99 * off)
    assert not told(1.0, singular=False) and not told(1.0, alike=0.1)
    arm = plane_arm(chain, SimpleNamespace(halfway=1.0, neighbouring=1.0, arrived=0.0))
    assert not repeats(arm, T, rows[0], [])


@pytest.mark.parametrize(("left", "told"), [(1e-15, True), (1e-14, False), (-1e-14, False)])
def test_singular_rows_are_one_where_the_curve_between_them_has_the_pose(
    left: float, told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The straight way between them leads past it."""
    frames = np.tile(np.eye(4), (3, 1, 1))
    frames[1:, 0, 3] = 0.5
    chain = chain_of(frames, ((0, True, 1.0, 0.0), (1, True, 1.0, 0.0)), 2)
    rows = [(-0.05, 0.1), (0.05, -0.1)]
    given = []

    def samples_beside(arm: Any, q: Array, T: Array) -> Any:
        given.append(q)
        return SimpleNamespace(left=np.full(len(q), left))

    monkeypatch.setattr(meeting_rows, "samples_beside", samples_beside)
    policy = SimpleNamespace(halfway=2e-14, neighbouring=0.3, arrived=1.0)
    arm = plane_arm(chain, policy)
    T = forward(chain, np.array(rows[0]))
    assert repeats(arm, T, rows[0], [(rows[1], True)]) == told
    assert np.abs(given[0]).max() < 1e-15


def test_rows_of_many_poses_are_told_apart_as_one_after_the_other_is() -> None:
    """Rows that are the same, alike, or each alike to the one before it, of poses in turn."""
    frames = np.tile(np.eye(4), (4, 1, 1))
    frames[1:, 0, 3] = 0.5
    motions = ((0, True, 1.0, 0.0), (1, True, 1.0, 0.0), (2, False, 1.0, 0.0))
    policy = SimpleNamespace(coincident=1e-6, neighbouring=0.3, halfway=0.02, arrived=0.0)
    chain = chain_of(frames, motions, 3)
    arm = plane_arm(chain, policy)
    rng = np.random.default_rng(2)
    q = np.array([0.1, 0.2, 40.0]) + rng.choice([0.0, 5e-7, 0.05, 0.15, 0.4], (300, 3))
    q[:, :2] += 2.0 * np.pi * rng.integers(-1, 2, (300, 2))
    q[:, 2] += rng.choice([0.0, 3e-5], 300)
    T, pose, singular = forward(chain, q[:4]), rng.integers(0, 4, 300), rng.random(300) < 0.7
    kept: list[list[Any]] = [[], [], [], []]
    wanted = []
    for k, (i, row, flag) in enumerate(
        zip(pose.tolist(), map(tuple, q.tolist()), singular, strict=True)
    ):
        if is_new(arm, row, kept[i]) and not (flag and repeats(arm, T[i], row, kept[i])):
            kept[i].append((row, bool(flag)))
            wanted.append(k)
    assert that_differ(arm, T, pose, q, singular).tolist() == wanted
    alone = np.ones_like(singular)
    assert 20 < len(wanted) < 290
    assert that_differ(arm, T, pose, q, ~alone).tolist() != wanted
    assert that_differ(arm, T, pose, q, alone).tolist() != wanted
    assert not len(that_differ(arm, T, pose[:0], q[:0], singular[:0]))


def test_marked_rows_that_are_not_the_arms_own_are_followed_once_for_each_branch(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Those of the pose first, then what poses beside have; what is given is not."""
    q = np.arange(6.0)[:, None]
    error = np.array([1.0, 1.0, 1.0, 1.0, 0.0, 1.0])
    monkeypatch.setattr(
        meeting_rows,
        "ends_of",
        lambda arm, q, T: Ends(q + 100.0, error[q[:, 0].astype(int)], q[:, 0]),
    )
    seen: list[list[float]] = []

    def around(arm: Any, q: Array, T: Array, lie: Any) -> Any:
        assert not lie.any()
        seen.append(q[:, 0].tolist())
        return np.ones(len(q), dtype=bool), np.arange(len(q)), q + 10.0, q[:, 0]

    starts = Starts(
        q, np.zeros((6, 4, 4)), np.zeros(6, np.intp), np.array([True] * 5 + [False]),
        np.array([-1, 0, 1, 1, 0, 0]), np.array([0, 0, 0, 1, 2, 3]),
    )  # fmt: skip
    known = np.zeros((1, 4), dtype=bool)
    arm: Any = SimpleNamespace(policy=POLICY, rounded=False, around=around, period=(0.0,))
    found = leads_of(arm, starts, known)
    assert seen == [
        [1.0],
        [3.0],
    ]  # the second one's branch is known by then, the fifth is the arm's own
    assert known.tolist() == [[True, True, False, False]]
    assert found.around.owner.tolist() == [1, 3] and found.around.q[:, 0].tolist() == [11.0, 13.0]
    assert found.known.tolist() == [False, True, True, True, False, False]
    assert found.starts.marked.tolist() == [True, True, True, True, True, False]
    assert np.isinf(found.ends.error[1:4]).all() and np.isfinite(found.ends.error[[0, 4, 5]]).all()
    assert found.ends.q[[0, 4, 5], 0].tolist() == [100.0, 104.0, 105.0]
    seen.clear()
    arm.rounded = True  # then none is known to be the file's
    leads_of(arm, starts, np.zeros((1, 4), dtype=bool))
    assert seen == [[1.0, 4.0], [3.0]]
    arm.around = None
    none = leads_of(arm, starts, np.zeros((1, 4), dtype=bool))
    assert none.starts.marked.tolist() == [True] + [False] * 5 and not none.known.any()


@pytest.mark.parametrize(
    ("on", "asked", "taken"), [([0, 3], [[0, 3]], [0, 3]), ([2, 3], [[0, 3], [1, 2]], [2, 3])]
)
def test_other_starts_of_a_branch_are_followed_where_the_first_is_on_no_continuum(
    monkeypatch: pytest.MonkeyPatch, on: list[int], asked: list[list[int]], taken: list[int]
) -> None:
    q = np.arange(4.0)[:, None]
    monkeypatch.setattr(
        meeting_rows, "ends_of", lambda arm, q, T: Ends(q, np.ones(len(q)), np.ones(len(q)))
    )
    seen: list[list[int]] = []

    def around(arm: Any, q: Array, T: Array, lie: Any) -> Any:
        seen.append(q[:, 0].astype(int).tolist())
        curve = np.isin(q[:, 0], on)
        return curve, np.flatnonzero(curve), q[curve] + 10.0, q[curve, 0]

    starts = Starts(
        q, np.zeros((4, 4, 4)), np.zeros(4, np.intp), np.ones(4, dtype=bool),
        np.array([1, 2, 3, 1]), np.array([0, 0, 0, 1]),
    )  # fmt: skip
    known = np.zeros((1, 2), dtype=bool)
    arm: Any = SimpleNamespace(policy=POLICY, rounded=True, around=around)
    found = leads_of(arm, starts, known)
    assert seen == asked and known.all()
    assert sorted(found.around.owner.tolist()) == taken
    assert (found.around.q[:, 0] == found.around.owner + 10.0).all()
