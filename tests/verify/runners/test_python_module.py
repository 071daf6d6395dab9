"""The runner of a Python module on a module made by hand: how answers are gathered."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ikgen.errors import BadDescriptionError
from ikgen.verify.runners.python_module import PythonModule

MODULE = """
from enum import Enum
from types import SimpleNamespace
import numpy as np

JOINT_NAMES, LOWER, UPPER = ("a", "b"), [-1, -2], [1, 2]
BASE_LINK, TIP_LINK, DOF, MAX_SOLUTIONS, TASK = "base", "tip", 2, 3, "position"
FREE_JOINTS, SOURCE_SHA256, GENERATOR_VERSION, Solutions = (), "", "0", None
_ARM = "the arm"

class Status(Enum):
    OK = 0
    UNREACHABLE = 1

def rows(pose, free, seed, limits):
    count = int(pose[0, 0])
    q = np.array([[pose[1, 1], k] for k in range(count)]).reshape(count, 2)
    q = q + (0 if free is None else free[0]) + (0 if seed is None else 100 * seed[1])
    status = Status.OK if count else Status.UNREACHABLE
    flags = [k == 1 for k in range(count)]
    return SimpleNamespace(q=q + (0 if limits else 1000), status=status, singular=flags)

def solve(pose, free=None, seed=None, limits=True):
    return rows(pose, free, seed, limits)

def solve_batch(poses, free=None, limits=True):
    found = [solve(pose, None if free is None else free[i], None, limits) for i, pose in enumerate(poses)]
    q = np.full((len(poses), 3, 2), np.nan)
    for k, one in enumerate(found):
        q[k, : len(one.q)] = one.q
    status = [one.status.value if k % 2 else one.status for k, one in enumerate(found)]
    return q, [len(one.q) for one in found], status

def forward(q):
    return np.zeros((len(q), 4, 4), int)

def jacobian(q):
    return np.full((6, 2), q[0])

def search(pose, seed, prefer):
    assert prefer == "near"
    return SimpleNamespace(q=[seed, seed + 1])

def follow(poses, start):
    q = np.array([start] * len(poses))
    return SimpleNamespace(q=q, status=Status.OK, singular=[0] * len(poses))

def self_motion(pose):
    return [SimpleNamespace(low=float(k), high=k + 0.5) for k in range(int(pose[0, 0]))]
"""
EACH = """
def _solve_each(arm, poses, free, seeds, limits):
    assert arm == "the arm"
    for i, pose in enumerate(poses):
        one = rows(pose, None if free is None else free[i], None if seeds is None else seeds[i], limits)
        one.q = one.q + 1e6
        yield one

def _branch_names(arm, q):
    return tuple(f"{arm} {row[1]:g}" for row in q)
