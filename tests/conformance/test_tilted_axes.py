"""Axes a few milliradians from parallel: their common normal is a hundred metres away."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import header_of
from tests.support.sampled import sampled
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.kinematics.forward import file_forward
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

PLACES = ("-0.1114 0 0.1875", "0 0 0.122", "0 0 0.285", "0 0 0.318", "0 0 0.12", "0 0 0.335")
AXES = ("-1 0 0", "0 1 0", "0 1 0", "0 1 0", "-1 0 0", "0 0 1")
LIMITS = ((-0.52, 0.52), (-1.57, 1.57), (-2.53, 0.017), (-0.17, 1.4), (-0.52, 0.52), (-3.14, 3.14))


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.parametrize("tilt", sampled([2.3e-3, 3e-3], []))
def test_frames_are_near_and_rows_are_found(tilt: float, tmp_path: Path) -> None:
    origins = [(xyz, f"{tilt if k == 2 else 0} 0 0") for k, xyz in enumerate(PLACES)]
    path = serial_urdf(tmp_path / "tilted.urdf", origins, axes=AXES, limit=LIMITS)
    derivation = derive(Request(path, base="l0", tip="l6", name="tilted"))
    dh = derivation.module.dh
    assert max(abs(row.d.value) for row in dh.rows if row.d is not None) > 50.0
    assert max(np.abs(F[:3, 3]).max() for F in dh.file_frames) < 1.0
    header = header_of(derivation.module, tmp_path)
    random = np.random.default_rng(3)
    low, high = np.array(LIMITS).T
    q = random.uniform(low, high, (4000, 6))
    q[1::2, 2] = 10.0 ** random.uniform(-6.0, -3.0, 2000)  # the elbow is nearly stretched
    q[:, 2] = np.minimum(q[:, 2], high[2])
    poses = header.forward(q)
    np.testing.assert_allclose(file_forward(dh, q), poses, atol=1e-11)
    found = header.solve_many(poses)
    assert set(found.status) == {"OK"}
