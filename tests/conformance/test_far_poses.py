"""Positions farther than any arm reaches, up to the largest double: no rows, no error, no warning."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import Both, in_both
from tests.support.sampled import sampled
from tests.support.solving import FIXTURES, NO_COMPILER, import_text

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]

# closed forms, an elimination, four joints, slides, a held joint
ARMS = [
    "ur5e.urdf",
    "fanuc_crx10ia.urdf",
    "open_manipulator_x.urdf",
    "olson13.toml",
    "franka_fr3.urdf",
]
LARGEST = float(np.finfo(float).max)
SIZES = (1.01e15, 1e20, 1e76, 1e100, 1e154, 1e160, 1e300, LARGEST)
DIRECTIONS = ((1.0, 1.0, 1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (1.0, -1.0, 0.3))


@pytest.fixture(autouse=True)
def no_warnings() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def far_poses(arm: ModuleType) -> Array:
    """Poses (N, 4, 4) with rotations that the arm takes."""
    T = np.repeat(arm.forward(np.full(arm.DOF, 0.4))[None], len(SIZES) * len(DIRECTIONS), axis=0)
    T[:, :3, 3] = [size * np.array(way) for size, way in itertools.product(SIZES, DIRECTIONS)]
    return np.asarray(T)


@pytest.mark.parametrize("name", ARMS)
def test_no_pose_is_too_far_to_be_unreachable(name: str, tmp_path: Path) -> None:
    arm = import_text(emit_module(derive(Request(FIXTURES / name)).module), tmp_path)
    start = np.full(arm.DOF, 0.4)
    poses = far_poses(arm)
    near = arm.forward(start)
    for T in poses:
        for options in ({}, {"seed": start}, {"limits": False}, {"project": True}):
            found = arm.solve(T, **options)
            assert found.status == "UNREACHABLE" and len(found) == 0
        assert arm.search(T).status == "UNREACHABLE"
        path = arm.follow(np.stack([near, T]), start=start, limits=False)
        assert path.status == "UNREACHABLE" and path.reached == 1
        if hasattr(arm, "self_motion"):
            assert arm.self_motion(T) == ()
    q, count, status = arm.solve_batch(poses)
    assert np.isnan(q).all() and not count.any() and set(status) == {"UNREACHABLE"}


def test_what_else_is_wrong_with_a_far_pose_counts(tmp_path: Path) -> None:
    arm = import_text(emit_module(derive(Request(FIXTURES / "ur5e.urdf")).module), tmp_path)
    T = far_poses(arm)[-1]
    skew, blind, rough = T.copy(), T.copy(), T.copy()
    skew[:3, 0] *= 1.1
    blind[1, 3] = np.inf
    rough[:3, :3] = np.round(T[:3, :3], 4)
    for pose in (skew, blind, rough):
        assert arm.solve(pose).status == "INVALID"
    assert arm.solve(rough, orthonormalize=True).status == "UNREACHABLE"
    near = arm.forward(np.full(arm.DOF, 0.4))
    poses = np.stack([T, near, skew, rough, blind])
    expected = ["UNREACHABLE", "OK", "INVALID", "INVALID", "INVALID"]
    assert arm.solve_batch(poses)[2].tolist() == expected
    expected[3] = "UNREACHABLE"
    assert arm.solve_batch(poses, orthonormalize=True)[2].tolist() == expected


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
@pytest.mark.parametrize("name", sampled(ARMS[2:], ["franka_fr3.urdf"]))
def test_headers_say_the_same(name: str, tmp_path: Path) -> None:
    both = in_both(derive(Request(FIXTURES / name)).module, tmp_path, "145")
    start = np.full(both.arm.DOF, 0.4)
    for T in far_poses(both.arm)[::3]:
        assert answers(both, start, T) == ["UNREACHABLE"] * 3
        T[0, 3] = np.nan
        assert answers(both, start, T) == ["INVALID"] * 3


def answers(both: Both, start: Array, T: Array) -> list[str]:
    """The statuses of a search, a path to the pose, and a solve."""
    path = np.stack([both.arm.forward(start), T])
    return [
        both.run(mode, start, poses)[0] for mode, poses in ((1, T[None]), (4, path), (5, T[None]))
    ]
