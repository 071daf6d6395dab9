"""Poses that are right to 1e-6 (float32 ones are): every row of the exact pose, on the nearest pose."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import header_of
from tests.support.sampled import sampled
from tests.support.solving import NO_COMPILER, import_text

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.records.request import Request
from ikgen.verify.runners.cpp_header import CppHeader

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]
ROOT = Path(__file__).resolve().parents[2]
FIXTURES, TABLES = ROOT / "urdf_fixtures", ROOT / "tests/robots/tables"
ARMS = {
    "spherical wrist": Request(FIXTURES / "kuka_kr6r900sixx.urdf"),
    "parallel axes": Request(FIXTURES / "ur5e.urdf"),
    "rounded": Request(FIXTURES / "doosan_m1013.urdf"),
    "eliminated": Request(TABLES / "KawasakiRS05L.toml"),
    "held": Request(FIXTURES / "franka_fr3.urdf", free={"fr3_joint7": 0.3}),
    "direction": Request(FIXTURES / "igus_robolink_rl_dp_5.urdf", task="position-direction"),
    "pitch": Request(FIXTURES / "open_manipulator_x.urdf", task="position-pitch"),
    "yaw": Request(FIXTURES / "scara_standard.toml", task="position-yaw"),
    "rotation": Request(TABLES / "Wrist.toml", task="rotation"),
}
NOISES = ("float32", "1e-6")
COMPILED = ("held",)
"""The arm whose header is compiled in every run."""


@pytest.fixture(scope="module", params=ARMS)
def module(request: pytest.FixtureRequest) -> SolverModule:
    """An arm's solver."""
    return derive(ARMS[request.param]).module


