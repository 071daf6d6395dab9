"""Axes a few milliradians from parallel: their common normal is a hundred metres away."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import header_of
from tests.support.solving import NO_COMPILER

from ikgen.generation.derive import derive
from ikgen.generation.request import Request
from ikgen.kinematics.forward import file_forward

pytestmark = pytest.mark.usefixtures("solved_once")

JOINTS = (
    ("-1 0 0", "-0.1114 0 0.1875", "0 0 0", (-0.52, 0.52)),
    ("0 1 0", "0 0 0.122", "0 0 0", (-1.57, 1.57)),
    ("0 1 0", "0 0 0.285", "{tilt} 0 0", (-2.53, 0.017)),
    ("0 1 0", "0 0 0.318", "0 0 0", (-0.17, 1.4)),
    ("-1 0 0", "0 0 0.12", "0 0 0", (-0.52, 0.52)),
    ("0 0 1", "0 0 0.335", "0 0 0", (-3.14, 3.14)),
)


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.parametrize("tilt", [2.3e-3, 3e-3])
def test_frames_are_near_and_rows_are_found(tilt: float, tmp_path: Path) -> None:
    text = '<link name="l0"/>'
    for k, (axis, xyz, rpy, (low, high)) in enumerate(JOINTS):
        text += (
            f'<joint name="j{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>'
            f'<origin xyz="{xyz}" rpy="{rpy.format(tilt=tilt)}"/><axis xyz="{axis}"/>'
            f'<limit lower="{low}" upper="{high}" effort="1" velocity="1"/></joint>'
            f'<link name="l{k + 1}"/>'
        )
    path = tmp_path / "tilted.urdf"
    path.write_text(f'<robot name="tilted">{text}</robot>')
    derivation = derive(Request(path, base="l0", tip="l6", name="tilted"))
    dh = derivation.module.dh
    assert max(abs(row.d.value) for row in dh.rows if row.d is not None) > 50.0
    assert max(np.abs(F[:3, 3]).max() for F in dh.file_frames) < 1.0
    header = header_of(derivation.module, tmp_path)
    random = np.random.default_rng(3)
    low, high = np.array([limits for *_, limits in JOINTS]).T
    q = random.uniform(low, high, (4000, 6))
    q[1::2, 2] = 10.0 ** random.uniform(-6.0, -3.0, 2000)  # the elbow is nearly stretched
    q[:, 2] = np.minimum(q[:, 2], high[2])
    poses = header.forward(q)
    np.testing.assert_allclose(file_forward(dh, q), poses, atol=1e-11)
    found = header.solve_many(poses)
    assert set(found.status) == {"OK"}
