"""What is asked of a program and read of its answers: a script that answers with what it was asked."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from ikgen.errors import BadDescriptionError, VerificationError
from ikgen.verify.runners.program_runner import ProgramRunner
from ikgen.verify.runners.runner import ArmConstants

SCRIPT = f"""#!{sys.executable}
import array, sys
asked = array.array("d", open(sys.argv[1], "rb").read())
mode, n, free, seed, limits, *items = asked
size = len(items) // int(n) if n else 0
answer = [2.0, 1.0, 3.0, 0.25] if mode == 0 else []
for i in range(int(n)):
    item = items[i * size : (i + 1) * size]
    if mode in (1, 4, 6):
        status, count = item[15], item[3]
        rows = [item[12], size, 1.0, free, seed, 0.0, limits, mode, 0.0]
        answer += [status, count, *rows]
    elif mode == 2:
        answer += [item[0], 1.0, 2.0, 3.0, *[0.0] * 11, item[1]]
    elif mode == 5:
        answer += [2.0, n - 1.0] if i == 0 else []
        answer += [item[12], item[17], 1.0]
    elif mode == 7:
        answer += [2.0, item[12], 1.0, 2.0, size]
    else:
        answer += [float(k) for k in range(12)]
if mode == 1 and items[0] == 99.0:
    sys.exit("no more")
array.array("d", answer).tofile(open(sys.argv[2], "wb"))
"""
CONSTANTS = ArmConstants(
    joint_names=("one", "two"),
    lower=np.array([-1.0, -1.0]),
    upper=np.array([1.0, 1.0]),
    base_link="base",
    tip_link="tip",
    task="pose",
    free_joints=("two",),
    max_solutions=7,
)


@pytest.fixture
def script(tmp_path: Path) -> Path:
    file = tmp_path / "program"
    file.write_text(SCRIPT)
    file.chmod(0o755)
    return file


def asked(status: float, count: float, x: float = 0.5) -> np.ndarray:
    pose = np.zeros((4, 4))
    pose[3, 3], pose[3, 0], pose[0, 3] = status, count, x
    return pose


def test_rows_of_many_poses(script: Path) -> None:
    runner = ProgramRunner("x", script, CONSTANTS, batch=True, source="a.hpp")
    assert runner.constants.max_solutions == 3 and runner.constants.free_defaults == (0.25,)
    poses = np.array([asked(0.0, 3.0), asked(1.0, 0.0), asked(2.0, 1.0), asked(-1.0, 9.0)])
    rows = runner.solve_many(poses, free=np.zeros((4, 1)), limits=False)
    assert rows.status == ("OK", "UNREACHABLE", "LIMITS", "UNKNOWN")
    assert rows.count.tolist() == [3, 0, 1, 3]
    np.testing.assert_array_equal(rows.q[0], [[0.5, 17.0], [1.0, 0.0], [0.0, 1.0]])
    assert np.isnan(rows.q[1]).all() and np.isnan(rows.q[2, 1:]).all()
    assert rows.singular[0].tolist() == [True, False, False]


def test_what_is_told_of_options(script: Path) -> None:
    runner = ProgramRunner("x", script, CONSTANTS, batch=True, source="a.hpp")
    q, status, singular = runner.solve(asked(0.0, 3.0), seed=np.zeros(2))
    assert status == "OK" and singular.tolist() == [True, False, False]
    np.testing.assert_array_equal(q, [[0.5, 18.0], [0.0, 1.0], [1.0, 1.0]])
    together = runner.solve_batch(np.array([asked(0.0, 3.0)]))
    assert together is not None
    np.testing.assert_array_equal(together.q[0], [[0.5, 16.0], [0.0, 0.0], [1.0, 4.0]])
    outside = runner.solve_batch(np.array([asked(0.0, 3.0)]), limits=False)
    assert outside is not None and outside.q[0, 2].tolist() == [0.0, 4.0]
    assert runner.solve_batch(np.array([asked(0.0, 3.0)]), free=np.zeros((1, 1))) is None
    single = ProgramRunner("x", script, CONSTANTS, batch=False, source="a.hpp")
    assert single.solve_batch(np.array([asked(0.0, 3.0)])) is None


def test_poses_and_jacobians_come_by_columns(script: Path) -> None:
    runner = ProgramRunner("x", script, CONSTANTS, batch=True, source="a.hpp")
    T = runner.forward(np.array([[5.0, 6.0], [7.0, 8.0]]))
    assert T.shape == (2, 4, 4) and T[0, :, 0].tolist() == [5.0, 1.0, 2.0, 3.0]
    assert T[1, 3, 3] == 8.0
    J = runner.jacobian(np.zeros((1, 2)))
    assert J.shape == (1, 6, 2) and J[0, :, 1].tolist() == [6.0, 7.0, 8.0, 9.0, 10.0, 11.0]


def test_paths_and_what_is_held(script: Path) -> None:
    runner = ProgramRunner("x", script, CONSTANTS, batch=True, source="a.hpp")
    assert not runner.moves and not runner.has_self_motion
    runner = ProgramRunner(
        "x", script, CONSTANTS, batch=True, source="a.hpp", motions=True, intervals=True
    )
    assert runner.moves and runner.has_self_motion
    poses = np.array([asked(0.0, 3.0, 0.1), asked(0.0, 3.0, 0.2), asked(0.0, 3.0, 0.3)])
    q, status, singular = runner.follow(poses, np.array([5.0, 6.0]))
    assert status == "LIMITS" and singular.tolist() == [True, True, True]
    np.testing.assert_array_equal(q, [[0.1, 6.0], [0.2, 6.0], [np.nan, np.nan]])
    rows = runner.search(asked(0.0, 2.0, 0.1), np.array([5.0, 6.0]))
    np.testing.assert_array_equal(rows, [[0.1, 18.0], [0.0, 0.0]])
    ends = runner.self_motion(asked(0.0, 2.0, 0.1))
    np.testing.assert_array_equal(ends, [[0.1, 1.0], [2.0, 16.0]])


def test_another_arm_s_program_and_one_that_fails_are_told(script: Path) -> None:
    three = ArmConstants(
        joint_names=("one", "two", "three"), lower=np.zeros(3), upper=np.ones(3), base_link="base",
        tip_link="tip", task="pose", free_joints=("two",), max_solutions=7,
    )  # fmt: skip
    with pytest.raises(BadDescriptionError, match=r"has 2 joints, 1 of them free, instead of 3"):
        ProgramRunner("x", script, three, batch=True, source="a.hpp")
    runner = ProgramRunner("x", script, CONSTANTS, batch=True, source="a.hpp")
    pose = asked(0.0, 1.0)
    pose[0, 0] = 99.0
    with pytest.raises(VerificationError, match=r"emitted x code's driver .*no more"):
        runner.solve(pose)
