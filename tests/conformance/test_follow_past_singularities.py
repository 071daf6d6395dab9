"""A path on which a pose leaves the held joint no value near the last: all joints are singular."""

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

BENDS = (
    ("0 0 0.3", "0 0 0", -3.141592654, 3.141592654),
    ("0 0 0", "-1.5708 0 0", -2.0, 2.0),
    ("0 -0.3 0", "1.5708 0 0", -3.141592654, 3.141592654),
    ("0.05 0 0", "-1.5708 0 0", -0.1, 2.6),
    ("-0.05 -0.3 0", "1.5708 0 0", -3.141592654, 3.141592654),
    ("0 0 0", "-1.5708 0 0", -2.0, 2.0),
    ("0 0 0", "1.5708 0 0", -3.141592654, 3.141592654),
)
"""Origins, angles and limits of joints about their z axes: an elbow beside the links, rounded."""
AT = np.array([-0.9086945118117278, -1.2799313778635097, -1.0990309969995078, 0.33029417128903654,
               1.2718411004004126, 1.4017517705557996, -1.356973190784733])  # fmt: skip
ALONG = np.array([0.0236844, 0.25990224, 0.0, -0.06469008, -0.34598943, -0.77363542, -0.42975787])


def bent_urdf() -> str:
    text = '<link name="base"/>'
    for k, (xyz, rpy, low, high) in enumerate(BENDS):
        text += (
            f'<link name="link_{k}"/><joint name="joint_{k}" type="revolute">'
            f'<parent link="{f"link_{k - 1}" if k else "base"}"/><child link="link_{k}"/>'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>'
            f'<limit lower="{low}" upper="{high}" effort="1" velocity="1"/></joint>'
        )
    return f'<robot name="arm">{text}</robot>'


@pytest.mark.long
def test_a_path_goes_on_from_another_value_of_the_held_joint(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(bent_urdf())
    both = in_both(derive(Request(path, free={"joint_2": None})).module, tmp_path, "4")
    arm, q = both.arm, AT + np.linspace(-0.25, 0.25, 101)[:, None] * ALONG
    poses = arm.forward(q)
    found = arm.follow(poses, start=q[0])
    status, count, rows = both.follow(q[0], poses)
    assert found.status == status == "OK"
    assert count > 0 and found.singular[50] and np.abs(rows - found.q).max() < 1e-6
    for own in (found.q, rows):
        assert np.abs(arm.forward(own) - poses).max() < 1e-9
        assert np.abs(np.diff(own, axis=0)).max() < 0.1
