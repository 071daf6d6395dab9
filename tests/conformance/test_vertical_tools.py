"""Tools that point straight up: the elevation has half the digits, and what a file is off adds nothing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import emitted_in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

HALF, RIGHT = "3.14159265359", "1.57079632679"
ORIGINS = (
    ("0 0 0.15", f"0 {HALF} 0"),
    ("0 0.0016 -0.12", f"-{RIGHT} 0 {HALF}"),
    ("0 -0.29 0", f"0 {HALF} 0"),
    ("0 0.12 -0.0086", f"-{RIGHT} 0 {HALF}"),
)
TIP = ("0 0 -0.16", f"{HALF} 0 {RIGHT}")
"""Right angles that are rounded to 1e-13 rad."""


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
def test_rows_keep_the_elevation(tmp_path: Path) -> None:
    path = serial_urdf(tmp_path / "upright.urdf", ORIGINS, tip=TIP)
    request = Request(path, name="upright", task="position-pitch", tool_axis="y")
    arm, header = emitted_in_both(request, tmp_path)
    random = np.random.default_rng(3)
    q = random.uniform(-3.0, 3.0, (400, 4))
    q[:, 1] = random.choice([0.0, np.pi], 400) + 10.0 ** random.uniform(-9.0, -2.0, 400)
    q[:, 2] = random.choice([0.0, np.pi], 400) + 10.0 ** random.uniform(-9.0, -2.0, 400)
    q[:, 3] = random.choice([0.0, np.pi / 2, np.pi], 400) + 10.0 ** random.uniform(-9.0, -2.0, 400)
    poses = arm.forward(q)
    each = [arm.solve(pose).q for pose in poses]
    found = header.solve_many(poses)
    rows = [found.q[k, :n] for k, n in enumerate(found.count)]
    for some in (each, rows):
        for pose, one in zip(poses, some, strict=True):
            assert len(one)
            off = arm.forward(one) - pose
            assert np.abs(off[:, :3, 3]).max() < 1e-9
            elevations = np.arcsin(np.clip(arm.forward(one)[:, 2, 1], -1.0, 1.0))
            assert np.abs(elevations - np.arcsin(np.clip(pose[2, 1], -1.0, 1.0))).max() < 1e-7
