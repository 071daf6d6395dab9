"""Values that joints are drawn from."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np

from ikgen.derivation.read import read
from ikgen.kinematics.joint_box import joint_box
from ikgen.model.joint_tree import Limits
from ikgen.records.request import Request

FR3 = Path(__file__).resolve().parents[2] / "urdf_fixtures/franka_fr3.urdf"


def test_limits_hold_within_half_a_turn_and_beyond_it_what_is_between() -> None:
    dh = read(Request(FR3)).dh
    limits = [Limits(-math.inf, math.inf), Limits(-1.0, 0.5), Limits(4.0, 6.0), Limits(-9.0, 2.0)]
    joints = tuple(
        dataclasses.replace(joint, limits=one)
        for joint, one in zip(dh.joints[:4], limits, strict=True)
    )
    slide = dataclasses.replace(joints[0], kind="prismatic")
    low, high = joint_box(dataclasses.replace(dh, joints=(*joints, slide)), slide=0.7)
    np.testing.assert_array_equal(low, [-math.pi, -1.0, math.pi, -math.pi, -0.7])
    np.testing.assert_array_equal(high, [math.pi, 0.5, 4.0, 2.0, 0.7])
