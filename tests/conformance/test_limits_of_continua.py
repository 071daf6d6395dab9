"""An arm that stands on a limit, at a singularity along which that joint hardly moves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import in_both
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.records.request import Request

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

SLIDES = (
    ("j1", "prismatic", "0 0 1", "0 0 0", "0 1 0", -1.0, 1.5),
    ("j2", "prismatic", "0 0 0", "0 0 0", "-1 0 0", 0.2, 2.0),
    ("j3", "prismatic", "0 0 0", "3.14159 0 0", "0 0 1", -0.2, 0.8),
    ("j4", "revolute", "0 0 0.1", "0 0 0", "0 0 1", -7.0, 7.0),
    ("j5", "revolute", "0.05 0 0.05", "1.5708 0 0", "0 0 1", -2.0, 2.0),
    ("j6", "revolute", "0 0.1 0.03", "-1.5708 0 0", "0 0 1", -7.0, 7.0),
)
"""Name, type, origin, angles of that, axis and limits: with joint 5 at 0 the others go round, and joint 3
by less than 1e-6 m."""

POSES = (
    (0.869, 1.641, -0.2, 2.012, 0.0, -0.657),
    (-0.182, 1.447, -0.2, 1.995, 0.0, -0.653),
    (-0.603, 1.082, -0.2, 2.173, 0.0, -2.414),
    (-0.963, 0.67, -0.2, 1.952, 0.0, -2.105),
    (1.006, 1.729, -0.2, 2.023, 0.0, -2.395),
    (-0.465, 1.758, -0.2, 2.137, 0.0, 2.16),
)


def gantry() -> str:
    text, parent = '<link name="base"/>\n', "base"
    for name, kind, xyz, rpy, axis, low, high in SLIDES:
        text += (
            f'<link name="{name}_link"/><joint name="{name}" type="{kind}">'
            f'<parent link="{parent}"/><child link="{name}_link"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>'
            f'<limit lower="{low}" upper="{high}" effort="1" velocity="1"/></joint>\n'
        )
        parent = f"{name}_link"
    return f'<robot name="gantry">\n{text}</robot>\n'


@pytest.mark.long
def test_a_continuum_is_followed_to_where_it_is_inside_the_limits(tmp_path: Path) -> None:
    path = tmp_path / "gantry.urdf"
    path.write_text(gantry())
    both = in_both(derive(Request(path, name="gantry")).module, tmp_path, "5")
    poses = both.arm.forward(np.array(POSES))
    rows, count, _ = both.arm.solve_batch(poses)
    for k, pose in enumerate(poses):
        status, numbers = both.run(5, np.zeros(6), pose[None])
        assert status == "OK" and count[k] > 0
        found = [*rows[k, : count[k]], *both.arm.solve(pose).q, *numbers.reshape(-1, 6)]
        assert np.abs(both.arm.forward(np.array(found)) - pose).max() < 2e-9
        assert all((q >= both.arm.LOWER).all() and (q <= both.arm.UPPER).all() for q in found)
    below = both.arm.forward(np.array(POSES) - 2e-6 * np.eye(6)[2])  # farther than joint 3 goes
    assert not both.arm.solve_batch(below)[1].any()
    assert {both.run(5, np.zeros(6), pose[None])[0] for pose in below} == {"LIMITS"}
