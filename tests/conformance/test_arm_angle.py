"""The arm angle is the angle that it is said to be, and rows are all that there are at it."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.held_arms import held_module, imported
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.sampled import sampled
from tests.support.solving import import_text

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.errors import UsageError
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]

ELBOWS = {"arm_angle": (0.0, 1.0), "offset_elbow": (0.08, -1.0)}
"""How far the elbow's axis is beside the upper arm (m), and the way that the first axis points."""

NAMES = (*ELBOWS, "rounded_arm_angle")

FLAGS = ("kRounded", "kNewton")


@pytest.fixture(scope="module", params=NAMES)
def arm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return imported(request.param, tmp_path_factory.mktemp("arm"))


def about_z(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def about_y(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def measured(pose: Array, q: Array, beside: float, up: float) -> float:
    """The angle between two half planes, from shoulder, elbow and wrist alone."""
    shoulder = np.array([0.0, 0.0, 0.3])
    wrist = pose[:3, 3] - 0.1 * pose[:3, 2]
    elbow = shoulder + about_z(up * q[0]) @ about_y(q[1]) @ about_z(q[2]) @ np.array(
        [beside, 0.0, 0.4]
    )
    along = (wrist - shoulder) / np.linalg.norm(wrist - shoulder)
    here, zero = elbow - shoulder, np.array([0.0, 0.0, up])
    here, zero = (v - (v @ along) * along for v in (here, zero))
    return float(np.arctan2(np.cross(zero, here) @ along, zero @ here))


@pytest.mark.parametrize("name", list(ELBOWS))
def test_it_is_the_angle_of_the_elbow_s_half_plane(name: str, tmp_path: Path) -> None:
    arm, rng = imported(name, tmp_path), np.random.default_rng(1)
    for q in rng.uniform(arm.LOWER, arm.UPPER, (40, 7)):
        expected = measured(arm.forward(q), q, *ELBOWS[name])
        assert float(arm.arm_angle(q)) == pytest.approx(expected, abs=1e-12)


def test_every_configuration_is_found_at_its_own(arm: ModuleType) -> None:
    rng = np.random.default_rng(2)
    for q in rng.uniform(arm.LOWER, arm.UPPER, (60, 7)):
        pose, angle = arm.forward(q), float(arm.arm_angle(q))
        rows = arm.solve(pose, free={"arm_angle": angle}).q
        assert np.abs(rows - q).max(axis=1).min() < 1e-7
        assert np.abs(np.exp(1j * arm.arm_angle(rows)) - np.exp(1j * angle)).max() < 1e-8
        assert np.abs(arm.forward(rows) - pose).max() < 1e-9


def test_there_are_eight_rows_where_no_limit_is_in_the_way(arm: ModuleType) -> None:
    rng = np.random.default_rng(3)
    assert arm.MAX_SOLUTIONS >= 8
    for q in rng.uniform(arm.LOWER, arm.UPPER, (20, 7)):
        if np.linalg.svd(arm.jacobian(q), compute_uv=False)[-1] < 0.05:
            continue
        found = arm.solve(arm.forward(q), free=[arm.arm_angle(q)], limits=False)
        assert len(found) == 8 and not found.singular.any()


def test_a_wrist_above_the_shoulder_is_solved(arm: ModuleType) -> None:
    """The half plane that the angle counts from is that of x there."""
    for yaw in (-1.0, 0.3, 2.0):
        q = np.array([0.0, 0.0, 0.0, 1.1, 0.2, 0.7, -0.3])
        pose = arm.forward(q)
        wrist = pose[:3, 3] - 0.1 * pose[:3, 2]
        q[:2] = yaw, -np.arctan2(wrist[0], wrist[2] - 0.3)
        found = arm.solve(arm.forward(q), seed=q)
        assert np.abs(found.q[0] - q).max() < 1e-6
        assert not found.singular[0]


@pytest.mark.parametrize("arm", sampled(NAMES, ELBOWS), indirect=True)
def test_singular_poses_are_answered(arm: ModuleType) -> None:
    """Where several configurations of a continuum stand for it nothing but the pose tells them apart."""
    rng = np.random.default_rng(5)
    q = rng.uniform(arm.LOWER, arm.UPPER, (150, 7))
    for some, joints in ((slice(50), [3, 5]), (slice(50, 100), [5]), (slice(100, 150), [1])):
        q[some, joints] = 0.0
    poses, angles = arm.forward(q), arm.arm_angle(q)
    rows, count, _ = arm.solve_batch(poses, free=angles[:, None], seed=q)
    assert (count > 0).all()
    for pose, found, n in zip(poses, rows, count, strict=True):
        assert np.abs(arm.forward(found[:n]) - pose).max() < 1e-8


def test_an_arm_with_the_angle_named_is_like_one_with_a_joint_held(arm: ModuleType) -> None:
    assert arm.FREE_JOINTS == ("arm_angle",)
    assert "arm_angle" not in arm.JOINT_NAMES and arm.DOF == 7
    with pytest.raises(ValueError, match="no free joint named"):
        arm.solve(np.eye(4), free={"elbow": 0.0})
    q = np.array([0.3, 0.5, -0.2, 0.9, 0.1, 0.6, 0.25])
    batch, count, _ = arm.solve_batch(arm.forward(q)[None], seed=q)
    single = arm.solve(arm.forward(q), seed=q)
    assert count[0] == len(single)
    assert np.abs(batch[0, : count[0]] - single.q).max() < 1e-9


def test_poses_out_of_reach_are_projected_onto_rows_of_any_angle(arm: ModuleType) -> None:
    q = np.array([0.3, 0.4, 0.2, 0.9, 0.1, -0.5, 0.6])
    pose = arm.forward(q)
    pose[:3, 3] *= 3.0
    assert len(arm.solve(pose)) == 0
    found = arm.solve(pose, project=True)
    assert len(found) and (found.off[:, 0] > 0.1).all()


def test_the_default_is_the_one_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(serial_urdf("arm", SHOULDER_ELBOW_WRIST))
    module = derive(Request(path, free={"arm-angle": 0.4})).module
    arm = import_text(emit_module(module), tmp_path)
    found = arm.solve(arm.forward([0.3, 0.5, -0.2, 0.9, 0.1, 0.6, 0.25]))
    assert len(found) and np.abs(arm.arm_angle(found.q) - 0.4).max() < 1e-8
    with pytest.raises(UsageError, match="outside its limits"):
        derive(Request(path, free={"arm-angle": 4.0}))


def test_a_header_knows_that_its_file_is_rounded(tmp_path: Path) -> None:
    """Continua of what was solved are judged by that; all rows are refined at once then."""
    said = {
        name: [f"{flag} = true" in emit_header(held_module(name, tmp_path)) for flag in FLAGS]
        for name in ("arm_angle", "rounded_arm_angle")
    }
    assert said == {"arm_angle": [False, False], "rounded_arm_angle": [True, True]}
