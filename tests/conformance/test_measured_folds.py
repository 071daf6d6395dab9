"""Folds of an arm as measured, its axes off by a milliradian: two solutions far from the closed form's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import emitted_in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

ORIGINS = (
    ("0 0 0.05085", "-6.841e-4 5.74e-5 -2.149e-4"),
    ("0 0 0.04225", "-1.062e-4 -6.882e-4 -6.549e-4"),
    ("0.035 0 0.1", "-4.428e-4 2.039e-4 7.163e-4"),
    ("0.1 0 0", "-7.255e-4 5.735e-4 -3.366e-4"),
)
AXES = ("0 0 1", "0 1 0", "0 1 0", "0 1 0")
TIP = ("0.113575 0 0", "0 0 0")

NEXT_TO_ONE = np.array([0.49256, -0.6860448, -0.2458157, 0.93135])


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
def test_pairs_near_vertical_tools_are_found(tmp_path: Path) -> None:
    place = tmp_path / "measured.urdf"
    path = serial_urdf(place, ORIGINS, axes=AXES, tip=TIP, limit=3.0)
    request = Request(path, name="measured", task="position-pitch", tool_axis="z")
    arm, header = emitted_in_both(request, tmp_path)
    random = np.random.default_rng(3)
    q = random.uniform(-1.5, 1.5, (2000, 4))
    q[:, 3] = random.normal(size=2000) * 3e-3 - q[:, 1] - q[:, 2]  # the tool's z is nearly upright
    q[::2] = NEXT_TO_ONE + random.normal(size=(1000, 4)) * 10.0 ** random.uniform(-7, -4, (1000, 1))
    poses = arm.forward(q)
    rows, (batch, _, _) = header.solve_many(poses), arm.solve_batch(poses)
    for found in (rows.q, batch):
        gap = np.abs(found - q[:, None]).max(axis=2)
        assert np.nanmin(np.where(np.isnan(gap), np.inf, gap), axis=1).max() < 1e-5
