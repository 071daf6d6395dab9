"""`ikgen.compile`: an arm that gives what the Python module gives, faster."""

from __future__ import annotations

import copy
import importlib.util
import pickle
import shutil
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.small_robots import elbow_robot

import ikgen
from ikgen.errors import ArgumentError, MissingToolError, VerificationError
from ikgen.library.compilation import CompiledArm, _compare
from ikgen.verify.runners import cpp_toolchain
from ikgen.verify.runners.cpp_toolchain import LIGHT

Array = NDArray[np.float64]

ELBOW = Path(__file__).resolve().parents[2] / "examples/setuptools_robot/urdf/elbow.urdf"
UR5E = Path(__file__).resolve().parents[2] / "urdf_fixtures/ur5e.urdf"


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("IKGEN_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_what_is_no_arm_is_refused() -> None:
    with pytest.raises(ArgumentError, match="arm") as caught:
        ikgen.compile("robot.urdf")  # type: ignore[arg-type]
    assert "ikgen.load" in caught.value.hint


def test_what_is_missing_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    arm = ikgen.load(ELBOW, verify=False)
    find = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "nanobind" else find(name)
    )
    with pytest.raises(MissingToolError, match="nanobind") as caught:
        ikgen.compile(arm)
    assert "ikgen[compile]" in caught.value.hint


@pytest.mark.parametrize(("lower", "upper"), [(3.5, 4.5), (-9.0, -8.0)])
def test_limits_beyond_half_a_turn_are_compared_too(
    tmp_path: Path, lower: float, upper: float
) -> None:
    robot = tmp_path / "arm.urdf"
    text = elbow_robot().replace('lower="-2.5" upper="2.5"', f'lower="{lower}" upper="{upper}"', 1)
    robot.write_text(text)
    arm = ikgen.load(robot, verify=False)
    assert arm.lower[0] == lower
    _compare(arm, cast(CompiledArm, arm))


class Altered:
    """What an arm answers, with the rows of each pose altered: in batches alone, or one by one too."""

    def __init__(self, arm: ikgen.Arm, alter: Callable[[Array], Array], batches: bool) -> None:
        self.arm, self.alter, self.batches = arm, alter, batches

    def solve(self, pose: Array) -> Any:
        found = self.arm.solve(pose)
        q = found.q if self.batches else self.alter(found.q)
        return self.arm.module.Solutions(q, found.status, found.singular[: len(q)])

    def solve_batch(self, poses: Array) -> tuple[list[Array], list[int], Array]:
        q, count, status = self.arm.solve_batch(poses)
        rows = [self.alter(some[:n]) for some, n in zip(q, count, strict=True)]
        return rows, [len(some) for some in rows], status


@pytest.mark.parametrize("batches", [False, True])
@pytest.mark.parametrize(
    ("alter", "same"),
    [
        (lambda q: q[::-1], True),
        (lambda q: q + 1e-8, True),
        (lambda q: q + 1e-5, False),
        (lambda q: q[1:], False),
        (lambda q: np.concatenate([q[:1], q[:-1]]), False),
    ],
    ids=["another order", "last digits", "off", "one less", "one twice"],
)
def test_rows_are_compared_in_any_order(
    alter: Callable[[Array], Array], same: bool, batches: bool
) -> None:
    """Which of them Newton steps find first hangs on last digits."""
    arm = ikgen.load(ELBOW, verify=False)
    other = cast(CompiledArm, Altered(arm, alter, batches))
    with nullcontext() if same else pytest.raises(VerificationError, match="gives other rows"):
        _compare(arm, other)


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("nanobind") is None, reason="needs nanobind")
@pytest.mark.skipif(not shutil.which("c++"), reason="needs a C++ compiler")
def test_a_compiled_arm_does_what_the_arm_does(
    cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cpp_toolchain, "FULL", LIGHT)  # rows are the same, in half of the time
    arm = ikgen.load(UR5E, verify=False)
    fast = ikgen.compile(arm)
    assert isinstance(fast, ikgen.Arm) and fast.joint_names == arm.joint_names
    q = np.random.default_rng(0).uniform(-2.0, 2.0, (20, 6))
    poses = arm.forward(q)
    assert np.allclose(fast.forward(q), poses, atol=1e-12)
    assert np.allclose(fast.jacobian(q[0]), arm.jacobian(q[0]), atol=1e-12)
    for pose, row in zip(poses, q, strict=True):
        mine, theirs = fast.solve(pose, seed=row), arm.solve(pose, seed=row)
        assert np.allclose(mine.q, theirs.q, atol=1e-9) and mine.branch == theirs.branch
        assert np.allclose(mine[0], theirs[0], atol=1e-9) and mine.status == theirs.status
    pair = poses[0][:3, :3], poses[0][:3, 3]
    assert np.allclose(fast.solve(pair).q, arm.solve(pair).q, atol=1e-9)
    rough = poses[0].round(4)
    assert "orthonormalize=True" in fast.solve(rough).reason
    assert len(fast.solve(rough, orthonormalize=True)) == len(arm.solve(rough, orthonormalize=True))
    assert (fast.solve_batch(poses[:, :3])[1] == arm.solve_batch(poses)[1]).all()
    assert fast.solve(poses[0] + 9.0).status == arm.solve(poses[0] + 9.0).status
    mine, theirs = (one.search(poses[0], prefer="dexterous") for one in (fast, arm))
    assert np.allclose(mine.q, theirs.q, atol=1e-9) and mine.status is theirs.status
    for other in (pickle.loads(pickle.dumps(fast)), copy.copy(fast), copy.deepcopy(fast)):
        assert isinstance(other, CompiledArm) and other.compiled is fast.compiled
        assert (other.solve(poses[0]).q == fast.solve(poses[0]).q).all()
    along = arm.forward(np.linspace(q[0], q[0] + 0.3, 5))
    path, other = (one.follow(along, start=q[0]) for one in (fast, arm))
    assert np.allclose(path.q, other.q, atol=1e-9) and path.reached == other.reached == 5
    assert type(path) is type(other) and path.status is other.status
    assert fast._functions is fast.compiled  # those that this arm has not, too
    with pytest.raises(ikgen.UsageError, match="no self_motion"):
        fast.self_motion(poses[0])
    for wrong in (np.eye(3), "here"):
        with pytest.raises(ArgumentError):
            fast.solve(wrong)
    (folder,) = (cache / "compiled").iterdir()
    stamp = folder.stat().st_mtime_ns
    assert ikgen.compile(arm).compiled is fast.compiled and folder.stat().st_mtime_ns == stamp