"""


def runner(folder: Path, more: str = "") -> PythonModule:
    path = folder / "made_ik.py"
    path.write_text(MODULE + more)
    return PythonModule(path)


def poses(*counts: int) -> np.ndarray:
    """Poses with so many rows each; the first value of a row is the place of its pose."""
    T = np.zeros((len(counts), 4, 4))
    T[:, 0, 0], T[:, 1, 1] = counts, np.arange(len(counts))
    return T


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_intervals_are_pairs_of_ends(tmp_path: Path, count: int) -> None:
    ends = runner(tmp_path).self_motion(poses(count)[0])
    assert ends.shape == (count, 2)
    assert ends.tolist() == [[float(k), k + 0.5] for k in range(count)]


def test_constants_are_read(tmp_path: Path) -> None:
    constants = runner(tmp_path).constants
    assert constants.joint_names == ("a", "b") and constants.dof == 2
    assert constants.lower.tolist() == [-1.0, -2.0] and constants.upper.tolist() == [1.0, 2.0]
    assert (constants.task, constants.max_solutions, constants.free_defaults) == (
        "position",
        3,
        None,
    )
    more = "TASK, TOOL_AXIS, _FREE_DEFAULTS = 'position-pitch', 'x', (0.5,)\n"
    constants = runner(tmp_path, more).constants
    assert (constants.task, constants.free_defaults) == ("position-pitch:x", (0.5,))
    with pytest.raises(BadDescriptionError, match="lacks TIP_LINK"):
        runner(tmp_path, "del TIP_LINK")


def test_answers_are_gathered_by_pose(tmp_path: Path) -> None:
    made = runner(tmp_path)
    free, seeds = np.array([[10.0], [20.0], [30.0]]), np.array([[0.0, 1.0], [0.0, 2.0], [0.0, 3.0]])
    for given, near, limits in ((None, None, True), (free, None, False), (free, seeds, True)):
        found = made.solve_many(poses(2, 0, 4), free=given, seeds=near, limits=limits)
        assert found.count.tolist() == [2, 0, 4] and found.q.shape == (3, 4, 2)
        assert found.status == ("OK", "UNREACHABLE", "OK")
        assert found.singular.tolist() == [
            [False, True, False, False], [False] * 4, [False, True, False, False]
        ]  # fmt: skip
        assert np.isnan(found.q[0, 2:]).all() and np.isnan(found.q[1]).all()
        for i in (0, 2):
            shift = 0.0 if limits else 1000.0
            shift += (0.0 if given is None else free[i, 0]) + (
                0.0 if near is None else 100 * seeds[i, 1]
            )
            assert found.q[i, 0].tolist() == [i + shift, shift]
    few = made.solve_many(poses(1))
    assert few.q.shape == (1, 3, 2)


def test_one_in_32_is_solved_by_itself(tmp_path: Path) -> None:
    made = runner(tmp_path, EACH)
    found = made.solve_many(poses(*[1] * 40), free=np.arange(40.0)[:, None])
    alone = found.q[:, 0, 0] < 1e5
    assert np.flatnonzero(alone).tolist() == [0, 32]
    np.testing.assert_array_equal(found.q[:, 0, 0] - 1e6 * ~alone, 2 * np.arange(40.0))
    assert made.branch_names(np.array([[0.0, 4.0], [0.0, 7.0]])) == ("the arm 4", "the arm 7")
    assert runner(tmp_path).solve_many(poses(*[1] * 20)).q[:, 0, 0].max() < 1e5


def test_batches_have_names_of_statuses_and_no_flags(tmp_path: Path) -> None:
    made = runner(tmp_path)
    found = made.solve_batch(poses(2, 0, 0, 1), free=np.full((4, 1), 5.0), limits=False)
    assert found is not None and found.q.dtype == float
    assert found.status == ("OK", "UNREACHABLE", "UNREACHABLE", "OK")
    assert found.count.tolist() == [2, 0, 0, 1] and not found.singular.any()
    assert found.singular.shape == (4, 3) and found.q[3, 0, 0] == 3.0 + 5.0 + 1000.0


def test_motions_and_kinematics_pass_through(tmp_path: Path) -> None:
    made = runner(tmp_path)
    assert made.moves and made.has_self_motion
    seed = np.array([0.25, 0.5])
    assert made.search(poses(1)[0], seed).tolist() == [[0.25, 0.5], [1.25, 1.5]]
    q, status, singular = made.follow(poses(1, 1, 1), seed)
    assert q.tolist() == [[0.25, 0.5]] * 3 and status == "OK" and singular.tolist() == [False] * 3
    assert made.forward(np.zeros((3, 2))).dtype == float
    J = made.jacobian(np.array([[1.0, 0.0], [2.0, 0.0]]))
    assert J.shape == (2, 6, 2) and (J[0] == 1.0).all() and (J[1] == 2.0).all()
    for name in ("follow", "search"):
        assert not runner(tmp_path, f"del {name}").moves
    assert not runner(tmp_path, "del self_motion").has_self_motion
