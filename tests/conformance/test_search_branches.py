"""The best row of each interval of a held joint is of it, also where two branches meet at its end."""

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

JOINTS = (
    ("yaw", "0 0 0.9", "0 0 0", -1.5, 1.5),
    ("mount", "0.02 -0.15 0.4", "1.0472 0 0", 0.0, 0.0),
    ("r1", "0 0 0.05", "0 0 0", -2.9, 2.9),
    ("r2", "0.04 0 0.1", "1.5708 0 0", -2.0, 1.7),
    ("r3", "0 0.3 0", "0 0 0", -2.6, -0.2),
    ("r4", "0 0.12 0", "-1.5708 0 0", -3.0, 3.0),
    ("r5", "0 0 0.14", "1.5708 0 0", -2.0, 2.0),
    ("r6", "0 0 0", "-1.5708 0 0", -4.0, 4.0),
    ("turn", "0 0 0.05", "0 0 0.5", 0.0, 0.0),
    ("tilt", "0 0.01 0.08", "0 0.2 0", 0.0, 0.0),
)
"""Name, origin, angles of that and limits about z, none where it is fixed: an arm on a torso."""

CASES = (
    (
        (0.915, 1.7861, -0.0933, -1.9141, -2.6764, -0.4665, -0.7322),
        (0.255, -2.3868, 0.563, -1.3493, 0.1317, 0.9491, -3.3807),
    ),
    (
        (-0.5252, 1.776, -0.8291, -2.2423, 1.1911, -0.2058, 2.3915),
        (0.4802, 1.8605, 1.5527, -2.5493, -1.8649, -0.308, 0.4068),
    ),
    (
        (0.671, 1.7913, -1.4344, -0.8891, 2.0857, -0.3951, 0.426),
        (-1.1815, -2.683, 0.4805, -2.1362, 2.7385, 0.26, 0.6118),
    ),
)
"""Configurations and seeds."""


def torso_arm() -> str:
    text, parent = '<link name="base"/>\n', "base"
    for name, xyz, rpy, low, high in JOINTS:
        kind = "revolute" if low < high else "fixed"
        text += (
            f'<link name="{name}_link"/><joint name="{name}" type="{kind}">'
            f'<parent link="{parent}"/><child link="{name}_link"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>'
            f'<limit lower="{low}" upper="{high}" effort="1" velocity="1"/></joint>\n'
        )
        parent = f"{name}_link"
    return f'<robot name="torso_arm">\n{text}</robot>\n'


@pytest.mark.long
def test_rows_are_of_the_intervals_that_they_are_the_best_of(tmp_path: Path) -> None:
    path = tmp_path / "torso_arm.urdf"
    path.write_text(torso_arm())
    both = in_both(derive(Request(path, name="torso_arm")).module, tmp_path, "1")
    for q, seed in ((np.array(a), np.array(b)) for a, b in CASES):
        pose = both.arm.forward(q)
        own = both.arm.search(pose, seed=seed)
        other = both.run(1, seed, pose[None])[1].reshape(-1, 7)
        assert len(own) == len(other) == len(both.arm.self_motion(pose)) < 8
        away = [np.linalg.norm(rows - seed, axis=1) for rows in (own.q, other)]
        np.testing.assert_allclose(away[0], away[1], atol=1e-4)
