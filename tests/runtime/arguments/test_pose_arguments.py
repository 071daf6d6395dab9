"""Poses as people have them, and what is said of those that are none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pinocchio
import pytest

from ikgen.elimination.routine import runtime_policy
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.arguments.pose_arguments import pose_matrices, poses_in_line
from ikgen.runtime.python.arguments.pose_faults import nearest_pose, nearest_poses, pose_fault
from ikgen.runtime.python.arm.pose_entries import EntriesTask
from ikgen.runtime.python.arm.whole_pose import PoseTask

POLICY = runtime_policy(SolvePolicy())
R, P = pinocchio.exp3(np.array([0.3, -1.1, 0.7])), np.array([0.1, -0.2, 0.3])
T = np.eye(4)
T[:3, :3], T[:3, 3] = R, P
MANY = np.stack([T, np.eye(4), T @ T])
QUATERNION = pinocchio.Quaternion(R).coeffs()  # x y z w


class Spatial:
    """Like `spatialmath.SE3`: an array, or a list of arrays where it holds several."""

    def __init__(self, A: Any) -> None:
        self.A = A


SINGLE = {
    "array": T,
    "lists": T.tolist(),
    "single precision": T.astype(np.float32),
    "three rows": T[:3],
    "three rows as lists": T[:3].tolist(),
    "rotation and position": (R, P),
    "rotation and position as lists": [R.tolist(), P.tolist()],
    "position and quaternion": (P, QUATERNION),
    "position and the other quaternion": (P.tolist(), (-QUATERNION).tolist()),
    "rotation of another library and position": (SimpleNamespace(as_matrix=lambda: R), P),
    "homogeneous": pinocchio.SE3(T),
    "as_matrix": SimpleNamespace(as_matrix=lambda: T),
    "A": Spatial(T),
    "np.matrix": np.asmatrix(T),
}


@pytest.mark.parametrize("kind", SINGLE)
def test_a_pose_of_any_kind_is_its_matrix(kind: str) -> None:
    found = pose_matrices(SINGLE[kind], "")
    assert found.shape == (4, 4) and found.dtype == float and type(found) is np.ndarray
    assert np.allclose(found, T, atol=1e-6 if kind == "single precision" else 1e-14)


BATCH = {
    "array": MANY,
    "three rows": MANY[:, :3],
    "list of arrays": list(MANY),
    "rotations and positions": (MANY[:, :3, :3], MANY[:, :3, 3]),
    "positions and quaternions": (
        MANY[:, :3, 3],
        np.array([pinocchio.Quaternion(M[:3, :3]).coeffs() for M in MANY]),
    ),
    "pairs": [(M[:3, :3], M[:3, 3]) for M in MANY],
    "positions with quaternions": [
        (M[:3, 3].tolist(), pinocchio.Quaternion(M[:3, :3]).coeffs()) for M in MANY
    ],
    "mixed": [MANY[0], MANY[1][:3], SimpleNamespace(as_matrix=lambda: MANY[2])],
    "objects": [SimpleNamespace(homogeneous=one) for one in MANY],
    "one object of several": Spatial(list(MANY)),
    "as_matrix": SimpleNamespace(as_matrix=lambda: MANY),
}


@pytest.mark.parametrize("kind", BATCH)
def test_many_poses_of_any_kind_are_their_matrices(kind: str) -> None:
    found = pose_matrices(BATCH[kind], "")
    assert found.shape == (3, 4, 4) and np.allclose(found, MANY, atol=1e-14)


def test_two_poses_are_no_pair() -> None:
    pairs = [(R, P), (R.tolist(), P.tolist())]
    assert np.allclose(pose_matrices(pairs, ""), [T, T], atol=1e-14)
    assert np.array_equal(pose_matrices([T.tolist(), T.tolist()], ""), [T, T])
    assert np.array_equal(pose_matrices([T[:3], T[:3]], ""), [T, T])


def test_parts_alone_do_where_the_task_reads_no_other() -> None:
    assert np.allclose(pose_matrices(R, "rotation")[:3, :3], R)
    assert np.allclose(pose_matrices(SimpleNamespace(as_matrix=lambda: R), "rotation")[:3, :3], R)
    assert np.allclose(pose_matrices(P.tolist(), "position")[:3, 3], P)
    assert pose_matrices(np.zeros((5, 3)), "position").shape == (5, 4, 4)
    assert pose_matrices(np.zeros((5, 3, 3)), "rotation").shape == (5, 4, 4)
    assert pose_matrices(R, "").shape == (3, 3)  # which the caller refuses
    assert pose_matrices(P, "rotation").shape == (3,)


def test_forms_are_told_where_it_is_none_of_them() -> None:
    with pytest.raises(ValueError, match=r"none of \(4, 4\), .* nor a sequence of them"):
        pose_matrices([(R, P), (R, P[:2])], "")


@pytest.mark.parametrize("wrong", ["here", {}, {"p": 1}, [[1.0], [1.0, 2.0]], (R, P[:2]), object()])
def test_what_is_no_array_is_a_value_error(wrong: Any) -> None:
    with pytest.raises(ValueError):
        pose_matrices(wrong, "")


def test_a_quaternion_that_is_not_of_norm_one_gives_no_rotation() -> None:
    good = pose_matrices((P, np.float32(QUATERNION)), "").tolist()
    assert PoseTask(1.0).read(good, POLICY) is not None
    bad = pose_matrices((P, 1.001 * QUATERNION), "").tolist()
    assert PoseTask(1.0).read(bad, POLICY) is None


@pytest.mark.parametrize("digits", [3, 4, 5])
def test_a_rotation_of_few_digits_is_refused_with_a_reason_and_a_way_out(digits: int) -> None:
    task, rough = PoseTask(1.0), T.copy()
    rough[:3, :3] = np.round(R, digits)
    assert task.read(rough.tolist(), POLICY) is None
    assert "orthonormalize=True" in pose_fault(task, rough.tolist(), POLICY)
    near = nearest_pose(task, rough.tolist(), POLICY)
    clean = task.read(near, POLICY)
    assert clean is not None
    read = np.array(clean)[:3, :3]
    assert np.abs(read.T @ read - np.eye(3)).max() < 1e-14
    U, _, V = np.linalg.svd(rough[:3, :3])  # the nearest in the Frobenius norm
    assert np.abs(read - U @ V).max() < 1e-9
    assert np.allclose(nearest_poses(task, np.stack([rough, T]), POLICY)[0], near)


def test_a_sequence_may_be_empty() -> None:
    for none in ([], (), np.empty((0, 4, 4))):
        assert poses_in_line(none, "").shape == (0, 4, 4)


def test_a_quaternion_s_norm_is_told_of() -> None:
    text = pose_fault(PoseTask(1.0), pose_matrices((P, 2.0 * QUATERNION), "").tolist(), POLICY)
    assert "than the 1e-03 of orthonormalize (norm 1 of a quaternion?)" in text


FAULTS = {
    "finite": np.full((4, 4), np.nan),
    "last row": np.vstack([T[:3], [[0.0, 0.0, 0.1, 1.0]]]),
    "reflection": T @ np.diag([1.0, 1.0, -1.0, 1.0]),
    "off by 5.0e-01": np.block([[1.5 * R, P[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]]),
}


@pytest.mark.parametrize("words", FAULTS)
def test_what_is_wrong_is_said(words: str) -> None:
    task, bad = PoseTask(1.0), FAULTS[words].tolist()
    text = pose_fault(task, bad, POLICY)
    assert task.read(bad, POLICY) is None and "orthonormalize=True" not in text
    assert words in text or words == "off by 5.0e-01"
    assert np.array_equal(nearest_pose(task, bad, POLICY), bad, equal_nan=True)


def test_a_task_of_some_entries_tells_of_those() -> None:
    direction = EntriesTask(1.0, (0, 1, 2), (2, 2, 2), (2,), False)
    assert direction.alone == "rotation"
    bad = T.copy()
    bad[:3, 2] *= 1.0002
    assert "orthonormalize=True" in pose_fault(direction, bad.tolist(), POLICY)
    assert EntriesTask(1.0, (0, 1, 2), (3, 3, 3), (), False).alone == "position"
    assert EntriesTask(1.0, (0, 1), (3, 0), (0,), True).alone == ""


@pytest.mark.parametrize("over", [0.5, -0.5, 1.0 + 1e-9, -1.0 - 1e-9, 1.001, -1.9])
def test_an_entry_that_is_a_cosine_is_one_or_is_put_right(over: float) -> None:
    """One entry of the rotation read alone: beyond 1 by rounding it counts as 1, further it is no pose."""
    task, pose = EntriesTask(1.0, (2, 0), (2, 3), (), False), np.eye(4)
    pose[2, 2] = over
    single = task.read(pose.tolist(), POLICY)
    many, good = task.read_batch(np.stack([pose, np.eye(4)]), POLICY)
    assert (single is not None) == good[0] == (abs(over) < 1.0 + 1e-6) and good[1]
    if single is not None:
        assert single[2][2] == many[0, 2, 2] == np.clip(over, -1.0, 1.0)
    assert many[1, 2, 2] == 1.0


@pytest.mark.parametrize("columns", [(0, 1, 2), (2,), (0,)])
def test_the_tolerance_is_of_each_entry_that_is_read(columns: tuple[int, ...]) -> None:
    """Columns `C (1 + e J)`, J all ones, are as far off as those with each entry off by e, to first
    order."""
    n = len(columns)
    task: Any = PoseTask(1.0)
    if n < 3:
        task = EntriesTask(1.0, (0, 1, 2), columns * 3, columns, False)
    for share, good in ((0.98, True), (1.02, False)):
        off = share * POLICY.pose_tolerance * np.sqrt(3.0 / n)
        pose = T.copy()
        pose[:3, columns] = R[:, columns] @ (np.eye(n) + off * np.ones((n, n)))
        assert (task.read(pose.tolist(), POLICY) is not None) == good
        assert task.read_batch(pose[None], POLICY)[1].tolist() == [good]
        if good:
            near = np.array(task.read(pose.tolist(), POLICY))
            np.testing.assert_allclose(near[:3, columns], R[:, columns], atol=1e-12)
            np.testing.assert_array_equal(
                task.read_batch(pose[None], POLICY)[0][0][:3, columns], near[:3, columns]
            )


def test_a_rotation_that_is_one_but_for_rounding_stays_to_the_bit() -> None:
    task = PoseTask(1.0)
    turns = np.tile(np.eye(4), (50, 1, 1))
    for pose, vector in zip(turns, np.random.default_rng(6).normal(size=(50, 3)), strict=True):
        pose[:3, :3] = pinocchio.exp3(vector)
    found, good = task.read_batch(turns, POLICY)
    assert good.all() and np.array_equal(found, turns)
    assert [task.read(pose.tolist(), POLICY) for pose in turns] == turns.tolist()
