"""Rounded arms whose wrist has links that are short beside what the arm reaches, as of surgical tools."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.solving import import_text

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

SNAKE = (
    ("yaw", "revolute", "0 0 0", "0 -1.5708 1.5708", 1.5),
    ("pitch", "revolute", "0 0 0", "-1.5708 -1.5708 0", 0.78),
    ("insertion", "prismatic", "0 0.4318 0", "1.5708 0 0", 0.24),
    ("roll", "revolute", "0 0 0.4162", "0 0 0", 2.2),
    ("wrist_pitch1", "revolute", "0 0 0", "-1.5707 -1.5708 0", 1.5),
    ("wrist_yaw1", "revolute", "0.0034 0 0", "-1.5708 0 0", 1.39),
    ("wrist_yaw2", "revolute", "0.0034 0 0", "0 0 0", 1.39),
    ("wrist_pitch2", "revolute", "0.0034 0 0", "1.5708 -1.5708 0", 1.39),
    ("jaw", "revolute", "0 0 0", "0 0 0", 1.39),
)
"""Name, type, origin as rounded as files have it, and half of the range: the tool of a surgical arm whose
shaft pivots at the skin, bent by two pairs of links of 3.4 mm. All axes are z."""

_JOINT = """<joint name="{}" type="{}"><parent link="l{}"/><child link="l{}"/><origin xyz="{}" rpy="{}"/>
<axis xyz="0 0 1"/><limit lower="{}" upper="{}" effort="9" velocity="1"/></joint>"""


def snake() -> str:
    """As URDF."""
    text = "".join(f'<link name="l{i}"/>' for i in range(len(SNAKE) + 1))
    for i, (name, kind, xyz, rpy, half) in enumerate(SNAKE):
        low = 0.0 if kind == "prismatic" else -half
        text += _JOINT.format(name, kind, i, i + 1, xyz, rpy, low, half)
    return f'<robot name="snake">{text}</robot>'


@pytest.mark.long
def test_poses_at_which_two_short_links_are_in_line_have_rows(tmp_path: Path) -> None:
    """What the file's angles are off moves the tip by far more than is small beside the links."""
    path = tmp_path / "snake.urdf"
    path.write_text(snake())
    made = derive(
        Request(
            path, base="l0", tip="l9", free={"insertion": None, "wrist_pitch1": None, "jaw": None}
        )
    )
    assert made.module.rounded
    arm, rng = import_text(emit_module(made.module), tmp_path), np.random.default_rng(2)
    q = rng.uniform(arm.LOWER, arm.UPPER, (120, arm.DOF))
    q[:, 5] = rng.choice([0.0, 1e-5, 1e-3, 1e-2], 120)
    for row in q:
        found = arm.solve(arm.forward(row), free=row[[2, 4, 8]])
        assert len(found), row
        assert np.abs(arm.forward(found.q) - arm.forward(row)).max() < 1e-9
