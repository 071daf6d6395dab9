"""Elbows that are straight where the wrist loses digits: what a file is off is more there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import emitted_in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

HALF, RIGHT = "3.14159265359", "1.570796326795"
ORIGINS = (
    ("0 0 0.05", "0 0 0"),
    ("0.03 0 0.04", f"{HALF} -{RIGHT} 0"),
    ("0.3 0 -0.05", f"{HALF} 0 0"),
    ("0.25 0 -0.04", f"{HALF} 0 -{RIGHT}"),
    ("0.05 0 0.03", f"{RIGHT} 0 -{RIGHT}"),
    ("0.08 0 -0.02", f"{RIGHT} 0 {RIGHT}"),
)
"""Right angles that are rounded to 1e-13 rad."""
AXES = ("0 0 1", "0 0 1", "0 0 1", "0 0 1", "0 0 -1", "0 0 1")


@pytest.mark.long
@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
def test_a_straight_elbow_is_reached_next_to_a_straight_wrist(tmp_path: Path) -> None:
    path = serial_urdf(tmp_path / "straight.urdf", ORIGINS, axes=AXES)
    arm, header = emitted_in_both(Request(path, base="l0", tip="l6", name="straight"), tmp_path)
    random = np.random.default_rng(7)
    q = random.uniform(-3.0, 3.0, (400, 6))
    q[:, 2] = 0.0
    q[:, 4] = np.pi / 2 + random.uniform(-0.1, 0.1, 400)
    poses = arm.forward(q)
    assert set(header.solve_many(poses).status) == {"OK"}
    assert all(arm.solve(pose).status == "OK" for pose in poses)


SHOULDER_ELBOW_WRIST = [
    ("0 0 0.34", "0 0 0"), ("0 0 0", f"{-np.pi / 2} 0 0"), ("0 -0.2 0", f"{np.pi / 2} 0 0"),
    ("0 0 0.2", f"{np.pi / 2} 0 0"), ("0 0.2 0", f"{-np.pi / 2} 0 0"), ("0 0 0.2", f"{-np.pi / 2} 0 0"),
    ("0 0 0", f"{np.pi / 2} 0 0"),
]  # fmt: skip


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
def test_an_arm_that_is_straight_from_shoulder_to_wrist_is_answered(tmp_path: Path) -> None:
    """Joints 1, 3, 5 and 7 turn about one line, but for 1e-9: no direction is left of the others' angles,
    and the sum of theirs alone is the pose's."""
    limits = [(-2.9, 2.9), (-2.0, 2.0)] * 3 + [(-3.0, 3.0)]
    path = serial_urdf(tmp_path / "straight.urdf", SHOULDER_ELBOW_WRIST, limit=limits)
    arm, header = emitted_in_both(Request(path, free={"j4": 0.0}), tmp_path)
    random = np.random.default_rng(0)
    q = np.pi / 4 * random.integers(-3, 4, (600, 7))
    q[:, 1::2] = 0.0
    q = q + random.normal(size=q.shape) * 10.0 ** random.uniform(-12, -8, (600, 1))
    q[:, 4] = 0.0
    poses = arm.forward(q)
    assert set(header.solve_many(poses).status) == {"OK"}
    assert all(arm.solve(pose).status == "OK" for pose in poses[:40])