@pytest.fixture(scope="module")
def arm(module: SolverModule, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The emitted module of an arm."""
    return import_text(emit_module(module), tmp_path_factory.mktemp("arm"))


@pytest.fixture(scope="module")
def header(module: SolverModule, tmp_path_factory: pytest.TempPathFactory) -> CppHeader:
    """The emitted header of an arm, compiled."""
    if NO_COMPILER:
        pytest.skip(NO_COMPILER)
    return header_of(module, tmp_path_factory.mktemp("header"))


def configurations(arm: Any, n: int) -> Array:
    """Random ones inside the limits, held joints at their defaults."""
    low, high = (np.clip(limit, -3.0, 3.0) for limit in (arm.LOWER, arm.UPPER))
    q = np.random.default_rng(4).uniform(low, high, (n, arm.DOF))
    for name, value in zip(arm.FREE_JOINTS, arm._FREE_DEFAULTS, strict=True):
        q[:, arm.JOINT_NAMES.index(name)] = value
    return q


def noisy(poses: Array, kind: str) -> Array:
    if kind == "float32":
        return poses.astype(np.float32).astype(float)
    out = poses.copy()
    out[:, :3, :3] += np.random.default_rng(5).uniform(-1e-6, 1e-6, (len(poses), 3, 3))
    return out


def nearest(T: Array, task: str) -> Array:
    """The pose (4, 4) that a noisy one stands for."""
    out = T.copy()
    if task == "position-direction":
        out[:3, 2] /= np.linalg.norm(T[:3, 2])
    elif task == "position-pitch":
        out[2, 2] = np.clip(T[2, 2], -1.0, 1.0)
    elif task == "position-yaw":
        out[:2, 0] /= np.linalg.norm(T[:2, 0])
    else:
        U, _, V = np.linalg.svd(T[:3, :3])
        out[:3, :3] = U @ V
    return out


def read(T: Array, task: str) -> Array:
    """The entries (..., m) that the task reads."""
    if task == "position-direction":
        return T[..., :3, 2:].reshape(*T.shape[:-2], 6)
    if task == "position-pitch":
        return np.concatenate([T[..., :3, 3], T[..., 2, 2:3]], axis=-1)
    if task == "position-yaw":
        return np.concatenate([T[..., :3, 3], T[..., :2, 0]], axis=-1)
    return T[..., :3, : 3 if task == "rotation" else 4].reshape(*T.shape[:-2], -1)


@pytest.mark.parametrize("kind", NOISES)
def test_all_rows_on_the_nearest_pose(arm: Any, kind: str) -> None:
    poses = arm.forward(configurations(arm, 25))
    for exact, T in zip(poses, noisy(poses, kind), strict=True):
        found = arm.solve(T, limits=False)
        assert len(found) == len(arm.solve(exact, limits=False)) > 0
        error = read(arm.forward(found.q), arm.TASK) - read(nearest(T, arm.TASK), arm.TASK)
        assert np.abs(error).max() < 1e-9


def test_batch_agrees(arm: Any) -> None:
    poses = noisy(arm.forward(configurations(arm, 25)), "1e-6")
    q, count, status = arm.solve_batch(poses, limits=False)
    for T, rows, n, said in zip(poses, q, count, status, strict=True):
        found = arm.solve(T, limits=False)
        assert (len(found), found.status) == (n, said)
        order = [int(np.abs(rows[:n] - row).max(axis=1).argmin()) for row in found.q]
        assert sorted(order) == list(range(n))
        assert np.abs(rows[order] - found.q).max() < 1e-9


@pytest.mark.parametrize("module", [name for name in ARMS if name != "pitch"], indirect=True)
def test_rotations_that_are_far_off_are_none(arm: Any) -> None:
    pose = arm.forward(configurations(arm, 1)[0])
    pose[:3, :3] *= 1.0 + 1e-5
    bad = [pose]
    if arm.TASK in ("pose", "rotation"):
        bad.append(np.diag([1.0, 1.0, -1.0, 1.0]))
    for T in bad:
        assert arm.solve(T).status == "INVALID"
        assert arm.solve_batch([T])[2].tolist() == ["INVALID"]


@pytest.mark.parametrize("module", ["pitch"], indirect=True)
def test_a_height_beyond_one_is_none(arm: Any) -> None:
    """Of a rotation this task reads one entry, which cannot tell otherwise."""
    pose = arm.forward(configurations(arm, 1)[0])
    pose[2, :3] = 1.0 + 1e-5
    assert arm.solve(pose).status == "INVALID"


@pytest.mark.parametrize("module", sampled(ARMS, COMPILED), indirect=True)
@pytest.mark.parametrize("kind", sampled(NOISES, ["1e-6"]))
def test_the_header_has_the_rows_of_the_module(arm: Any, header: CppHeader, kind: str) -> None:
    poses = noisy(arm.forward(configurations(arm, 25)), kind)
    single, batch = header.solve_many(poses, limits=False), header.solve_batch(poses, limits=False)
    assert batch is not None and np.array_equal(batch.q, single.q, equal_nan=True)
    for T, mine, status in zip(poses, single, single.status, strict=True):
        found = arm.solve(T, limits=False)
        assert (status, len(mine)) == ("OK", len(found))
        apart = np.abs((mine[:, None] - found.q + np.pi) % (2.0 * np.pi) - np.pi).max(axis=2)
        assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-9


@pytest.mark.parametrize("module", sampled(ARMS, COMPILED), indirect=True)
def test_the_header_refuses_what_the_module_refuses(arm: Any, header: CppHeader) -> None:
    good = arm.forward(configurations(arm, 1)[0])
    bad = np.stack([good] * 4)
    bad[0, :3, :3] *= 1.0 + 1e-5
    bad[1, :3, :3] = np.nan
    bad[2, :3, :3] = 0.0
    bad[3, :3, 0] *= -1.0
    mirrored = arm.TASK in ("pose", "rotation")
    expected = ["INVALID"] * 3 + ["INVALID" if mirrored else arm.solve(bad[3]).status.value]
    if arm.TASK == "position-pitch":  # reads one entry of the rotation
        expected = [arm.solve(T).status.value for T in bad]
        assert expected[1] == "INVALID"
    assert list(header.solve_many(bad).status) == expected
    assert list(arm.solve_batch(bad)[2]) == expected
    if arm.TASK == "pose":
        good[3, 3] = 1.0 + 1e-9
        assert header.solve_many(good[None]).status == ("INVALID",)
